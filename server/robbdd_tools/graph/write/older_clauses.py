"""Clauses of older published models, which name their predicate and time as nodes of their own (holds, holds-at)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.graph.rdf.vocabulary import expand

if TYPE_CHECKING:
    from rdflib import Graph

PARTS = ("bdd:holds", "bdd:holds-at", "bdd:predicate", "bdd:time-constraint")
"""Links from a clause to its predicate and to its time constraint."""
_EVENTS = {
    "time:BeforeEventConstraint": "time:before-event",
    "time:AfterEventConstraint": "time:after-event",
}


def complete_clauses(graph: Graph) -> None:
    """State on each clause what its predicate and time constraint state on nodes of their own; nothing is removed.

    ``time:ref-event`` becomes the property that the constraint's type asks for.
    """
    from rdflib import RDF, URIRef

    for kind, term in _EVENTS.items():
        for constraint in list(graph.subjects(RDF.type, URIRef(expand(kind)))):
            for event in list(graph.objects(constraint, URIRef(expand("time:ref-event")))):
                graph.add((constraint, URIRef(expand(term)), event))
    for part in PARTS:
        for clause, node in list(graph.subject_objects(URIRef(expand(part)))):
            for predicate, value in list(graph.predicate_objects(node)):
                graph.add((clause, predicate, value))
