"""``quantity``: a predicate gets a quantity of another dimension than it needs, or a negative limit."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.base.quantity_units import QuantityError, dimension_of, read_limit, read_quantity
from robbdd_tools.catalog.api import Kind
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.checks.chosen_elements import written_elements
from robbdd_tools.checks.finding import change, finding, related_to
from robbdd_tools.checks.replacements import with_units
from robbdd_tools.checks.template_variants import scenarios
from robbdd_tools.names.types import variable_key
from robbdd_tools.names.uses import clauses_of
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic, Fix
    from robbdd_tools.catalog.api import Slot
    from robbdd_tools.checks.template_variants import Scenario
    from robbdd_tools.names.elements import Site
    from robbdd_tools.names.uses import Clauses

CODE = "quantity"


def quantity(site: Site) -> Iterator[Diagnostic]:
    """Report quantities in clauses, and values of variables in variations, that do not fit their predicate."""
    for clauses in clauses_of(site.placed.declaration):
        for slot, written in _slots(clauses):
            if isinstance(written, tree.Quantity) and (problem := _problem(written.text, slot)):
                fixes = _fixes(site, written, written.text, slot)
                yield finding(site, written, Severity.ERROR, CODE, problem, fixes=fixes)
    for scenario in scenarios(site):
        yield from _values(scenario)


def _values(scenario: Scenario) -> Iterator[Diagnostic]:
    needed: dict[str, list[tuple[Site, tree.Ref, Slot]]] = {}
    for site, clauses in ((scenario.site, scenario.clauses), (scenario.template, scenario.outer)):
        if site is None or clauses is None:
            continue
        for slot, written in _slots(clauses):
            variable = site.target(written) if isinstance(written, tree.Ref) else None
            if variable is not None and isinstance(written, tree.Ref):
                needed.setdefault(variable_key(variable), []).append((site, written, slot))
    for column in scenario.columns if needed else ():
        uses = needed.get(variable_key(column.variable), ()) if column.variable is not None else ()
        for written in column.written if uses else ():
            for node, element in written_elements(scenario.site, written):
                # For any other value, ``type-conflict`` is reported.
                for site, ref, slot in uses if element.kind == "quantity" else ():
                    problem = _problem(element.name, slot)
                    if problem:
                        related = (related_to(site, ref, f"the {slot.name} that it is used for"),)
                        fixes = _fixes(scenario.site, node, element.name, slot)
                        yield finding(scenario.site, node, Severity.ERROR, CODE, problem, related, fixes)
                        break


def _slots(clauses: Clauses) -> Iterator[tuple[Slot, tree.Argument]]:
    """Yield the slots for quantities in clauses, with the terms that fill them."""
    catalog = load_catalog()
    for phrase in clauses.phrases:
        word = catalog.predicates.get(phrase.word) or catalog.behaviours[phrase.word]
        written = dict(phrase.arguments)
        yield from ((slot, written[slot.name]) for slot in word.slots if slot.kind is Kind.QUANTITY)


def _problem(text: str, slot: Slot) -> str:
    read = read_limit if slot.unsigned else read_quantity
    try:
        read(text, slot.dimension)
    except QuantityError as error:
        return str(error)
    return ""


def _fixes(site: Site, node: tree.Node, text: str, slot: Slot) -> tuple[Fix, ...]:
    """Return the fix that removes the sign of a negative limit, or those that change the unit."""
    if dimension_of(text) != slot.dimension:
        return tuple(with_units(site, node, slot.dimension))
    positive = text.lstrip("-")
    return (change(site, f"Change to '{positive}'", node, positive),)
