"""``empty-set``: a set has no elements. A variation that uses it has no scenario."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.checks.finding import change, finding, related_to
from robbdd_tools.checks.template_variants import Column, Scenario, scenarios
from robbdd_tools.names.elements import elements_of
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic, Fix
    from robbdd_tools.names.elements import Site


def empty_set(site: Site) -> Iterator[Diagnostic]:
    """Report declared sets without elements, and variations without values."""
    root = site.tree
    if isinstance(root, tree.ElementSet | tree.ConstantSet) and elements_of(site) == ():
        message = f"the set '{root.name.text}' is empty: add an element between the braces, or remove the set"
        yield finding(site, root.name, Severity.WARNING, "empty-set", message)
    for scenario in scenarios(site):
        is_product = isinstance(scenario.variant.variation, tree.Product)
        for column in scenario.columns:
            for written in column.written:
                yield from _line(scenario, column, written) if is_product else _cell(scenario, column, written)


def _line(scenario: Scenario, column: Column, written: tree.Node) -> Iterator[Diagnostic]:
    """Report a line without values, because the variant then has no scenario. A nested empty set is allowed."""
    site = scenario.site
    related = (related_to(site, column.ref, "the variable"),)
    match written:
        case tree.ValueList(values=()) | tree.SetList(sets=()):
            message = f"'{column.ref.path}' has no value to choose from, so there is no scenario: add a value"
            fixes = _filled(scenario, column, written)
            yield finding(site, written, Severity.ERROR, "empty-set", message, related, fixes)
        case tree.SetList():
            for values in written.sets:
                yield from _cell(scenario, column, values)
        case tree.Link() if elements_of(site.follow(written.reference)) == ():
            path = written.reference.path
            message = f"the set '{path}' is empty, so there is no scenario: add an element to it"
            fixes = _filled(scenario, column, written)
            yield finding(site, written.reference, Severity.ERROR, "empty-set", message, related, fixes)
        case _:
            pass


def _cell(scenario: Scenario, column: Column, written: tree.Node) -> Iterator[Diagnostic]:
    if isinstance(written, tree.ValueList) and not written.values:
        message = "this set is empty: write its elements"
        fixes = _filled(scenario, column, written)
        yield finding(scenario.site, written, Severity.WARNING, "empty-set", message, fixes=fixes)


def _filled(scenario: Scenario, column: Column, written: tree.Node) -> tuple[Fix, ...]:
    """Return the fix that replaces an empty set by all matching elements of the scene."""
    values = () if column.variable is None else scenario.fitting_for(column.variable)
    if not values:
        return ()
    text = f"{{ {', '.join(values)} }}"
    if isinstance(written, tree.SetList):
        text = f"{{ {text} }}"
    return (change(scenario.site, "Insert all matching elements of the scene", written, text),)
