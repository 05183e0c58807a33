"""Derive one node for each variant and variable, with the variable's values, their number and its kinds."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.graph.acceptance_model import Iri
from robbdd_tools.graph.rdf.records import Records, elements_of, items_of
from robbdd_tools.graph.rdf.vocabulary import SELECTIONS, expand
from robbdd_tools.graph.read.variable_roles import Roles, assignment_class, clauses_below, roles_in
from robbdd_tools.graph.shapes.derived import Derived

if TYPE_CHECKING:
    from rdflib.term import Node


@dataclass(frozen=True, slots=True)
class _Choice:
    """One value that a variable may get: the node as written, whether it is a set, and the elements in it."""

    written: Node
    is_set: bool
    values: tuple[Node, ...]


def add_assignments(derived: Derived, variant: Iri) -> None:
    """Derive the assignments of a variant to the variables of its template.

    This includes variables that only the variation of the variant names.
    """
    records = derived.records
    templates = records.iris(records.all(variant, "bdd:of-template"))
    variations = records.iris(records.all(variant, "bdd:has-variation"))
    if len(templates) != 1 or len(variations) != 1 or not records.is_a(templates[0], "bdd:ScenarioTemplate"):
        return
    roles = roles_in(records, clauses_below(records, [templates[0], variant]))
    declared = _declared(records, templates[0], roles)
    is_told = bool(records.all(templates[0], "rbw:variables"))
    variation = variations[0]
    assigned = records.iris(items_of(records, variation, "bdd:variable-list"))
    for variable in dict.fromkeys([*declared, *assigned]):
        kinds = roles.kinds.get(variable, {})
        shape = "rbw:SetAssignment" if records.is_a(variable, "bdd:Set") else "rbw:PlainAssignment"
        node = derived.new_node(["rbw:Assignment", shape, *map(assignment_class, kinds)])
        derived.add(node, "rbw:variable", variable)
        derived.add(node, "rbw:times", assigned.count(variable))
        derived.add(node, "rbw:declared", variable in declared or not is_told)
        if variable in assigned:
            derived.anchor(node, "", (variation, expand("bdd:variable-list"), variable))
            _add_choices(derived, node, variation, variable, assigned)
        else:
            derived.anchor(node, "", (variant,))


def add_quantified(derived: Derived, quantifier: Iri, roles: Roles) -> None:
    """Derive the values of a quantified variable whose set is written as a list."""
    records = derived.records
    for set_ in records.iris(records.all(quantifier, "bdd:in-set")):
        if not records.is_a(set_, "bdd:ConstantSet"):
            continue
        node = derived.new_node(assignment_class(kind) for kind in roles.kinds.get(set_, {}))
        derived.anchor(node, "", (quantifier, expand("bdd:in-set")))
        for variable in records.iris(records.all(quantifier, "bdd:ref-variable")):
            derived.add(node, "rbw:variable", variable)
        for value in elements_of(records, set_):
            derived.add(node, "rbw:value", value)


def _declared(records: Records, template: Iri, roles: Roles) -> tuple[Iri, ...]:
    """Return the variables of a template.

    If the graph does not list them, return the unbound variables of its clauses.
    """
    if records.all(template, "rbw:variables"):
        return records.iris(items_of(records, template, "rbw:variables"))
    bound = {
        variable
        for quantifier in roles.quantifiers
        for variable in records.iris(records.all(quantifier, "bdd:ref-variable"))
    }
    used = (Iri(name) for name in roles.kinds if records.is_a(name, "bdd:ScenarioVariable"))
    return tuple(name for name in used if name not in bound)


def _add_choices(derived: Derived, node: Node, variation: Iri, variable: Iri, assigned: tuple[Iri, ...]) -> None:
    is_table = derived.records.is_a(variation, "bdd:TableVariation")
    pick = _cells if is_table else _choices
    found = dict.fromkeys(pick(derived.records, variation, assigned, variable))
    if not is_table:
        derived.add(node, "rbw:choices", len(found))
    for choice in found:
        written = str(choice.written)
        key = (str(variation), str(variable), written)
        derived.add(node, "rbw:several" if choice.is_set else "rbw:single", choice.written)
        derived.anchor(node, written, key)
        for value in choice.values:
            derived.add(node, "rbw:value", value)
            inner = (str(variation), str(variable), str(value))
            derived.anchor(node, str(value), inner, key)


def _cells(records: Records, table: Iri, assigned: Iterable[Iri], variable: Iri) -> Iterator[_Choice]:
    columns = [index for index, name in enumerate(assigned) if name == variable]
    for row in items_of(records, table, "bdd:rows"):
        cells = records.items(row) or ()
        yield from (_choice(records, cells[index]) for index in columns if index < len(cells))


def _choices(records: Records, product: Iri, assigned: Iterable[Iri], variable: Iri) -> Iterator[_Choice]:
    for name, entry in zip(assigned, items_of(records, product, "bdd:of-sets"), strict=False):
        if name != variable:
            continue
        if any(records.is_a(str(entry), kind) for kind in SELECTIONS.values()):
            sources = records.iris(records.all(str(entry), "bdd:from"))
            values = tuple(value for source in sources for value in elements_of(records, source))
            # Published graphs select one element for a variable that is not a set.
            single = records.literal(str(entry), "bdd:length") == 1 and not records.is_a(variable, "bdd:Set")
            yield from (
                (_Choice(entry, False, (value,)) for value in values) if single else [_Choice(entry, True, values)]
            )
        elif records.is_a(str(entry), "bdd:ConstantSet"):
            yield from (_Choice(entry, False, (value,)) for value in elements_of(records, str(entry)))
        else:
            yield from (_choice(records, item) for item in records.items(entry) or ())


def _choice(records: Records, node: Node) -> _Choice:
    """Return the value of one cell. A list is a set, and so is the name of a set."""
    items = records.items(node)
    if items is None and records.is_a(str(node), "bdd:ConstantSet"):
        items = elements_of(records, str(node))
    return _Choice(node, items is not None, (node,) if items is None else items)
