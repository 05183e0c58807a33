"""Convert values in published JSON-LD. Strings that name a node become IRIs, and all others stay strings."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import Any, cast
from urllib.parse import urljoin

from robbdd_tools.graph.rdf.contexts import ContextLoader, Json, published_context
from robbdd_tools.graph.rdf.libraries import json_object

VALUE_TERMS = ("elements", "of-sets", "rows")
"""Terms whose values the published contexts write as plain strings."""


def with_literals(document: Any, base: str, loader: ContextLoader, prefixes: Collection[str]) -> Any:
    """Return a JSON-LD document that states which of its string values are literals.

    A string names a node if it is an absolute IRI, begins with one of ``prefixes``, or is the ``@id`` of a node in the
    document. If the document has an ``@base``, every string names a node, because the node may be described in another
    file. A document without a published context is returned unchanged.
    """
    contexts = list(contexts_of(document, base, loader))
    if published_context() not in contexts or any("@base" in context for context in contexts):
        return document
    nodes = frozenset(_ids(document))

    def is_node(text: str) -> bool:
        prefix, colon, rest = text.partition(":")
        return text in nodes or (bool(colon) and (rest.startswith("//") or prefix in (*prefixes, "urn")))

    def stated(value: Any) -> Any:
        if isinstance(value, list):
            return [stated(item) for item in cast("list[Any]", value)]
        return {"@value": value} if isinstance(value, str) and not is_node(value) else value

    def walk(value: Any) -> Any:
        if isinstance(value, list):
            return [walk(item) for item in cast("list[Any]", value)]
        if not isinstance(value, dict):
            return value
        entries = cast("dict[str, Any]", value).items()
        return {key: stated(item) if key in VALUE_TERMS else walk(item) for key, item in entries}

    return walk(document)


def contexts_of(document: Any, base: str, loader: ContextLoader) -> Iterator[Json]:
    """Yield the contexts that a JSON-LD document contains or names. Raises ``UnknownContext``."""
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
        elif isinstance(context, dict):
            yield json_object(context)


def _ids(value: Any) -> Iterator[str]:
    items = cast("list[Any]", value) if isinstance(value, list) else json_object(value).values()
    name = json_object(value).get("@id")
    if isinstance(name, str):
        yield name
    for item in items:
        yield from _ids(item)
