"""Find the positions of a graph's nodes in its text. Tokens are searched, because neither parser keeps positions."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
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
_TYPE = "http://www.w3.org/1999/02/22-rdf-syntax-ns#type"
_ID_KEYS = {"@id", "id"}


def turtle_occurrences(text: str, namespaces: Mapping[str, str], base: str) -> dict[str, Span]:
    """Return a position for each IRI: its first place as the subject of a statement, or else its first occurrence."""
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


@dataclass(slots=True)
class _Statements:
    """The current statement at one level of nesting: its subject, its predicate and the kind of the next node."""

    subject: str | None = None
    predicate: str | None = None
    follows: str = "subject"


def turtle_statements(text: str, namespaces: Mapping[str, str], base: str) -> dict[tuple[str, ...], Span]:
    """Return the position of each property of a named subject, and of each of its values that are IRIs.

    A key is (subject, predicate) for a property, and (subject, predicate, value) for a value. Statements about blank
    nodes are left out.
    """
    found: dict[tuple[str, ...], Span] = {}
    levels = [_Statements()]
    tokens = (match for match in _TURTLE.finditer(_simplified(text)) if match["skip"] is None)
    for match in tokens:
        level, sign = levels[-1], match[0]
        if sign.lower() in _DIRECTIVES and level.follows == "subject":
            for _ in range(_DIRECTIVES[sign.lower()]):
                next(tokens, None)
        elif sign in "[(":
            levels.append(_Statements(None, None, "predicate" if sign == "[" else "value"))
        elif sign in "])" and len(levels) > 1:
            levels.pop()
            if levels[-1].follows == "subject":
                levels[-1] = _Statements(None, None, "predicate")
        elif sign == ";":
            level.follows = "predicate"
        elif sign == "." and len(levels) == 1:
            levels[0] = _Statements()
        elif (node := _turtle_node(match, namespaces, base, level)) is not None:
            _take(level, node, Span(*match.span()), found)
    return found


_DIRECTIVES = {"@prefix": 3, "@base": 2, "prefix": 2, "base": 1}
"""Directive → the number of tokens after it, including the dot at its end."""
_UNLIKE_NAMES = re.compile(
    r"""("{3}(?:\\.|[^\\])*?"{3}|'{3}(?:\\.|[^\\])*?'{3}|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'|<[^<>\s]*>|\#[^\n\r]*)
    |(?<![\w:\-%.])(?:_:(?P<blank>[\w\-]+)|[-+]?(?:\d+\.\d+|\.\d+|\d+)(?:[eE][-+]?\d+)?)""",
    re.VERBOSE | re.DOTALL,
)


def _simplified(text: str) -> str:
    """Replace numbers by spaces, because their dots end no statement, and blank nodes by IRIs of the same length."""

    def simplify(match: re.Match[str]) -> str:
        if match[1]:
            return match[0]
        return f"<{match['blank']}>" if match["blank"] else " " * len(match[0])

    return _UNLIKE_NAMES.sub(simplify, text)


def _turtle_node(match: re.Match[str], namespaces: Mapping[str, str], base: str, level: _Statements) -> str | None:
    if match["iri"] is not None:
        return urljoin(base, match["iri"])
    if match["prefix"] is not None:
        local = re.sub(r"\\(.)", r"\1", match["local"])
        return namespaces.get(match["prefix"], f"{match['prefix']}:") + local
    return _TYPE if match[0] == "a" and level.follows == "predicate" else None


def _take(level: _Statements, node: str, span: Span, found: dict[tuple[str, ...], Span]) -> None:
    if level.follows == "subject":
        level.subject, level.follows = node, "predicate"
    elif level.follows == "predicate":
        level.predicate, level.follows = node, "value"
        if level.subject is not None:
            found.setdefault((level.subject, node), span)
    elif level.subject is not None and level.predicate is not None:
        found.setdefault((level.subject, level.predicate, node), span)


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
