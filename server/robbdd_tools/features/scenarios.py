"""Number of scenarios of variants, computed from their text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.checks.counting import scenario_count
from robbdd_tools.checks.memo import Kept
from robbdd_tools.checks.template_variants import scenarios
from robbdd_tools.names.uses import clauses_of
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robbdd_tools.names.analysis import FileAnalysis, PlacedDeclaration
    from robbdd_tools.names.elements import Site
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.names.variant_places import PlacedVariant

Numbers = tuple[int | None, ...]


def number_of_scenarios(variant: PlacedVariant) -> int | None:
    """Return the number of scenarios of a variant, or ``None`` if a set is unknown or the text has errors."""
    found = next((one for one in scenarios(variant.site) if one.variant is variant.node), None)
    return None if found is None else scenario_count(found)


def scenario_numbers(snapshot: Snapshot, file: FileAnalysis) -> Iterator[tuple[PlacedDeclaration, Numbers]]:
    """Yield the stories of a file, or their parts, each with ``number_of_scenarios`` of its variants in text order.

    After an edit, only changed variants are counted again.
    """
    return _NUMBERS.of(snapshot, file)


def _numbers(site: Site) -> Numbers:
    known = {id(one.variant): scenario_count(one) for one in scenarios(site)}
    return tuple(known.get(id(clauses.node)) for clauses in clauses_of(site.placed.declaration))


_NUMBERS = Kept(frozenset({tree.Story, tree.Variant}), _numbers)
