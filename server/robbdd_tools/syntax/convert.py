"""textX objects to our frozen trees."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import fields
from typing import Any, cast

from robbdd_tools.base.document import Span
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.phrases import word_of_rule
from robbdd_tools.syntax.textx import RawNode

_ESCAPES = {"n": "\n", "t": "\t", "r": "\r"}
_KINDS = {"obj": "object", "ws": "workspace", "agn": "agent"}


def convert(raw: RawNode, text: str) -> Any:
    """Return the tree node of a textX object parsed from ``text``."""
    rule = type(raw).__name__
    span = _span(raw)
    if rule.endswith("Ref"):
        start = text.index(raw.path, span.start)
        return tree.Ref(Span(start, start + len(raw.path)), rule.removesuffix("Ref"), raw.path)
    word = word_of_rule(rule)
    if word is not None:
        return tree.PhraseUse(span, word, _phrase_arguments(raw, text))
    special = _SPECIAL.get(rule)
    if special is not None:
        return special(raw, span, text)
    return _by_fields(getattr(tree, rule), raw, span, text)


def _by_fields(node: type[tree.Node], raw: RawNode, span: Span, text: str, **given: Any) -> Any:
    values = {
        field.name: _value(getattr(raw, field.name), text)
        for field in fields(node)
        if field.name != "span" and field.name not in given
    }
    return node(span=span, **values, **given)


def _value(value: Any, text: str) -> Any:
    if isinstance(value, list):
        entries = cast(list[Any], value)
        return tuple(_value(entry, text) for entry in entries)
    if value is None or isinstance(value, str | bool):
        return value
    return convert(value, text)


def _span(raw: RawNode) -> Span:
    return Span(raw._tx_position, raw._tx_position_end)


def _phrase_arguments(raw: RawNode, text: str) -> tuple[tuple[str, tree.Ref | tree.Name], ...]:
    """Slots in the order in which they are written."""
    fields_of_raw = cast(dict[str, Any], vars(raw))
    slots: list[tuple[str, tree.Ref | tree.Name]] = [
        (name, convert(value, text)) for name, value in fields_of_raw.items() if name[0] != "_" and name != "parent"
    ]
    return tuple(sorted(slots, key=lambda slot: slot[1].span))


def _text(raw: RawNode, span: Span, _: str) -> tree.Text:
    value = re.sub(r"\\(.)", lambda match: _ESCAPES.get(match[1], match[1]), raw.raw[1:-1], flags=re.DOTALL)
    return tree.Text(span, value)


def _number(raw: RawNode, span: Span, _: str) -> tree.Number:
    digits: str = raw.raw
    whole = digits.lstrip("+-").isdigit()
    return tree.Number(span, int(digits) if whole else float(digits))


def _element_set(kind: str) -> Callable[[RawNode, Span, str], tree.ElementSet]:
    return lambda raw, span, text: _by_fields(tree.ElementSet, raw, span, text, kind=kind)


def _variable(is_set: bool) -> Callable[[RawNode, Span, str], tree.Variable]:
    return lambda raw, span, text: _by_fields(tree.Variable, raw, span, text, is_set=is_set)


def _alias(node: type[tree.Node]) -> Callable[[RawNode, Span, str], Any]:
    return lambda raw, span, text: _by_fields(node, raw, span, text)


_SPECIAL: dict[str, Callable[[RawNode, Span, str], Any]] = {
    "Text": _text,
    "Number": _number,
    "ObjectSet": _element_set("object"),
    "WorkspaceSet": _element_set("workspace"),
    "AgentSet": _element_set("agent"),
    "SimilarSet": lambda raw, span, text: _by_fields(tree.SimilarSet, raw, span, text, kind=_KINDS[raw.kind]),
    "SetVariable": _variable(True),
    "PlainVariable": _variable(False),
    **dict.fromkeys(("Object", "Workspace", "Agent"), _alias(tree.Member)),
    **dict.fromkeys(
        (
            "CompositionMember",
            "ObjectMember",
            "WorkspaceMember",
            "ObjectSetLink",
            "WorkspaceSetLink",
            "AgentSetLink",
            "ConstantSetLink",
        ),
        _alias(tree.Link),
    ),
    "SetsAssignment": lambda raw, span, text: tree.Assignment(
        span, convert(raw.variable, text), convert(raw.sets, text)
    ),
    "ValuesAssignment": lambda raw, span, text: tree.Assignment(
        span, convert(raw.variable, text), convert(raw.values, text)
    ),
    "Table": lambda raw, span, text: tree.Table(span, _value(raw.header.variables, text), _value(raw.rows, text)),
}
