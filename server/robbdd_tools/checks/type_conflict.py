"""``type-conflict``: a variable has different types in two places, for example object and workspace."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import chain
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.checks.chosen_elements import written_elements
from robbdd_tools.checks.finding import article, finding, related_to
from robbdd_tools.checks.replacements import (
    other_values,
    other_variables,
    similar_phrase,
    variables_with_kinds,
    with_similar_phrase,
    with_units,
)
from robbdd_tools.checks.template_variants import Column, Scenario, scenarios
from robbdd_tools.names.elements import Site, elements_of
from robbdd_tools.names.types import kind_words, narrowed, uses_by_variable, variable_key
from robbdd_tools.names.uses import ANYTHING, Clauses, Kinds, Use, clauses_of, dimension_of_phrase
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic

CODE = "type-conflict"
Placed = tuple[Site, Use]


def type_conflict(site: Site) -> Iterator[Diagnostic]:
    """Report phrases and values that use one variable for different kinds. The report names both places."""
    for clauses in clauses_of(site.placed.declaration):
        yield from _quantified(site, clauses)
        if isinstance(clauses.node, tree.Template):
            by_variable = uses_by_variable(site, clauses)
            others = {path.rpartition(".")[2]: kinds for path, kinds in variables_with_kinds(site, by_variable)}
            for uses in by_variable.values():
                yield from _between_phrases([(site, use) for use in uses], site, clauses, others)
    for scenario in scenarios(site):
        yield from _in_scenario(scenario)


def _in_scenario(scenario: Scenario) -> Iterator[Diagnostic]:
    site, template = scenario.site, scenario.template
    own = uses_by_variable(site, scenario.clauses)
    outer: dict[str, list[Use]] = {}
    if template is not None and scenario.outer is not None:
        outer = uses_by_variable(template, scenario.outer)
    merged = {key: [*outer.get(key, ()), *own.get(key, ())] for key in (*outer, *own)}
    others = {} if template is None else dict(variables_with_kinds(template, merged))
    for key, uses in own.items():
        inherited = [(template, use) for use in outer.get(key, ()) if template is not None]
        yield from _between_phrases([*inherited, *((site, use) for use in uses)], site, scenario.clauses, others)
    for column in scenario.columns:
        if column.variable is None:
            continue
        key = variable_key(column.variable)
        placed = [(template, use) for use in outer.get(key, ()) if template is not None]
        placed += [(site, use) for use in own.get(key, ())]
        yield from _values(scenario, column, placed)


def _between_phrases(
    uses: list[Placed], own: Site, clauses: Clauses, others: Mapping[str, Kinds]
) -> Iterator[Diagnostic]:
    """Report the uses in ``own`` whose kinds conflict with earlier uses.

    ``others`` are variables that may replace them.
    """
    left: Kinds = ANYTHING
    seen: list[Placed] = []
    for site, use in uses:
        if left & use.kinds:
            left &= use.kinds
            seen.append((site, use))
            continue
        if site is not own:
            continue
        other = next((entry for entry in seen if not entry[1].kinds & use.kinds), seen[0])
        similar = similar_phrase(use, clauses, left)
        message = (
            f"'{use.ref.path}' stands for {article(kind_words(left))} in '{other[1].phrase}', "
            f"so it cannot be {article(kind_words(use.kinds))} in '{use.phrase}': use two variables"
            + (f", or write '{similar}'" if similar else "")
        )
        related = (related_to(other[0], other[1].ref, f"here it is {article(kind_words(other[1].kinds))}"),)
        fixes = (*with_similar_phrase(site, use, clauses, similar), *other_variables(site, use, clauses, others))
        yield finding(site, use.ref, Severity.ERROR, CODE, message, related, fixes)
        yield from _other_place(other, site, use.ref, f"elsewhere it is {article(kind_words(use.kinds))}")


def _other_place(other: Placed, own: Site, node: tree.Node, words: str) -> Iterator[Diagnostic]:
    """Yield a hint at the phrase that determines the type, linked to the conflicting place, if both are in one file."""
    site, use = other
    if site.uri == own.uri:
        message = f"'{use.ref.path}' is {article(kind_words(use.kinds))} here, but {words}"
        related = (related_to(own, node, "the conflict"),)
        yield finding(site, use.ref, Severity.HINT, CODE, message, related)


def _values(scenario: Scenario, column: Column, uses: list[Placed]) -> Iterator[Diagnostic]:
    """Report each value that a phrase does not accept. A named set is reported once."""
    values = list(chain.from_iterable(written_elements(scenario.site, written) for written in column.written))
    kinds = narrowed(use for _, use in uses)
    reported: set[tree.Node] = set()
    for node, element in values:
        if element.kind in kinds or not kinds or node in reported:
            continue
        reported.add(node)
        other = next(entry for entry in uses if element.kind not in entry[1].kinds)
        wanted = kind_words(kinds)
        message = (
            f"'{element.name}' is {article(element.kind)}, but '{column.ref.path}' stands for {article(wanted)} "
            f"in '{other[1].phrase}': give it {article(wanted)}"
        )
        related = (related_to(other[0], other[1].ref, f"here it is {article(kind_words(other[1].kinds))}"),)
        dimension = dimension_of_phrase(other[1].phrase)
        units = with_units(scenario.site, node, dimension) if dimension and element.kind == "number" else ()
        fixes = (*units, *other_values(scenario, column, node, kinds, {element.name for _, element in values}))
        yield finding(scenario.site, node, Severity.ERROR, CODE, message, related, fixes)
        if len(reported) == 1:
            words = f"scenario '{scenario.variant.name.text}' gives it {article(element.kind)}"
            yield from _other_place(other, scenario.site, node, words)


def _quantified(site: Site, clauses: Clauses) -> Iterator[Diagnostic]:
    """Report phrases that do not accept the elements of a literal set over which a quantifier iterates."""
    for use in clauses.uses:
        if use.bound is None:
            continue
        elements = elements_of(site.follow(use.bound.in_set)) or ()
        wrong = next((element for element in elements if element.kind not in use.kinds), None)
        if wrong is not None:
            message = (
                f"'{use.ref.path}' runs over '{use.bound.in_set.path}', where '{wrong.name}' is "
                f"{article(wrong.kind)}, but '{use.phrase}' takes {article(kind_words(use.kinds))}: "
                "name another set"
            )
            related = (related_to(site, use.bound.in_set, f"the set has {article(wrong.kind)}"),)
            yield finding(site, use.ref, Severity.ERROR, CODE, message, related)
