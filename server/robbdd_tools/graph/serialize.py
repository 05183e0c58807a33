"""Graphs to text and back: Turtle, JSON-LD, N-Triples, RDF/XML. One graph gives one text, byte for byte."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from robbdd_tools.graph.canonical import canonical
from robbdd_tools.graph.jsonld import context_for, expanded
from robbdd_tools.graph.libraries import Json, compact, json_object, triples
from robbdd_tools.graph.prefixes import bind_prefixes, user_prefixes
from robbdd_tools.graph.vocabulary import expand

if TYPE_CHECKING:
    from rdflib import Graph
    from rdflib.term import Node

FORMATS = {"ttl": "turtle", "json-ld": "json-ld", "nt": "nt", "xml": "xml"}
"""Our name of a format → rdflib's."""


class UnreadableGraph(Exception):
    """A text is not a graph in the format it is said to be in; the message says where it breaks off."""


def serialize(graph: Graph, format: str) -> str:
    """Return a graph as text (a key of ``FORMATS``, else ``ValueError``) with all its prefixes.

    Equal graphs give equal texts: blank nodes are numbered anew and everything is written in order.
    """
    _check_format(format)
    ordered = canonical(graph)
    prefixes = bind_prefixes(ordered, user_prefixes(graph))
    if format == "json-ld":
        context = context_for(prefixes)
        compacted = compact(expanded(ordered), context)
        document = {"@context": context, "@graph": compacted.get("@graph", [])}
        return json.dumps(document, indent=2, ensure_ascii=False) + "\n"
    if format == "nt":
        return "".join(sorted(ordered.serialize(format="nt").splitlines(keepends=True)))
    return ordered.serialize(format=FORMATS[format]).strip("\n") + "\n"


def parse(text: str, format: str) -> Graph:
    """Return the graph that a text says; raises ``UnreadableGraph``, and ``ValueError`` for an unknown format.

    Contexts of JSON-LD must be inside the document; nothing is fetched.
    """
    from rdflib import Graph

    _check_format(format)
    graph = Graph(bind_namespaces="none")
    try:
        if format == "json-ld":
            document: Any = json.loads(text)
            for subject, predicate, value in triples(document):
                graph.add((_node(subject), _node(predicate), _node(value)))
            _bind_context(graph, document)
        else:
            graph.parse(data=text, format=FORMATS[format])
    except Exception as error:  # every rdflib parser has exceptions of its own
        raise UnreadableGraph(f"this is no graph in the format {format}: {str(error).strip() or error!r}") from error
    return graph


def _check_format(format: str) -> None:
    if format not in FORMATS:
        raise ValueError(f"'{format}' is no graph format; there are {', '.join(FORMATS)}")


def _node(term: Json) -> Node:
    from rdflib import BNode, Literal, URIRef

    value = str(term["value"])
    if term["type"] == "blank node":
        return BNode(value.removeprefix("_:"))
    if term["type"] == "IRI":
        return URIRef(value)
    datatype = term.get("datatype")
    if term.get("language"):
        return Literal(value, lang=term["language"])
    return Literal(value) if datatype in (None, expand("xsd:string")) else Literal(value, datatype=URIRef(datatype))


def _bind_context(graph: Graph, document: Any) -> None:
    """Keep the prefixes that a document's own context declares as such."""
    context = json_object(json_object(document).get("@context"))
    for name, definition in context.items():
        namespace = json_object(definition).get("@id") if isinstance(definition, dict) else definition
        if isinstance(namespace, str) and namespace[-1:] in {"/", "#", ":"}:
            graph.bind(name, namespace, override=True, replace=True)
