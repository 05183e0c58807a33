"""Serialise and parse graphs: Turtle, JSON-LD, N-Triples, RDF/XML. Equal graphs give equal bytes."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, cast

from robbdd_tools.base.printable import printable, printable_json, printable_terms, printable_xml
from robbdd_tools.graph.rdf.canonical import canonical
from robbdd_tools.graph.rdf.contexts import ContextLoader, Json, UnknownContext
from robbdd_tools.graph.rdf.json_ld import context_for, expanded
from robbdd_tools.graph.rdf.libraries import compact, frame, json_object, triples
from robbdd_tools.graph.rdf.lists import Lists
from robbdd_tools.graph.rdf.prefixes import bind_prefixes, user_prefixes
from robbdd_tools.graph.rdf.published_values import contexts_of, with_literals
from robbdd_tools.graph.rdf.vocabulary import expand

if TYPE_CHECKING:
    from rdflib import Graph
    from rdflib.term import Node

FORMATS = {"ttl": "turtle", "json-ld": "json-ld", "json-ld-expanded": "json-ld", "nt": "nt", "xml": "xml"}
"""Our name of a format → rdflib's name."""
_SURROGATE = "[\ud800-\udfff]"
_NOT_XML = "[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]"
"""Characters that XML 1.0 cannot represent."""


class UnreadableGraph(Exception):
    """A text is not a graph in the given format. ``offset`` is the position of the error; 0 if unknown."""

    def __init__(self, message: str, offset: int = 0) -> None:
        super().__init__(message)
        self.offset = offset


class UnwritableGraph(Exception):
    """A format cannot represent a text of the graph.

    The message names the character, and the formats that can represent it.
    """


def serialize(graph: Graph, format: str) -> str:
    """Return a graph with all its prefixes as text in a format.

    Equal graphs give equal texts, because blank nodes are renumbered and everything is sorted. Raises
    ``UnwritableGraph`` for a character that the format cannot represent, and ``ValueError`` if the format is not a key
    of ``FORMATS``.
    """
    _check_format(format)
    if not format.startswith("json"):
        _check_characters(graph, _NOT_XML if format == "xml" else _SURROGATE, format)
    ordered = canonical(graph)
    prefixes = bind_prefixes(ordered, user_prefixes(graph))
    if format == "json-ld":
        context = context_for(prefixes)
        document = {"@context": context, "@graph": _by_story(expanded(ordered), context)}
        return printable_json(document, indent=2) + "\n"
    if format == "json-ld-expanded":
        return printable_json(expanded(ordered), indent=2) + "\n"
    if format == "nt":
        # splitlines is not used, because it also splits at control characters within a text.
        lines = ordered.serialize(format="nt").rstrip("\n").split("\n")
        return printable_terms("".join(sorted(f"{line}\n" for line in lines if line)))
    text = (
        printable_terms(_turtle(ordered))
        if format == "ttl"
        else printable_xml(ordered.serialize(format=FORMATS[format]))
    )
    return text.strip("\n") + "\n"


def _check_characters(graph: Graph, refused: str, format: str) -> None:
    search = re.compile(refused).search
    for triple in graph:
        for term in triple:
            found = search(str(term))
            if found is not None:
                others = (
                    "ttl, nt and json-ld" if refused is _NOT_XML and not re.search(_SURROGATE, found[0]) else "json-ld"
                )
                text = printable(str(term)[:80])
                raise UnwritableGraph(f"{format} cannot hold {printable(found[0])} of '{text}'; {others} can")


def _turtle(graph: Graph) -> str:
    """Return a graph as Turtle.

    Numbers keep all their digits, while rdflib would write only six. Cyclic lists are written cell by cell, because
    rdflib would follow them for ever.
    """
    from io import BytesIO

    from rdflib import Literal
    from rdflib.namespace import RDF, XSD
    from rdflib.plugins.serializers.turtle import TurtleSerializer

    lists = Lists(graph)

    class Exact(TurtleSerializer):
        def isValidList(self, l_: Node) -> bool:
            return l_ != RDF.nil and lists.items(l_) is not None

        def label(self, node: Node, position: int) -> str:
            short: str = super().label(node, position)
            if isinstance(node, Literal) and node.datatype == XSD.double and isinstance(node.value, float):
                exact = repr(node.value)
                return short if float(short) == node.value else exact if "e" in exact else f"{exact}e0"
            return short

    stream = BytesIO()
    Exact(graph).serialize(stream, encoding="utf-8")
    return stream.getvalue().decode()


