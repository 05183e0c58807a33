"""Graphs to text and back: Turtle, JSON-LD, N-Triples, RDF/XML. One graph gives one text, byte for byte."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any
from urllib.parse import urljoin

from robbdd_tools.graph.canonical import canonical
from robbdd_tools.graph.contexts import ContextLoader, Json, UnknownContext
from robbdd_tools.graph.jsonld import context_for, expanded
from robbdd_tools.graph.libraries import compact, json_object, triples
from robbdd_tools.graph.prefixes import bind_prefixes, user_prefixes
from robbdd_tools.graph.vocabulary import expand

if TYPE_CHECKING:
    from rdflib import Graph
    from rdflib.term import Node

FORMATS = {"ttl": "turtle", "json-ld": "json-ld", "nt": "nt", "xml": "xml"}
"""Our name of a format → rdflib's."""


class UnreadableGraph(Exception):
    """A text is not a graph in the format it is said to be in; ``offset`` is where it breaks off, 0 if unknown."""

    def __init__(self, message: str, offset: int = 0) -> None:
        super().__init__(message)
        self.offset = offset


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


def parse(text: str, format: str, base: str = "", loader: ContextLoader | None = None) -> Graph:
    """Return the graph that a text says; raises ``UnreadableGraph``, and ``ValueError`` for an unknown format.

    Relative names are resolved against ``base``. Contexts that JSON-LD names by URL come from ``loader``, by default
    one that fetches nothing.
    """
    from rdflib import Graph

    _check_format(format)
    graph = Graph(bind_namespaces="none")
    loader = loader or ContextLoader()
    try:
        if format == "json-ld":
            document: Any = json.loads(text)
            for subject, predicate, value in triples(document, base, loader):
                graph.add((_node(subject), _node(predicate), _node(value)))
            for name, namespace in context_prefixes(document, base, loader):
                graph.bind(name, namespace, override=True, replace=True)
        else:
            graph.parse(data=text, format=FORMATS[format], publicID=base or None)
    except UnknownContext as error:
        raise UnreadableGraph(str(error)) from error
    except Exception as error:  # every rdflib parser has exceptions of its own
        reason, offset = _fault(error)
        raise UnreadableGraph(f"this is no graph in the format {format}: {reason}", offset) from error
    return graph


def context_prefixes(document: Any, base: str, loader: ContextLoader) -> Iterator[tuple[str, str]]:
    """Yield the prefixes that the contexts of a JSON-LD document declare."""
    waiting: list[Any] = [json_object(document).get("@context")]
    seen: set[str] = set()
    while waiting:
        context = waiting.pop(0)
        if isinstance(context, list):
            waiting += context
        elif isinstance(context, str):
            url = urljoin(base, context)
            if url not in seen:
                seen.add(url)
                waiting.append(json_object(loader.document(url)).get("@context"))
        for name, definition in json_object(context).items():
            namespace = json_object(definition).get("@id") if isinstance(definition, dict) else definition
            if isinstance(namespace, str) and namespace[-1:] in {"/", "#", ":"} and not name.startswith("@"):
                yield name, namespace


def _fault(error: Exception) -> tuple[str, int]:
    """Return why and where a parser gave up; each has its own way of telling."""
    if isinstance(error, json.JSONDecodeError):
        return error.msg, error.pos
    why, offset = getattr(error, "_why", None), getattr(error, "_i", None)
    if isinstance(why, str) and isinstance(offset, int):
        return why, offset
    return str(error).strip() or repr(error), 0


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
