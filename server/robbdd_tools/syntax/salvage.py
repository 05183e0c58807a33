"""Find the names in a declaration that could not be parsed."""

from __future__ import annotations

import re
from collections.abc import Iterator

from robbdd_tools.base.document import Span
from robbdd_tools.syntax.declaration import FILE_NAMESPACE, Symbol, SymbolKind
from robbdd_tools.syntax.recover import HOLE

_NAME = r"(?P<name>[^\W\d][\w\-]*)"
_ARGUMENT = r"\(\s*ns\s*=\s*(?P<ns>[^\W\d][\w\-]*)\s*\)\s*"
_TARGET = r"(?P<target>[^\W\d][\w\-]*(?:\.[^\W\d][\w\-]*)*)"
# An argument in which a symbol or a word is missing.
_DAMAGED = r"(?:\(?[^(){}<>\n\"']*\)|\(\s*ns\s*=\s*[^\W\d][\w\-]*)\s*"
_NAMED = rf"\s*(?:{_ARGUMENT}|{_DAMAGED})?{_NAME}"
_HEADERS = (
    (r"(?:similar\s+)?obj\s+set" + _NAMED, SymbolKind.OBJECT_SET),
    (r"(?:similar\s+)?ws\s+set" + _NAMED, SymbolKind.WORKSPACE_SET),
    (r"(?:similar\s+)?agn\s+set" + _NAMED, SymbolKind.AGENT_SET),
    (r"comp\b" + _NAMED, SymbolKind.COMPOSITION),
    (r"scene\s+inst\b" + _NAMED, SymbolKind.SCENE_INSTANCE),
    (r"scene\b" + _NAMED, SymbolKind.SCENE),
    (r"Event\b" + _NAMED, SymbolKind.EVENT),
    (r"Task\b" + _NAMED, SymbolKind.TASK),
    (r"Requirement\b" + _NAMED, SymbolKind.REQUIREMENT),
    (r"Predicate\b" + _NAMED, SymbolKind.PREDICATE),
    (r"Behaviour\s+Tree\b" + _NAMED, SymbolKind.BEHAVIOUR_TREE),
    (r"const\s+set" + _NAMED, SymbolKind.CONSTANT_SET),
    (r"Scenario\s+Template" + _NAMED, SymbolKind.TEMPLATE),
    (r"User\s+Story" + _NAMED, SymbolKind.STORY),
    (r"distrib\b" + _NAMED, SymbolKind.DISTRIBUTION),
    (rf"ktree(?:\s+inst\b)?{_NAMED}\s+of\b(?:\s*<\s*{_TARGET})?", SymbolKind.TREE_INSTANCE),
    (rf"ktree\s+inst\b{_NAMED}\s*<\s*{_TARGET}", SymbolKind.TREE_INSTANCE),
    (rf"ktree\s*(?:{_ARGUMENT}|{_DAMAGED}){_NAME}", SymbolKind.TREE),
    (rf"ktree\s+{_NAME}(?P<ns>)", SymbolKind.TREE_TEMPLATE),
    (r"bhv\s+impl\b" + _NAMED, SymbolKind.IMPLEMENTATION),
    (r"obs\s+provider\b" + _NAMED, SymbolKind.PROVIDER),
    (r"obs\s+policy\b" + _NAMED, SymbolKind.POLICY),
    (r"observation\b" + _NAMED, SymbolKind.OBSERVATION),
    (r"robot\s+log\b" + _NAMED, SymbolKind.ROBOT_LOG),
    (r"Scenario\s+Exec\b" + _NAMED, SymbolKind.EXECUTION),
    (rf"ns\s+{_NAME}(?P<ns>)", SymbolKind.NAMESPACE),
)
"""Patterns of declarations, each with the kind of the declared name. They are compiled at the first broken one."""
_WITHOUT_IRI = {SymbolKind.NAMESPACE, SymbolKind.TREE_TEMPLATE}
_SCENARIO = re.compile(rf"\w+\s+(?:Variant\s+)?{_NAME}\s*{{")
_PART = re.compile(
    r"(?<![\w\-.<])(?:(?P<kind>object|workspace|agent|set\s+var|var|event|node|sequence|selector)\s+(?P<name>[^\W\d][\w\-]*)"
    r"|(?P<fluent>[^\W\d][\w\-]*)\s*:\s*holds\b)"
)
_PARTS = {
    "object": SymbolKind.OBJECT,
    "workspace": SymbolKind.WORKSPACE,
    "agent": SymbolKind.AGENT,
    "var": SymbolKind.VARIABLE,
    "set var": SymbolKind.SET_VARIABLE,
    "event": SymbolKind.EVENT,
    "node": SymbolKind.TREE_NODE,
    "sequence": SymbolKind.TREE_NODE,
    "selector": SymbolKind.TREE_NODE,
}
_KINEMATIC = {SymbolKind.TREE, SymbolKind.TREE_TEMPLATE, SymbolKind.SCENE_INSTANCE}
_KINEMATIC_PART = re.compile(
    r"(?<![\w\-.<])(?P<kind>kgraph|body|frame|pose|fixed|revolute|model|camera|force-torque|imu)"
    rf"\s+(?:{_ARGUMENT}|{_DAMAGED})?{_NAME}"
)
_KINEMATIC_PARTS = {
    "kgraph": SymbolKind.GRAPH,
    "body": SymbolKind.BODY,
    "frame": SymbolKind.FRAME,
    "pose": SymbolKind.POSE,
    "fixed": SymbolKind.JOINT,
    "revolute": SymbolKind.JOINT,
    "model": SymbolKind.MODEL,
    "camera": SymbolKind.SENSOR,
    "force-torque": SymbolKind.SENSOR,
    "imu": SymbolKind.SENSOR,
}


