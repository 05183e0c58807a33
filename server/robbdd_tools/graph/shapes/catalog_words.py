"""Generate the shapes of the catalog's words from the slots of these words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Behaviour, Kind, Predicate, Slot
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.graph.rdf.vocabulary import SHAPES, expand
from robbdd_tools.graph.shapes.derived import use_of

if TYPE_CHECKING:
    from rdflib import Graph

_CLASSES = {
    Kind.OBJECT: "rbw:ObjectTerm",
    Kind.WORKSPACE: "rbw:WorkspaceTerm",
    Kind.AGENT: "rbw:AgentTerm",
    Kind.OBJECT_SET: "bdd:Set",
    Kind.WORKSPACE_SET: "bdd:Set",
    Kind.ANY: "rbw:ElementTerm",
    Kind.VALUE: "bdd:ScenarioVariable",
}
"""Class of the values of each slot kind; a bare name is a literal."""
_FIX = {
    Kind.OBJECT_SET: "name a 'set var' or an 'obj set'",
    Kind.WORKSPACE_SET: "name a 'set var' or a 'ws set'",
    Kind.NAME: "write a name without angle brackets",
    Kind.QUANTITY: "write a number with a unit, or name a variable",
}


def add_word_shapes(shapes: Graph) -> None:
    """Add a shape for each slot of each predicate and behaviour of the catalog."""
    catalog = load_catalog()
    for word in (*catalog.predicates.values(), *catalog.behaviours.values()):
        for slot in word.slots:
            _add_slot_shape(shapes, word, slot)


def _add_slot_shape(shapes: Graph, word: Predicate | Behaviour, slot: Slot) -> None:
    from rdflib import Literal, URIRef
    from rdflib.namespace import RDF, SH

    node, shape = (URIRef(f"{SHAPES}{name}") for name in (word.name, f"{word.name}-{slot.name}"))
    shapes.add((node, RDF.type, SH.NodeShape))
    shapes.add((node, SH.targetClass, URIRef(use_of(word.name))))
    shapes.add((node, SH.property, shape))
    shapes.add((shape, RDF.type, SH.PropertyShape))
    shapes.add((shape, SH.path, URIRef(expand(slot.property))))
    for count in (SH.minCount, SH.maxCount):
        shapes.add((shape, count, Literal(1)))
    if slot.kind is Kind.NAME:
        shapes.add((shape, SH.nodeKind, SH.Literal))
    elif slot.kind is Kind.QUANTITY:
        shapes.add((shape, SH.nodeKind, SH.IRIOrLiteral))
    else:
        shapes.add((shape, SH["class"], URIRef(expand(_CLASSES[slot.kind]))))
    shapes.add((shape, SH.severity, SH.Violation))
    fix = _FIX.get(slot.kind, f"name a variable or one {slot.kind}")
    message = f"'{{value}}' cannot stand for '{slot.name}' in '{word.phrase}', which takes one {slot.kind}: {fix}"
    shapes.add((shape, SH.message, Literal(message)))
