"""``empty-set``: a set without elements; where a scenario takes its values from it there is no scenario."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.checks.finding import finding, related_to
from robbdd_tools.checks.variants import Column, scenarios
from robbdd_tools.names.elements import elements_of
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.elements import Site


def empty_set(site: Site) -> Iterator[Diagnostic]:
    """Report declared sets without elements and variations that take a value from nothing."""
    root = site.tree
    if isinstance(root, tree.ElementSet | tree.ConstantSet) and elements_of(site) == ():
        message = f"the set '{root.name.text}' is empty: add an element between the braces, or remove the set"
        yield finding(site, root.name, Severity.WARNING, "empty-set", message)
    for scenario in scenarios(site):
        is_product = isinstance(scenario.variant.variation, tree.Product)
        for column in scenario.columns:
            for written in column.written:
                yield from _line(site, column, written) if is_product else _cell(site, written)


def _line(site: Site, column: Column, written: tree.Node) -> Iterator[Diagnostic]:
    """A line without values leaves nothing to combine; an inner set without elements may be meant."""
    match written:
        case tree.ValueList(values=()) | tree.SetList(sets=()):
            message = f"'{column.ref.path}' has no value to choose from, so there is no scenario: add a value"
            related = (related_to(site, column.ref, "the variable"),)
            yield finding(site, written, Severity.ERROR, "empty-set", message, related)
        case tree.SetList():
            for values in written.sets:
                yield from _cell(site, values)
        case tree.Link() if elements_of(site.follow(written.reference)) == ():
            path = written.reference.path
            message = f"the set '{path}' is empty, so there is no scenario: add an element to it"
            related = (related_to(site, column.ref, "the variable"),)
            yield finding(site, written.reference, Severity.ERROR, "empty-set", message, related)
        case _:
            pass


def _cell(site: Site, written: tree.Node) -> Iterator[Diagnostic]:
    if isinstance(written, tree.ValueList) and not written.values:
        yield finding(site, written, Severity.WARNING, "empty-set", "this set is empty: write its elements")