def salvage(text: str) -> tuple[Symbol, ...]:
    """Return the names that a broken declaration evidently declares, so that references to them are not reported."""
    for pattern, kind in _HEADERS:
        match = re.match(pattern, text)
        if match:
            whole = Span(0, len(text.rstrip()))
            namespace = None if kind in _WITHOUT_IRI else match["ns"] or FILE_NAMESPACE
            name, target = match["name"], match.groupdict().get("target")
            own = Symbol(name, name, kind, Span(*match.span("name")), whole, namespace, target)
            parts = _kinematic_parts if kind in _KINEMATIC else _parts
            return (own, *parts(text, match.end(), own))
    return ()


def salvage_scenario(text: str, story: str, namespace: str | None) -> tuple[Symbol, ...]:
    """Return the names that a broken scenario of a story evidently declares."""
    match = _SCENARIO.match(text)
    if match is None:
        return ()
    whole = Span(0, len(text.rstrip()))
    name = match["name"]
    own = Symbol(f"{story}.{name}", name, SymbolKind.VARIANT, Span(*match.span("name")), whole, namespace)
    return (own, *_parts(text, match.end(), own))


def with_lost(declared: tuple[Symbol, ...], salvaged: tuple[Symbol, ...]) -> tuple[Symbol, ...]:
    """Add the names in the blanked parts of a repaired text, so that references to them are not reported."""
    paths = {symbol.path for symbol in declared}
    lost = (symbol for symbol in salvaged if symbol.path not in paths)
    known = (symbol for symbol in declared if HOLE not in symbol.path)
    return tuple(sorted((*known, *lost), key=lambda symbol: symbol.span))


def _parts(text: str, start: int, own: Symbol) -> Iterator[Symbol]:
    for match in _PART.finditer(text, start):
        group = "fluent" if match["fluent"] else "name"
        kind = SymbolKind.FLUENT if match["fluent"] else _PARTS[" ".join(match["kind"].split())]
        name, span = match[group], Span(*match.span(group))
        yield Symbol(f"{own.path}.{name}", name, kind, span, Span(*match.span()), own.namespace)


def _kinematic_parts(text: str, start: int, own: Symbol) -> Iterator[Symbol]:
    """Yield bodies, frames and the like. A part belongs to the last declaration above that can contain such a part."""
    graph = body = frame = own.path
    for found in _KINEMATIC_PART.finditer(text, start):
        name, kind = found["name"], _KINEMATIC_PARTS[found["kind"]]
        match kind:
            case SymbolKind.GRAPH:
                path = graph = f"{own.path}.{name}"
            case SymbolKind.BODY:
                path = body = f"{graph}.{name}"
            case SymbolKind.FRAME:
                path = frame = f"{body}.{name}"
            case SymbolKind.POSE:
                path = f"{frame}.{name}"
            case SymbolKind.JOINT:
                path = f"{graph}.{name}"
            case _:
                path = f"{own.path}.{name}"
        yield Symbol(path, name, kind, Span(*found.span("name")), Span(*found.span()), found["ns"])
