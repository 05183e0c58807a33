"""Convert a graph to expanded JSON-LD, and make the context that keeps it readable."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from robbdd_tools.catalog.term_prefixes import PREFIXES
from robbdd_tools.graph.rdf.canonical import sort_text
from robbdd_tools.graph.rdf.contexts import Json, bundled_context
from robbdd_tools.graph.rdf.libraries import json_object
from robbdd_tools.graph.rdf.lists import Lists
from robbdd_tools.graph.rdf.vocabulary import expand

if TYPE_CHECKING:
    from rdflib import Graph
    from rdflib.term import Node


def context_for(prefixes: Mapping[str, str]) -> Json:
    """Return the context of RobBDD with all prefixes of a graph. A prefix replaces a term of the same name."""
    names = {namespace: prefix for prefix, namespace in prefixes.items()}
    renamed = {name: names[namespace] for name, namespace in PREFIXES.items()}
    terms = {
        term: _rename(definition, renamed)
        for term, definition in bundled_context().items()
        if term not in PREFIXES and term not in prefixes
    }
    bound = {prefix: {"@id": namespace, "@prefix": True} for prefix, namespace in sorted(prefixes.items())}
    return {**bound, **terms}


def expanded(graph: Graph) -> list[Json]:
    """Return the nodes of a graph as expanded JSON-LD in order. RDF lists are written as lists."""
    from rdflib.namespace import RDF

    lists = Lists(graph)
    subjects = sorted({subject for subject in graph.subjects() if not lists.is_cell(subject)}, key=sort_text)
    nodes: list[Json] = []
    for subject in subjects:
        node: Json = {"@id": _name(subject)}
        pairs = sorted(graph.predicate_objects(subject), key=lambda pair: (sort_text(pair[0]), sort_text(pair[1])))
        for predicate, value in pairs:
            if predicate == RDF.type:
                node.setdefault("@type", []).append(_name(value))
            else:
                node.setdefault(str(predicate), []).append(_value(value, lists))
        nodes.append(node)
    return nodes


def _rename(definition: Any, renamed: Mapping[str, str]) -> Any:
    if isinstance(definition, dict):
        return {key: _rename(value, renamed) for key, value in json_object(definition).items()}
    prefix, colon, local = str(definition).partition(":")
    return f"{renamed[prefix]}:{local}" if colon and prefix in renamed else definition


def _name(node: Node) -> str:
    from rdflib import BNode

    return f"_:{node}" if isinstance(node, BNode) else str(node)


def _value(node: Node, lists: Lists) -> Json:
    from rdflib import Literal

    items = lists.items(node)
    if items is not None:
        return {"@list": [_value(item, lists) for item in items]}
    if not isinstance(node, Literal):
        return {"@id": _name(node)}
    if node.language:
        return {"@value": str(node), "@language": node.language}
    datatype = str(node.datatype or "")
    if not datatype:
        return {"@value": str(node)}
    native = {expand("xsd:boolean"): bool, expand("xsd:integer"): int}.get(datatype)
    if native is not None and isinstance(node.value, native):
        return {"@value": node.value}
    return {"@value": str(node), "@type": datatype}
