"""Derive the statements that the shapes need, such as lengths, rows, words and assignments.

They are added to a copy of the graph. Derived statements use the vocabulary of RobBDD and are never written to a file.
Each derived node has the source-map keys of the statements from which it was derived.
"""

from __future__ import annotations

from functools import cache
from itertools import chain
from typing import TYPE_CHECKING

from robbdd_tools.base.data import data_file
from robbdd_tools.graph.acceptance_model import Iri
from robbdd_tools.graph.rdf.records import Records, elements_of, items_of
from robbdd_tools.graph.rdf.vocabulary import NAMED_USE, SELECTIONS, TIME_TYPES, expand
from robbdd_tools.graph.read.variable_roles import clauses_below, roles_in, words_of
from robbdd_tools.graph.shapes.assignments import add_assignments, add_quantified
from robbdd_tools.graph.shapes.derived import Derived, use_of

if TYPE_CHECKING:
    from rdflib import Graph


def derive(graph: Graph, records: Records | None = None) -> Derived:
    """Return a copy of a graph with all derived statements that the shapes need.

    ``records`` are the records of the graph, if known.
    """
    from rdflib import Graph

    # pyshacl needs a store that knows contexts, such as the default one.
    copy = Graph(bind_namespaces="none")
    for triple in chain(load_vocabulary(), graph):
        copy.add(triple)
    derived = Derived(copy, Records(graph) if records is None else records)
    _add_words(derived)
    _add_widths(derived)
    _add_sizes(derived)
    _add_enclosed(derived)
    for template in derived.records.instances("bdd:ScenarioTemplate"):
        roles = roles_in(derived.records, clauses_below(derived.records, [template]))
        for quantifier in roles.quantifiers:
            add_quantified(derived, quantifier, roles)
    for variant in derived.records.instances("bdd:ScenarioVariant"):
        _add_template_scene(derived, variant)
        add_assignments(derived, variant)
    _add_foreign_policies(derived)
    return derived


@cache
def load_vocabulary() -> Graph:
    """Return the vocabulary with the hierarchy of classes on which the shapes rely."""
    from rdflib import Graph

    vocabulary = Graph(bind_namespaces="none")
    return vocabulary.parse(data_file("metamodels", "workbench.ttl"), format="turtle")


def _add_words(derived: Derived) -> None:
    records = derived.records
    uses = [records.instances(kind) for kind in ("bdd:FluentClause", "bdd:WhenBehaviour", "rbw:Condition")]
    for clause in chain.from_iterable(uses):
        for word in words_of(records, clause):
            derived.add(clause, "rdf:type", use_of(word.name))
            derived.add(clause, "rbw:predicate", use_of(word.name))
        if records.is_a(clause, NAMED_USE):
            derived.add(clause, "rbw:predicate", expand(NAMED_USE))
            derived.add(clause, "rbw:values", len(items_of(records, clause, "rbw:argument-list")))
            for predicate in records.iris(records.all(clause, "rbw:named-predicate")):
                derived.add(clause, "rbw:wanted-values", len(items_of(records, predicate, "rbw:parameters")))
        if records.is_a(clause, "bdd:StringTemplatePredicate"):
            derived.add(clause, "rbw:predicate", expand("bdd:StringTemplatePredicate"))
    # A parameter fills a slot in the same way as a variable.
    for parameter in records.instances("rbw:Parameter"):
        for kind in ("bdd:ScenarioVariable", "bdd:Set"):
            derived.add(parameter, "rdf:type", expand(kind))
    for clause in (*records.instances("bdd:FluentClause"), *records.instances("rbw:TextClause")):
        for kind in TIME_TYPES.values():
            if records.is_a(clause, kind):
                derived.add(clause, "rbw:time-kind", expand(kind))


def _add_widths(derived: Derived) -> None:
    records = derived.records
    for table in records.instances("bdd:TableVariation"):
        columns = items_of(records, table, "bdd:variable-list")
        for row in items_of(records, table, "bdd:rows"):
            cells = records.items(row)
            if cells is not None:
                derived.add(table, "rbw:row", row)
                derived.add(row, "rbw:length", len(cells))
                derived.add(row, "rbw:columns", len(columns))
    for product in records.instances("bdd:CartesianProductVariation"):
        if records.all(product, "bdd:of-sets") and records.all(product, "bdd:variable-list"):
            derived.add(product, "rbw:length", len(items_of(records, product, "bdd:of-sets")))
            derived.add(product, "rbw:columns", len(items_of(records, product, "bdd:variable-list")))


def _add_sizes(derived: Derived) -> None:
    records = derived.records
    for selection in (node for kind in SELECTIONS.values() for node in records.instances(kind)):
        repeated = records.text(selection, "bdd:repetition-allowed") == "true"
        for source in records.iris(records.all(selection, "bdd:from")):
            if records.is_a(source, "bdd:ConstantSet") and not repeated:
                derived.add(selection, "rbw:source-size", len(elements_of(records, source)))


def _add_enclosed(derived: Derived) -> None:
    records = derived.records
    inside: dict[str, dict[str, None]] = {}
    compositions = records.subjects("env:of-workspace")
    for composition in compositions:
        for workspace in records.iris(records.all(composition, "env:of-workspace")):
            inner = records.iris(records.all(composition, "env:has-workspace"))
            inside.setdefault(workspace, {}).update(dict.fromkeys(inner))
    for composition in compositions:
        found: dict[str, None] = {}
        waiting: list[str] = list(records.iris(records.all(composition, "env:has-workspace")))
        while waiting:
            workspace = waiting.pop()
            if workspace not in found:
                found[workspace] = None
                waiting += inside.get(workspace, {})
        for workspace in found:
            derived.add(composition, "rbw:encloses", workspace)
            derived.anchor(composition, workspace, (composition, expand("env:of-workspace")))


def _add_template_scene(derived: Derived, variant: Iri) -> None:
    records = derived.records
    if not records.all(variant, "bdd:has-scene"):
        return
    for template in records.iris(records.all(variant, "bdd:of-template")):
        for scene in records.iris(records.all(template, "bdd:has-scene")):
            derived.add(variant, "rbw:template-scene", scene)


def _add_foreign_policies(derived: Derived) -> None:
    records = derived.records
    for execution in records.instances("bdd:ScenarioExecution"):
        for variant in records.iris(records.all(execution, "bdd:of-variant")):
            templates = records.iris(records.all(variant, "bdd:of-template"))
            own = set(clauses_below(records, [variant, *templates]))
            for policy in records.iris(records.all(execution, "obs:has-policy")):
                for clause in records.iris(records.all(policy, "bdd:of-clause")):
                    if clause not in own:
                        derived.add(policy, "rbw:foreign-to", variant)
