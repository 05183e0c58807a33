"""``many-scenarios``: a variation that explodes."""

from __future__ import annotations

from collections.abc import Iterator
from math import comb, perm, prod
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.checks.finding import finding
from robbdd_tools.checks.variants import scenarios
from robbdd_tools.names.elements import elements_of
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.elements import Site
    from robbdd_tools.names.types import Written

MOST_SCENARIOS = 10_000
"""Scenarios of one variant that are taken as meant; a night of simulation runs about as many."""
_UNCOUNTED = 10**12


def many_scenarios(site: Site) -> Iterator[Diagnostic]:
    """Report each variant that stands for more scenarios than anybody will run."""
    for scenario in scenarios(site):
        variation = scenario.variant.variation
        if isinstance(variation, tree.Table):
            continue
        counts = [_choices(site, written) for column in scenario.columns for written in column.written]
        known = [count for count in counts if count is not None]
        total = prod(known)
        if len(known) == len(counts) and total > MOST_SCENARIOS:
            shown = f"{total:,}" if total < _UNCOUNTED else f"more than {_UNCOUNTED:,}"
            factors = " × ".join(f"{count:,}" if count < _UNCOUNTED else "very many" for count in known)
            message = f"this variation makes {shown} scenarios ({factors}): give fewer values, or write a table"
            yield finding(site, scenario.variant.name, Severity.WARNING, "many-scenarios", message)


def _choices(site: Site, written: Written) -> int | None:
    """Return how many values a line offers; ``None`` while the set is unknown."""
    match written:
        case tree.ValueList():
            return len(written.values)
        case tree.SetList():
            return len(written.sets)
        case tree.Link():
            elements = elements_of(site.follow(written.reference))
            return None if elements is None else len(elements)
        case tree.Selection():
            elements = elements_of(site.follow(written.source))
            return None if elements is None else _selections(written, len(elements))
        case _:
            return 1


def _selections(selection: tree.Selection, size: int) -> int | None:
    length = selection.count.value
    if not isinstance(length, int) or length < 1 or not size:
        return None
    if selection.repeated:
        # Beyond the limit the exact number is of no use and slow to compute.
        return _UNCOUNTED if size > 1 and length > MOST_SCENARIOS else comb(size + length - 1, length)
    if length > MOST_SCENARIOS:
        return 0
    return min(_UNCOUNTED, perm(size, length) if selection.kind == "permutations" else comb(size, length))
