"""Count the scenarios of a variation without expanding it."""

from __future__ import annotations

from math import prod
from typing import TYPE_CHECKING

from robbdd_tools.base.selections import SelectionRule
from robbdd_tools.checks.chosen_elements import chosen_elements
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.checks.template_variants import Scenario
    from robbdd_tools.names.elements import Site
    from robbdd_tools.names.types import Written

MAX_SCENARIOS = 10_000
"""If a variant has more scenarios than this (about one night of simulation), a mistake is assumed."""
UNCOUNTED = 10**12
"""Upper limit of a count."""


def factors_of(scenario: Scenario) -> tuple[int, ...] | None:
    """Return factors whose product is the number of scenarios; ``None`` while a set is unknown.

    For a product, these are the numbers of values in each line. For a table, this is the number of rows.
    """
    variation = scenario.variant.variation
    if isinstance(variation, tree.Table):
        return (len(variation.rows),)
    counts = [choices(scenario.site, written) for column in scenario.columns for written in column.written]
    known = tuple(count for count in counts if count is not None)
    return known if len(known) == len(counts) else None


def scenario_count(scenario: Scenario) -> int | None:
    """Return the number of scenarios of a variant; ``None`` while a set is unknown."""
    factors = factors_of(scenario)
    return None if factors is None else prod(factors)


def choices(site: Site, written: Written) -> int | None:
    """Return the number of values in a line of a product; ``None`` while its set is unknown."""
    match written:
        case tree.ValueList():
            return len(written.values)
        case tree.SetList():
            return len(written.sets)
        case tree.Link():
            elements = chosen_elements(site, written.reference, written.where)
            return None if elements is None else len(elements)
        case tree.Selection():
            elements = chosen_elements(site, written.source, written.where)
            return None if elements is None else _selections(written, len(elements))
        case _:
            return 1


def _selections(selection: tree.Selection, size: int) -> int | None:
    length = selection.count.value
    if not isinstance(length, int) or length < 1 or not size:
        return None
    if length > MAX_SCENARIOS:
        # The exact number is slow to compute and useless.
        return UNCOUNTED if selection.repeated and size > 1 else int(selection.repeated)
    return min(UNCOUNTED, SelectionRule(selection.kind, length, selection.repeated).count(size))
