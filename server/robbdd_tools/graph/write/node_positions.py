"""Find the positions of a graph's nodes in its text. Tokens are searched, because neither parser keeps positions."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from urllib.parse import urljoin

from robbdd_tools.base.document import Span

_TURTLE = re.compile(
    r"""(?P<skip>\s+|\#[^\n\r]*|\"{3}(?:\\.|[^\\])*?\"{3}|'{3}(?:\\.|[^\\])*?'{3}|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*')
    |<(?P<iri>[^<>"{}|^`\\\s]*)>
    |(?P<prefix>(?:[^\W_][\w\-]*(?:\.[\w\-]+)*)?):(?P<local>(?:[\w\-%:]|\\.|\.(?=[\w\-%:\\]))*)
    |(?P<other>@?\w+|.)""",
    re.VERBOSE | re.DOTALL,
)
_JSON = re.compile(r'"(?P<text>(?:\\.|[^"\\])*)"(?P<key>\s*:)?|(?P<sign>[{}\[\],])', re.DOTALL)
_ID_KEYS = {"@id", "id"}


def turtle_occurrences(text: str, namespaces: Mapping[str, str], base: str) -> dict[str, Span]:
    """Return a position for each IRI: the first one as the subject of a statement, or else its first occurrence."""
    subjects: dict[str, Span] = {}
    others: dict[str, Span] = {}
    before = "."
    for match in _TURTLE.finditer(text):
        if match["skip"] is not None:
            continue
        node: str | None = None
        if match["iri"] is not None:
            node = urljoin(base, match["iri"])
        elif match["prefix"] is not None and match["prefix"] in namespaces:
            local = match["local"]
            node = namespaces[match["prefix"]] + (re.sub(r"\\(.)", r"\1", local) if "\\" in local else local)
        if node is not None:
            known = subjects if before == "." else others
            known.setdefault(node, Span(*match.span()))
        before = match[0]
    return {**others, **subjects}


def json_occurrences(text: str, namespaces: Mapping[str, str], base: str) -> dict[str, Span]:
    """Return a position for each IRI: the ``@id`` of its description, or else its first occurrence."""
    described: dict[str, Span] = {}
    others: dict[str, Span] = {}
    tokens = list(_JSON.finditer(text))
    signs = [token["sign"] or "" for token in tokens]
    for index, token in enumerate(tokens):
        if token["text"] is None or token["key"] is not None:
            continue
        node = _expanded(_unquoted(token["text"]), namespaces, base)
        span = Span(token.start() + 1, token.start() + 1 + len(token["text"]))
        key = tokens[index - 1]["text"] if index and tokens[index - 1]["key"] is not None else None
        alone = key is not None and signs[index - 2 : index - 1] == ["{"] and signs[index + 1 : index + 2] == ["}"]
        known = described if key in _ID_KEYS and not alone else others
        known.setdefault(node, span)
    return {**others, **described}


def _unquoted(text: str) -> str:
    try:
        return str(json.loads(f'"{text}"'))
    except ValueError:
        return text


def _expanded(text: str, namespaces: Mapping[str, str], base: str) -> str:
    prefix, colon, local = text.partition(":")
    if colon and not local.startswith("//"):
        return namespaces[prefix] + local if prefix in namespaces else text
    return text if colon else urljoin(base, text)