def _by_story(nodes: list[Json], context: Json) -> list[Json]:
    """Return each story with all nodes that belong to it embedded, and then all other nodes.

    A graph with blank nodes outside of lists stays flat, because embedding would separate nodes with the same label.
    """
    compacted: list[Json] = compact(nodes, context).get("@graph", [])
    stories = [node for node in nodes if expand("bdd:UserStory") in node.get("@type", ())]
    if not stories or any(str(node["@id"]).startswith("_:") for node in nodes):
        return compacted
    described: set[str] = set()
    framed = [_once(story, described) for story in frame(nodes, context, expand("bdd:UserStory"))]
    return [*framed, *(node for node in compacted if node["@id"] not in described)]


def _once(value: Any, described: set[str]) -> Any:
    """Replace repeated descriptions of a node by references. Otherwise, a list in them would become several lists."""
    if isinstance(value, list):
        return [_once(item, described) for item in cast("list[Any]", value)]
    fields = json_object(value)
    if len(fields) > 1 and "@id" in fields:
        if fields["@id"] in described:
            return {"@id": fields["@id"]}
        described.add(fields["@id"])
    return {key: _once(item, described) for key, item in fields.items()} if fields else value


def parse(text: str, format: str, base: str = "", loader: ContextLoader | None = None) -> Graph:
    """Parse a text as a graph. Raises ``UnreadableGraph``, and ``ValueError`` for an unknown format.

    Relative names are resolved against ``base``. ``loader`` provides the contexts that JSON-LD names by URL; the
    default loader fetches nothing.
    """
    from rdflib import Graph

    _check_format(format)
    # rdflib's default store also keeps the context of each triple.
    graph = Graph("SimpleMemory", bind_namespaces="none")
    loader = (loader or ContextLoader()).beside(base)
    try:
        if FORMATS[format] == "json-ld":
            document: Any = json.loads(text)
            prefixes = dict(context_prefixes(document, base, loader))
            stated = with_literals(document, base, loader, prefixes)
            for subject, predicate, value in triples(stated, base, loader):
                graph.add((_node(subject), _node(predicate), _node(value)))
            for name, namespace in prefixes.items():
                graph.bind(name, namespace, override=True, replace=True)
        else:
            graph.parse(data=text, format=FORMATS[format], publicID=base or None)
    except UnknownContext as error:
        raise UnreadableGraph(str(error)) from error
    except Exception as error:  # Every rdflib parser has its own exceptions.
        reason, offset = _fault(error)
        raise UnreadableGraph(f"this is not a graph in the format {format}: {reason}", offset) from error
    return graph


def context_prefixes(document: Any, base: str, loader: ContextLoader) -> Iterator[tuple[str, str]]:
    """Yield the prefixes that the contexts of a JSON-LD document declare."""
    for context in contexts_of(document, base, loader):
        for name, definition in context.items():
            namespace = json_object(definition).get("@id") if isinstance(definition, dict) else definition
            if isinstance(namespace, str) and namespace[-1:] in {"/", "#", ":"} and not name.startswith("@"):
                yield name, namespace


def _fault(error: Exception) -> tuple[str, int]:
    """Return the reason and the position of a parser's error. Each parser reports them in another way."""
    if isinstance(error, json.JSONDecodeError):
        return error.msg, error.pos
    why, offset = getattr(error, "_why", None), getattr(error, "_i", None)
    if isinstance(why, str) and isinstance(offset, int):
        return why, offset
    return str(error).strip() or repr(error), 0


def _check_format(format: str) -> None:
    if format not in FORMATS:
        raise ValueError(f"'{format}' is not a graph format; there are {', '.join(FORMATS)}")


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
