"""``many-scenarios``: a variation with too many scenarios."""

from __future__ import annotations

from collections.abc import Iterator
from math import prod
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.checks.counting import MAX_SCENARIOS, UNCOUNTED, factors_of
from robbdd_tools.checks.finding import finding
from robbdd_tools.checks.template_variants import scenarios
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.elements import Site


def many_scenarios(site: Site) -> Iterator[Diagnostic]:
    """Report each variant that has too many scenarios for a run."""
    for scenario in scenarios(site):
        known = factors_of(scenario)
        if known is None or isinstance(scenario.variant.variation, tree.Table):
            continue
        total = prod(known)
        if total > MAX_SCENARIOS:
            shown = f"{total:,}" if total < UNCOUNTED else f"more than {UNCOUNTED:,}"
            factors = " × ".join(f"{count:,}" if count < UNCOUNTED else "very many" for count in known)
            message = f"this variation makes {shown} scenarios ({factors}): give fewer values, or write a table"
            yield finding(site, scenario.variant.name, Severity.WARNING, "many-scenarios", message)
