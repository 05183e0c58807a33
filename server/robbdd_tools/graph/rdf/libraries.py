"""The only module that calls the loosely typed graph libraries; all other modules are fully typed."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, cast

from robbdd_tools.graph.rdf.contexts import ContextLoader, Json, UnknownContext

if TYPE_CHECKING:
    from rdflib import Graph


def compact(expanded: list[Json], context: Json) -> Json:
    """Compact expanded JSON-LD with a context.

    Raises ``UnknownContext`` if the context refers to another one by URL.
    """
    jsonld = _jsonld()
    options = {"documentLoader": ContextLoader(), "graph": True, "compactArrays": True}
    return cast(Json, jsonld.compact(expanded, {"@context": context}, options))


def frame(expanded: list[Json], context: Json, kind: str) -> list[Json]:
    """Return the nodes of a class as JSON-LD trees. All nodes that are reachable from a node are embedded in it once.

    ``kind`` is the CURIE of the class in the context.
    """
    jsonld = _jsonld()
    options = {"documentLoader": ContextLoader(), "omitGraph": False, "omitDefault": True}
    framed = jsonld.frame(expanded, {"@context": context, "@type": kind, "@embed": "@once"}, options)
    return cast("list[Json]", framed["@graph"])


def triples(document: Any, base: str, loader: ContextLoader) -> Iterator[tuple[Json, Json, Json]]:
    """Yield the triples of all graphs in a JSON-LD document as objects ``{type, value, datatype, language}``.

    Relative names are resolved against ``base``. Raises ``UnknownContext`` or ``ValueError``.
    """
    jsonld = _jsonld()
    try:
        options = {"documentLoader": loader, "base": base}
        dataset = cast("dict[str, list[Json]]", jsonld.to_rdf(document, options))
    except jsonld.JsonLdError as error:
        cause = _unknown_context(error)
        if cause is not None:
            raise cause from error
        raise ValueError(_reason(error)) from error
    for graph in dataset.values():
        yield from ((triple["subject"], triple["predicate"], triple["object"]) for triple in graph)


class UnusableShapes(Exception):
    """The shapes cannot be used because pyshacl rejects them. ``message`` is the reason that pyshacl gives."""


def shacl_report(graph: Graph, shapes: Graph) -> Graph:
    """Return the SHACL validation report of a graph. Raises ``UnusableShapes``.

    Nothing is inferred, and the graph stays unchanged.
    """
    import pyshacl

    _keep_sparql_off_the_network()
    # pyshacl also logs the errors that it raises.
    logging.getLogger("pyshacl-validate").disabled = True
    try:
        outcome = cast(Any, pyshacl).validate(graph, shacl_graph=shapes, inference="none", inplace=True)
    except Exception as error:  # Shapes may contain anything, and pyshacl raises any exception.
        raise UnusableShapes(str(getattr(error, "message", "") or error)) from error
    if not hasattr(outcome[1], "triples"):
        raise UnusableShapes(str(outcome[2]).strip() or repr(outcome[1]))
    return cast("Graph", outcome[1])


def _keep_sparql_off_the_network() -> None:
    """Prevent SPARQL in shapes from contacting a server by ``SERVICE`` or ``FROM``, in any spelling."""
    from rdflib.plugins import sparql

    def refuse_service(_context: object, part: Any) -> Any:
        if part.name == "ServiceGraphPattern":
            raise UnusableShapes("a SPARQL query in a shape can read only this model: SERVICE is not supported")
        raise NotImplementedError  # This signal makes rdflib evaluate the part itself.

    loose: Any = sparql
    loose.SPARQL_LOAD_GRAPHS = False
    loose.CUSTOM_EVALS["robbdd"] = refuse_service


def json_object(value: Any) -> Json:
    """Return a JSON value if it is an object, otherwise an empty object."""
    return cast(Json, value) if isinstance(value, dict) else {}


def _jsonld() -> Any:
    from pyld import jsonld  # pyright: ignore[reportMissingTypeStubs] -- pyld has no types

    return jsonld


def _reason(error: BaseException) -> str:
    """Return the message of the cause of a JSON-LD error, with the part of the document, if known."""
    while isinstance(cause := getattr(error, "cause", None) or error.__cause__, BaseException):
        error = cause
    message = str(error.args[0] if error.args else error).partition("\n")[0].rstrip(".")
    details = getattr(error, "details", None)
    parts = [f"{name} {value}" for name, value in json_object(details).items() if isinstance(value, str)]
    return f"{message} ({', '.join(parts)})" if parts else message


def _unknown_context(error: BaseException | None) -> UnknownContext | None:
    while error is not None:
        if isinstance(error, UnknownContext):
            return error
        error = getattr(error, "cause", None) or error.__cause__
    return None
