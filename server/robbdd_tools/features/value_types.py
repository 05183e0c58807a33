"""Determine which kinds of names fit at a cursor in partly typed text.

The cursor may be in a table cell, in a line of values or in a slot of a phrase.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import cache
from typing import TYPE_CHECKING

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.names.elements import Element, elements_of, scene_members, site_of
from robbdd_tools.names.roles import ROLE_KINDS
from robbdd_tools.names.types import variable_type
from robbdd_tools.names.uses import ANYTHING, SECONDS, Kinds, slot_kinds
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot

_REFERENCE = r"<\s*([\w\-.]+)\s*>"
_LINE = re.compile(rf"\bvar\s*{_REFERENCE}\s*:[^:|]*\Z")
_SCENE = re.compile(rf"\bscene\s*:\s*{_REFERENCE}")
_RULE = re.compile(r"\|(?:\s*-+\s*\|)+")
_PIECE = re.compile(r"<(?P<slot>\w+)>|(?P<name>[$#]\w+)|(?P<sign>[^\s\w<$#])|(?P<word>\w+)")
_ELEMENT_KINDS: Mapping[SymbolKind, str] = {
    SymbolKind.OBJECT: "object",
    SymbolKind.OBJECT_SET: "object",
    SymbolKind.WORKSPACE: "workspace",
    SymbolKind.WORKSPACE_SET: "workspace",
    SymbolKind.AGENT: "agent",
    SymbolKind.AGENT_SET: "agent",
}
_LAST_REFERENCE = re.compile(rf"{_REFERENCE}\s*\Z")
_LEADING = re.compile(r"<(?P<slot>\w+)>\s+(?P<words>[^\W\d]\w*(?:\s+[^\W\d]\w*)*)")
_BEFORE_SECONDS = re.compile(r"(?:,|\bwithin)\s*<?\s*\Z")
_SECONDS = re.compile(rf"{_REFERENCE}\s*seconds\b")
_MEMBER_KINDS = (SymbolKind.OBJECT, SymbolKind.WORKSPACE, SymbolKind.AGENT)


def values_wanted(snapshot: Snapshot, uri: str, before: str) -> Kinds:
    """Return the kinds of the variable whose value is being typed at the end of a text."""
    variable = variable_of_value(snapshot, uri, before)
    return ANYTHING if variable is None else variable_type(snapshot, variable, from_values=False).kinds


def variable_of_value(snapshot: Snapshot, uri: str, before: str) -> Definition | None:
    """Return the variable whose value is being typed at the end of a text, if it is one."""
    path = _variable_of_line(before) or _variable_of_cell(before)
    for file, declared in snapshot.scope(uri).find(path) if path else ():
        if declared.symbol.kind in ROLE_KINDS["Variable"]:
            return snapshot.scope(uri).define(file, declared)
    return None


def scene_wanted(snapshot: Snapshot, uri: str, before: str) -> frozenset[Element] | None:
    """Return the members of the scene of the variant at the end of a text, or ``None`` if they are unknown."""
    variant = before[before.rfind("Scenario") :]
    match = _SCENE.search(variant)
    scope = snapshot.scope(uri)
    for file, declared in scope.find(match[1]) if match else ():
        if declared.symbol.kind is SymbolKind.SCENE:
            return scene_members(site_of(snapshot, scope.define(file, declared)))
    return None


def fits(snapshot: Snapshot, definition: Definition, wanted: Kinds, members: frozenset[Element] | None = None) -> bool:
    """Return whether a value, or a set of values, is of one of the wanted kinds.

    If the ``members`` of a scene are given and some of them have the kind of an element, the element must be a member.
    """
    if definition.kind in _MEMBER_KINDS:
        elements = [Element(str(definition.kind), definition.symbol.path, (definition.uri, definition.symbol.path))]
    else:
        elements = list(elements_of(site_of(snapshot, definition)) or ())
    if definition.kind is SymbolKind.CONSTANT_SET and elements and all(one.kind not in wanted for one in elements):
        return False
    if not may_be(definition.kind, wanted):
        return False
    present = {member.kind for member in members or ()}
    keys = {member.key for member in members or ()}
    return all(one.key in keys for one in elements if one.kind in present)


def may_be(kind: SymbolKind, wanted: Kinds) -> bool:
    """Return whether a name of the given kind, or a set of this kind, may be of one of the wanted kinds."""
    return _ELEMENT_KINDS.get(kind) is None or _ELEMENT_KINDS[kind] in wanted


def slot_wanted(before: str) -> Kinds:
    """Return the kinds of the slot at the end of a text. If no phrase has started there, any kind fits."""
    found = next((kinds for pattern, kinds in _beginnings() if pattern.search(before)), ANYTHING)
    return SECONDS if found == ANYTHING and _BEFORE_SECONDS.search(before) else found


def kinds_in_text(text: str) -> dict[str, Kinds]:
    """Return the kinds of variables according to the complete phrases in a text. The text need not be valid."""
    found: dict[str, Kinds] = {}
    for pattern, slots in _phrases():
        for match in pattern.finditer(text):
            for name, kinds in zip(match.groups(), slots, strict=True):
                found[name] = found.get(name, ANYTHING) & kinds
    for match in _SECONDS.finditer(text):
        found[match[1]] = found.get(match[1], ANYTHING) & SECONDS
    return found


def reference_before(before: str) -> str | None:
    """Return the name in the reference at the end of a text."""
    match = _LAST_REFERENCE.search(before)
    return None if match is None else match[1]


@cache
def leading_kinds() -> Mapping[str, Kinds]:
    """Map the words of each phrase, such as ``is located at``, to the kinds that fit before them."""
    found: dict[str, Kinds] = {}
    catalog = load_catalog()
    for word in (*catalog.predicates.values(), *catalog.behaviours.values()):
        for phrase in (word.phrase, *word.aliases):
            match = _LEADING.match(phrase)
            if match is not None:
                words = " ".join(match["words"].split())
                found[words] = found.get(words, frozenset[str]()) | slot_kinds(word.name)[match["slot"]]
    return found


def _variable_of_line(before: str) -> str | None:
    match = _LINE.search(before)
    return None if match is None else match[1]


def _variable_of_cell(before: str) -> str | None:
    """Return the variable of the table column at the end of a text."""
    table = before[before.rfind("variation") :]
    rule = _RULE.search(table)
    if rule is None:
        return None
    header = re.findall(_REFERENCE, table[: rule.start()])
    # A row of n cells has n + 1 bars, even if it is broken into several lines.
    column = table.count("|", rule.end()) % (len(header) + 1) - 1
    return header[column] if column >= 0 else None


@cache
def _beginnings() -> tuple[tuple[re.Pattern[str], Kinds], ...]:
    """Return a pattern for the text of a phrase before each slot, with the kinds of the slot; the longest first."""
    found: list[tuple[str, Kinds]] = []
    for word, pieces in _words():
        for index, (pattern, slot) in enumerate(pieces):
            if slot and index:
                begun = r"\s*".join(part for part, _ in pieces[:index])
                found.append((rf"{begun}\s*{pattern[:1]}?\s*\Z", slot_kinds(word)[slot]))
    return tuple((re.compile(pattern), kinds) for pattern, kinds in sorted(found, key=lambda entry: -len(entry[0])))


@cache
def _phrases() -> tuple[tuple[re.Pattern[str], tuple[Kinds, ...]], ...]:
    found: list[tuple[re.Pattern[str], tuple[Kinds, ...]]] = []
    for word, pieces in _words():
        slots = tuple(slot_kinds(word)[slot] for _, slot in pieces if slot)
        found.append((re.compile(r"\s*".join(pattern for pattern, _ in pieces)), slots))
    return tuple(found)


def _words() -> Iterator[tuple[str, list[tuple[str, str]]]]:
    """Yield each catalog word with the pieces of its phrase. A piece is a pattern and its slot's name or ``""``."""
    catalog = load_catalog()
    for word in (*catalog.predicates.values(), *catalog.behaviours.values()):
        pieces: list[tuple[str, str]] = []
        for match in _PIECE.finditer(word.phrase):
            if match["slot"]:
                pieces.append((_REFERENCE, match["slot"]))
            elif match["name"]:
                pieces.append((r"[\w\-]+", ""))
            else:
                pieces.append((re.escape(match[0]), ""))
        yield word.name, pieces
