"""Convert clauses of older published models. Their predicate and time are separate nodes (holds, holds-at)."""

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
    """Copy the statements about the separate nodes of a clause's predicate and time constraint to the clause itself.

    Nothing is removed. ``time:ref-event`` is copied to the property that the type of the constraint requires.
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
