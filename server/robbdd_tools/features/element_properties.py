"""Properties of elements: completion of their names and values, and their descriptions."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from robbdd_tools.base.property_values import ELEMENT, TEXT, PropertyValue
from robbdd_tools.base.quantity_units import UNITS
from robbdd_tools.checks.table_column import FIRST_COLUMN
from robbdd_tools.features.markdown import code, literal
from robbdd_tools.graph.property_facts import Fact, declared_facts, facts

if TYPE_CHECKING:
    from robbdd_tools.checks.property_condition import Known
    from robbdd_tools.features.cursor import Cursor
    from robbdd_tools.names.analysis import PlacedDeclaration
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.elements import Site
    from robbdd_tools.names.project import Snapshot

MAX_VALUES = 12
"""Maximum number of values in a description."""
_NAME = r"[^\W\d][\w\-]*"
_STATED = re.compile(rf"({_NAME})\s*:")
_VALUE = re.compile(rf"({_NAME})\s*(?::(?:[^{{}}:]*,)?|!?=)\s*\Z")
_WORD = re.compile(_NAME)
CONDITION = re.compile(r"\b(?:where|and)(?:\s+not)?\s*\Z")
"""Pattern of the words that end a text directly before a condition. In braces, no property follows these words."""
_WRITTEN = re.compile(
    rf"\"(?:\\.|[^\"\\\n])*\"|[-+]?[\d.][\w.+\-]*(?:\s*(?:{'|'.join(UNITS)})(?![\w\-/]))?|{_NAME}(?!\s*:)"
)
_LISTED = re.compile(rf"({_NAME})\s*:\s*((?:{_WRITTEN.pattern})(?:\s*,\s*(?:{_WRITTEN.pattern}))*)?")
_LABELS = ("name", "count", "for")
"""Words before a colon that are not names of properties."""


COLUMNS = re.compile(rf"\b(obj|ws|agn)\s+set\s*<([\w\-.]+)>\s*with\s+((?:{_NAME}\s*,\s*)*)\Z")
"""The end of a text after which a property is chosen as a column: the kind and the name of the set, and the properties
chosen before."""


def name_choices(snapshot: Snapshot, uri: str, cursor: Cursor) -> Iterator[tuple[str, str]]:
    """Yield the properties that may be stated at a cursor, each with its values in words.

    Properties that the same element already has are left out.
    """
    before = "" if CONDITION.search(cursor.before) else cursor.before
    stated = set(_STATED.findall(before[before.rfind("{") + 1 :]))
    for name, values in sorted(_known_values(snapshot, uri, cursor).items()):
        if name not in stated:
            yield name, _in_words(values)


def column_choices(known: Known, chosen: str) -> Iterator[tuple[str, str]]:
    """Yield the properties of a set's elements that may be a column, each with its values in words.

    ``chosen`` is the text of the columns chosen before, which are left out.
    """
    found: dict[str, dict[str, None]] = {}
    for _, properties in known:
        for name, values in properties.items():
            texts = (written(value) for value in values if value.kind != ELEMENT)
            found.setdefault(name, {}).update(dict.fromkeys(texts))
    for name in sorted(found.keys() - {FIRST_COLUMN, *_WORD.findall(chosen)}):
        yield name, _in_words(list(found[name]))


def value_choices(snapshot: Snapshot, uri: str, cursor: Cursor) -> Iterator[str]:
    """Yield the known values of the property whose value is typed at a cursor, as written."""
    match = _VALUE.search(cursor.before)
    if match is not None:
        yield from _known_values(snapshot, uri, cursor).get(match[1], ())


def _known_values(snapshot: Snapshot, uri: str, cursor: Cursor) -> Mapping[str, Sequence[str]]:
    """Return the values of each property as written.

    For the declaration at the cursor, they are read from its text, because it may be broken.
    """
    found: dict[str, dict[str, None]] = {}
    for match in _LISTED.finditer(
        cursor.placed.declaration.text if cursor.placed is not None and _states(cursor.placed) else ""
    ):
        if match[1] not in _LABELS:
            found.setdefault(match[1], {}).update(dict.fromkeys(_WRITTEN.findall(match[2] or "")))
    for fact in facts(snapshot, uri):
        known = found.setdefault(fact.name, {})
        if fact.value.kind != ELEMENT:
            known[written(fact.value)] = None
    return {name: list(values) for name, values in found.items()}


def _states(placed: PlacedDeclaration) -> bool:
    return placed.declaration.text.lstrip().startswith(("obj", "ws", "agn", "similar"))


def written(value: PropertyValue) -> str:
    """Return a value in the form for a model. A single word needs no quotes."""
    if value.kind != TEXT or (_WORD.fullmatch(value.text) and value.text not in ("true", "false")):
        return value.text
    escaped = value.text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'


def describe_property(snapshot: Snapshot, uri: str, name: str) -> str | None:
    """Describe a property by its values and the number of elements that have it; ``None`` if nothing has it."""
    found = _by_name(facts(snapshot, uri)).get(name)
    if not found:
        return None
    count = len({fact.element for fact in found})
    values = list(dict.fromkeys(written(fact.value) for fact in found if fact.value.kind != ELEMENT))
    elements = f"stated for {count} element{'' if count == 1 else 's'}: {literal(_in_words(values))}"
    terms = " ".join(code(f"<{term}>") for term in dict.fromkeys(fact.term for fact in found))
    return f"**property** {code(name)}\n\n{elements}\n\n{terms}"


def describe_properties(site: Site, definition: Definition) -> Iterator[str]:
    """Yield a list, in Markdown, of the properties that a scene states about an element."""
    lines = [
        f"- {code(fact.name)}: {literal(fact.value.text)}"
        for fact in declared_facts(site.file, site.placed)
        if fact.element == definition.iri
    ]
    if lines:
        yield "\n".join(lines)


def _by_name(found: Iterator[Fact]) -> Mapping[str, Sequence[Fact]]:
    known: dict[str, list[Fact]] = {}
    for fact in found:
        known.setdefault(fact.name, []).append(fact)
    return known


def _in_words(values: Sequence[str]) -> str:
    more = f" and {len(values) - MAX_VALUES} more" if len(values) > MAX_VALUES else ""
    return ", ".join(values[:MAX_VALUES]) + more or "elements"
