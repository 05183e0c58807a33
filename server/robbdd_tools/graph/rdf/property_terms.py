"""Terms of graphs that are properties of elements, and nodes that are their values."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from robbdd_tools.base.property_values import ELEMENT, NUMBER, TEXT, TRUTH, PropertyValue, quantity_value
from robbdd_tools.catalog.term_prefixes import PREFIXES
from robbdd_tools.graph.rdf.vocabulary import QUANTITY, expand

if TYPE_CHECKING:
    from rdflib.term import Node

_OF_VOCABULARIES = (*PREFIXES.values(), "http://www.w3.org/2000/01/rdf-schema#", "http://www.w3.org/2002/07/owl#")
"""Namespaces whose properties are not properties of elements."""
_LOCAL = re.compile(r"[^\W\d][\w\-]*\Z")
_NUMBERS = tuple(
    expand(f"xsd:{kind}") for kind in ("integer", "decimal", "double", "float", "int", "nonNegativeInteger")
)


def property_name(term: str) -> str | None:
    """Return the name of a property with the given IRI; ``None`` for terms of RDF and of the published vocabulary."""
    match = _LOCAL.search(term, max(term.rfind(sign) for sign in "/#:") + 1)
    return None if match is None or term[: match.start()] in _OF_VOCABULARIES else match[0]


def value_of(node: Node) -> PropertyValue | None:
    """Return the value that a node of a graph denotes; ``None`` for a blank node."""
    from rdflib import BNode, Literal

    text = str(node)
    if not isinstance(node, Literal):
        return None if isinstance(node, BNode) else PropertyValue(ELEMENT, text)
    kind = str(node.datatype or "")
    if kind == QUANTITY:
        return quantity_value(text)
    if kind == expand("xsd:boolean"):
        return PropertyValue(TRUTH, {"1": "true", "0": "false"}.get(text, text))
    return PropertyValue(NUMBER if kind in _NUMBERS else TEXT, text)
