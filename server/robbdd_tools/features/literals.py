"""Literals to propose where the grammar accepts a number, a quantity or a text: settings, units, catalog entries."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

from robbdd_tools.base.quantity_units import UNITS, units_of
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.catalog.settings import SETTINGS, Setting, written
from robbdd_tools.checks.catalog_entry import known_entries
from robbdd_tools.features.expected_words import place_after
from robbdd_tools.names.elements import site_of
from robbdd_tools.names.types import uses_by_variable, variable_key
from robbdd_tools.names.uses import ANYTHING, Clauses, Kinds, clauses_of, dimension_of_phrase
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robbdd_tools.features.expected_words import Place
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.elements import Site
    from robbdd_tools.names.project import Snapshot

_SETTING = re.compile(r"\bhas\s+config\s+([\w\-]+)\s*=\s*\Z")
_CATALOG = re.compile(r"\bcatalog\s*\Z")
_NUMBER = re.compile(r"(?<![\w.])[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?\s*\Z")
LITERAL_FORMS = {
    "number": "A number such as `1`, `-0.5` or `2e-3`.",
    "quantity": f"A number with its unit; the units are {', '.join(UNITS)}.",
    '"text"': "A text in quotes.",
}
"""Descriptions of the forms that are proposed without a value."""


@dataclass(frozen=True, slots=True)
class ValueFacts:
    """Known facts about the value at a cursor.

    - ``kinds``: the kinds of values that fit.
    - ``setting``: the configuration that it sets, if any.
    - ``dimension``: its dimension, such as ``length``; empty if unknown.
    """

    kinds: Kinds = ANYTHING
    setting: Setting | None = None
    dimension: str = ""


@dataclass(frozen=True, slots=True)
class Literal:
    """A literal to propose. ``described`` is the label of its documentation."""

    label: str
    kind: str
    detail: str
    text: str
    described: str


def facts_in_clause(before: str) -> ValueFacts:
    """Return the facts about the value at the end of a clause that is being typed."""
    match = _SETTING.search(before)
    if match is not None and match[1] in SETTINGS:
        return _of_setting(SETTINGS[match[1]])
    for pattern, dimension in _measured():
        if pattern.search(before):
            return ValueFacts(frozenset({"quantity"}), None, dimension)
    return ValueFacts()


def facts_of_variable(snapshot: Snapshot, variable: Definition, kinds: Kinds) -> ValueFacts:
    """Return the facts about the values of a template's variable according to its clauses. Their kinds are known."""
    site = site_of(snapshot, variable)
    for clauses in () if site is None else clauses_of(site.placed.declaration):
        if site is not None and site.span(clauses.node).contains(variable.span.start):
            setting = _set_by(site, clauses, variable)
            if setting is not None:
                return _of_setting(setting)
            uses = uses_by_variable(site, clauses).get(variable_key(variable), ())
            dimension = next(filter(None, (dimension_of_phrase(use.phrase) for use in uses)), "")
            return ValueFacts(kinds, None, dimension)
    return ValueFacts(kinds)


def literal_choices(language: str, place: Place, facts: ValueFacts) -> Iterator[Literal]:
    """Yield the literals that may be written at a place."""
    rules = frozenset[str]() if place.expected is None else place.expected.rules
    setting = facts.setting
    if "TextLiteral" in rules and _CATALOG.search(place.before):
        for name in sorted(known_entries(language)):
            yield Literal(f'"{name}"', "catalog", "", f'"{name}"', name)
    elif "TextLiteral" in rules and setting is not None:
        for word, numbers in setting.words:
            yield Literal(f'"{word}"', "setting", written(numbers), f'"{word}"', setting.name)
    elif "TextLiteral" in rules and "string" in facts.kinds:
        yield Literal('"text"', "snippet", "", '"${1:text}"', '"text"')
    if "NumberLiteral" in rules and "number" in facts.kinds:
        yield _number(setting)
    if "QuantityLiteral" in rules and "quantity" in facts.kinds:
        for unit in units_of(facts.dimension):
            yield Literal(f"1 {unit}", "snippet", facts.dimension, f"${{1:1}} {unit}", "quantity")
        if not facts.dimension:
            yield Literal("quantity", "snippet", "", f"${{1:1}} ${{2|{','.join(UNITS)}|}}", "quantity")


def unit_choices(language: str, before: str, facts: ValueFacts) -> Iterator[Literal]:
    """Yield the units that may be written after a number at the end of a text."""
    match = _NUMBER.search(before)
    if match is None:
        return
    place = place_after(language, before[: match.start()])
    if place.expected is not None and "QuantityLiteral" in place.expected.rules:
        for unit in units_of(facts.dimension) if facts.dimension else UNITS:
            yield Literal(unit, "unit", UNITS[unit][0], unit, unit)


def without_number(before: str) -> str:
    """Return a text without the number at its end."""
    return _NUMBER.sub("", before)


def _of_setting(setting: Setting) -> ValueFacts:
    return ValueFacts(frozenset({"number", "string"}) if setting.words else frozenset({"number"}), setting)


def _set_by(site: Site, clauses: Clauses, variable: Definition) -> Setting | None:
    """Return the configuration that a variable sets in the clauses of its template."""
    for phrase in clauses.phrases:
        slots = dict(phrase.arguments)
        name, value = slots.get("name"), slots.get("value")
        if isinstance(name, tree.Name) and isinstance(value, tree.Ref) and name.text in SETTINGS:
            target = site.target(value)
            if target is not None and variable_key(target) == variable_key(variable):
                return SETTINGS[name.text]
    return None


def _number(setting: Setting | None) -> Literal:
    if setting is None:
        return Literal("number", "snippet", "", "${1:1}", "number")
    value = 1.0 if setting.low <= 1.0 <= setting.high else setting.low
    return Literal("number", "snippet", f"{setting.name}: {setting.wanted}", f"${{1:{value:g}}}", "number")


@cache
def _measured() -> tuple[tuple[re.Pattern[str], str], ...]:
    """Return a pattern of the words before each quantity of a phrase, with the dimension of the quantity."""
    found: list[tuple[re.Pattern[str], str]] = []
    for word in load_catalog().predicates.values():
        for slot in word.slots:
            for phrase in (word.phrase, *word.aliases):
                head, mark, _ = phrase.partition(f"#{slot.name}")
                words = re.findall(r"[\w\-]+", head.rpartition(">")[2])
                if mark and slot.dimension and words:
                    pattern = r"\s+".join(re.escape(one) for one in words)
                    found.append((re.compile(rf"(?<![\w\-.]){pattern}\s*\Z"), slot.dimension))
    return tuple(found)
