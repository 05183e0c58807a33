"""Number of scenarios of a variant, computed from its text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.checks.counting import scenario_count
from robbdd_tools.checks.template_variants import scenarios

if TYPE_CHECKING:
    from robbdd_tools.names.variant_places import PlacedVariant


def number_of_scenarios(variant: PlacedVariant) -> int | None:
    """Return the number of scenarios of a variant, or ``None`` if a set is unknown or the text has errors."""
    found = next((one for one in scenarios(variant.site) if one.variant is variant.node), None)
    return None if found is None else scenario_count(found)
