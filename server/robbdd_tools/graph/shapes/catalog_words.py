"""Generate shapes for the catalog's words from their slots."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from robbdd_tools.base.quantity_units import units_of, with_unit
from robbdd_tools.catalog.api import Behaviour, Kind, Predicate, Slot
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.graph.rdf.vocabulary import QUANTITY, SHAPES, SOME_TIME, expand
from robbdd_tools.graph.read.variable_roles import assignment_class, value_shape
from robbdd_tools.graph.shapes.derived import use_of

if TYPE_CHECKING:
    from rdflib import Graph
    from rdflib.term import Node

_CLASSES = {
    Kind.OBJECT: "rbw:ObjectTerm",
    Kind.WORKSPACE: "rbw:WorkspaceTerm",
    Kind.AGENT: "rbw:AgentTerm",
    Kind.OBJECT_SET: "bdd:Set",
    Kind.WORKSPACE_SET: "bdd:Set",
    Kind.ANY: "rbw:ElementTerm",
    Kind.VALUE: "bdd:ScenarioVariable",
}
"""Kind of a slot → the class of its values. A bare name is a literal, so its kind has no class."""
_FIX = {
    Kind.OBJECT_SET: "name a 'set var' or an 'obj set'",
    Kind.WORKSPACE_SET: "name a 'set var' or a 'ws set'",
    Kind.NAME: "write a name without angle brackets",
}
_NUMBER = r"^[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?"


def add_word_shapes(shapes: Graph) -> None:
    """Add a shape for each slot of each predicate and behaviour of the catalog."""
    catalog = load_catalog()
    dimensions: dict[str, None] = {}
    for word in (*catalog.predicates.values(), *catalog.behaviours.values()):
        for slot in word.slots:
            _add_slot_shape(shapes, word, slot)
            dimensions |= dict.fromkeys([slot.dimension] if slot.dimension else [])
        if isinstance(word, Predicate) and word.duration is not None:
            _add_interval_shapes(shapes, word)
    for dimension in dimensions:
        _add_value_shape(shapes, dimension)


def _add_interval_shapes(shapes: Graph, word: Predicate) -> None:
    """Add shapes for a predicate about a duration: it needs a start and an end, but no *at some time* or *whenever*."""
    from rdflib import BNode, Literal, URIRef
    from rdflib.namespace import RDF, SH

    node = URIRef(f"{SHAPES}{word.name}")
    message = Literal(
        f"'{re.sub('#[a-z]+', '…', word.phrase)}' is about the time between two events: write 'from <start> until "
        "<end>', without 'at some time' and 'whenever'"
    )
    some_time = BNode()
    shapes.add((some_time, SH.hasValue, URIRef(expand(SOME_TIME))))
    for name, path, count, limit in (
        ("start", "time:after-event", SH.minCount, 1),
        ("end", "time:before-event", SH.minCount, 1),
        ("whenever", "rbw:whenever", SH.maxCount, 0),
        ("throughout", "rdf:type", SH.qualifiedMaxCount, 0),
    ):
        shape = URIRef(f"{SHAPES}{word.name}-{name}")
        shapes.add((node, SH.property, shape))
        shapes.add((shape, RDF.type, SH.PropertyShape))
        shapes.add((shape, SH.path, URIRef(expand(path))))
        shapes.add((shape, count, Literal(limit)))
        if count == SH.qualifiedMaxCount:
            shapes.add((shape, SH.qualifiedValueShape, some_time))
        shapes.add((shape, SH.severity, SH.Violation))
        shapes.add((shape, SH.message, message))


def _add_value_shape(shapes: Graph, dimension: str) -> None:
    """Add the shape for the values of variables that are quantities of one dimension."""
    from rdflib import Literal, URIRef
    from rdflib.namespace import RDF, SH

    shape = URIRef(SHAPES + value_shape(dimension))
    shapes.add((shape, RDF.type, SH.PropertyShape))
    shapes.add((shape, SH.targetClass, URIRef(expand(assignment_class(dimension)))))
    shapes.add((shape, SH.path, URIRef(expand("rbw:value"))))
    _add_dimension(shapes, shape, dimension)
    shapes.add((shape, SH.severity, SH.Violation))
    message = f"'{{value}}' does not fit '{{variable}}', which is a {dimension} in the clauses: {with_unit(dimension)}"
    shapes.add((shape, SH.message, Literal(message)))


def _add_dimension(shapes: Graph, node: Node, dimension: str) -> None:
    """Require a literal that is a quantity of one dimension."""
    from rdflib import Literal, URIRef
    from rdflib.namespace import SH

    units = "|".join(map(re.escape, units_of(dimension)))
    shapes.add((node, SH.datatype, URIRef(QUANTITY)))
    shapes.add((node, SH.pattern, Literal(rf"{_NUMBER}\s*({units})$")))


def _add_slot_shape(shapes: Graph, word: Predicate | Behaviour, slot: Slot) -> None:
    from rdflib import BNode, Literal, URIRef
    from rdflib.collection import Collection
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
        variable, quantity = BNode(), BNode()
        shapes.add((variable, SH.nodeKind, SH.IRI))
        _add_dimension(shapes, quantity, slot.dimension)
        shapes.add((shape, SH["or"], Collection(shapes, BNode(), [variable, quantity]).uri))
    elif slot.kind is Kind.VALUE:
        variable, value = BNode(), BNode()
        shapes.add((variable, SH["class"], URIRef(expand(_CLASSES[slot.kind]))))
        shapes.add((value, SH.nodeKind, SH.Literal))
        shapes.add((shape, SH["or"], Collection(shapes, BNode(), [variable, value]).uri))
    else:
        shapes.add((shape, SH["class"], URIRef(expand(_CLASSES[slot.kind]))))
    shapes.add((shape, SH.severity, SH.Violation))
    takes = slot.dimension or str(slot.kind)
    fix = _FIX.get(slot.kind, f"name a variable or one {slot.kind}")
    fix = f"{with_unit(slot.dimension)}, or name a variable" if slot.dimension else fix
    message = f"'{{value}}' cannot stand for '{slot.name}' in '{word.phrase}', which takes one {takes}: {fix}"
    shapes.add((shape, SH.message, Literal(message)))
