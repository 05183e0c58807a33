"""The only place where the loosely typed graph libraries are called; everything beyond it is fully typed."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from functools import cache
from typing import TYPE_CHECKING, Any, cast

from robbdd_tools.base.data import data_file

if TYPE_CHECKING:
    from rdflib import Graph

Json = dict[str, Any]
CONTEXT_FILE = "context.jsonld"


class UnknownContext(Exception):
    """A JSON-LD document names a context by a URL; the message says what to do. Nothing is ever fetched."""


def compact(expanded: list[Json], context: Json) -> Json:
    """Compact expanded JSON-LD with a context; raises ``UnknownContext`` when the context names another by URL."""
    jsonld = _jsonld()
    options = {"documentLoader": _no_network, "graph": True, "compactArrays": True}
    return cast(Json, jsonld.compact(expanded, {"@context": context}, options))


def triples(document: Any) -> Iterator[tuple[Json, Json, Json]]:
    """Yield the triples of a JSON-LD document, of all its graphs, as ``{type, value, datatype, language}`` objects.

    Raises ``UnknownContext`` or ``ValueError``.
    """
    jsonld = _jsonld()
    try:
        dataset = cast("dict[str, list[Json]]", jsonld.to_rdf(document, {"documentLoader": _no_network}))
    except jsonld.JsonLdError as error:
        cause = _unknown_context(error)
        if cause is not None:
            raise cause from error
        raise ValueError(str(error).partition("\n")[0]) from error
    for graph in dataset.values():
        yield from ((triple["subject"], triple["predicate"], triple["object"]) for triple in graph)


def shacl_report(graph: Graph, shapes: Graph) -> Graph:
    """Return the SHACL validation report of a graph, without inference; the graph is left as it is."""
    import pyshacl

    outcome = cast(Any, pyshacl).validate(graph, shacl_graph=shapes, inference="none", inplace=True)
    return cast("Graph", outcome[1])


def json_object(value: Any) -> Json:
    """Return a JSON value if it is an object, else an empty one."""
    return cast(Json, value) if isinstance(value, dict) else {}


@cache
def bundled_context() -> Json:
    """Return our JSON-LD context."""
    text = data_file("metamodels", CONTEXT_FILE).read_text(encoding="utf-8")
    return cast(Json, json.loads(text)["@context"])


def _jsonld() -> Any:
    from pyld import jsonld  # pyright: ignore[reportMissingTypeStubs] -- pyld has no types

    return jsonld


def _no_network(url: str, _options: Mapping[str, Any]) -> Json:
    if url.rpartition("/")[2] == CONTEXT_FILE:
        return {
            "contentType": "application/ld+json",
            "contextUrl": None,
            "documentUrl": url,
            "document": {"@context": bundled_context()},
        }
    raise UnknownContext(f"the context '{url}' is not fetched: write the context into the document itself")


def _unknown_context(error: BaseException | None) -> UnknownContext | None:
    while error is not None:
        if isinstance(error, UnknownContext):
            return error
        error = getattr(error, "cause", None) or error.__cause__
    return None
