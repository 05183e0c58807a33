"""Parse sentences that a person has written into a feature. All patterns are derived from the catalog."""

from __future__ import annotations

import ast
import re
from collections.abc import Sequence
from functools import cache
from typing import TYPE_CHECKING

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.protocol.clauses import (
    MEANWHILE,
    AnyOf,
    BehaviourCall,
    Clause,
    Condition,
    EventOccurrence,
    Filler,
    Fluent,
    Junction,
    Statement,
    Text,
    joint_condition,
)
from robbdd_tools.protocol.time_words import FIRST_WORDING, TIME, WORDING, constraint_of

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Behaviour, Predicate, Slot

QUOTED = r'(?:[^"\\]|\\.)*'
"""Contents of double quotes; a backslash escapes the next character."""
NOT, GROUP = r"not \( (?P<inner>.*) \)", r"\( (?P<inner>.*) \)"
"""A negation, and an alternative or enumeration."""
CONDITION = rf'(?: whenever (?P<condition>(?:"{QUOTED}"|[^"])*?))?'
"""The condition after the predicate of a sentence."""
OCCURS = r'event "(?P<event>[^"]*)" occurs'
ANY = "any of "
Named = Sequence["Predicate"]
_ESCAPE = re.compile(r"\\(?:u([0-9a-f]{4})|(.))")
_NAMED = {"n": "\n", "r": "\r", "t": "\t"}
_OPAQUE = re.compile(rf'"{QUOTED}"|\\.')


def sentence_pattern(sentence: str) -> str:
    """Return the regular expression of a catalog sentence, with one named group for each slot."""
    parts = re.split(r"\{(\w+)\}", sentence)
    pieces = [re.escape(text) for text in parts[::2]]
    groups = [f"(?P<{name}>{QUOTED})" for name in parts[1::2]]
    return pieces[0] + "".join(group + piece for group, piece in zip(groups, pieces[1:], strict=True))


def fluent_pattern(predicate: Predicate) -> str:
    """Return the regular expression of a step that states a fluent with this predicate."""
    return rf"{sentence_pattern(predicate.sentence)}{CONDITION} {TIME}"


def read_step(role: str, text: str, wording: int = WORDING, named: Named = ()) -> Statement | None:
    """Return the statement of a step's sentence in a feature with this version of the wording.

    ``named`` are the predicates that the model defines. Returns ``None`` for a When step that contains neither a
    behaviour of the catalog nor an event.
    """
    if role != "when":
        return read_clause(text, wording, named)
    if (match := re.fullmatch(OCCURS, text)) is not None:
        return EventOccurrence(match["event"])
    words = text.removeprefix(MEANWHILE)
    for behaviour, pattern in _behaviours():
        if (match := pattern.fullmatch(words)) is not None:
            return BehaviourCall(behaviour, _fillers(match, behaviour.slots), is_meanwhile=words != text)
    return None


def read_clause(text: str, wording: int = WORDING, named: Named = ()) -> Clause:
    """Parse the sentence of a Given or Then step; never raises.

    A time constraint that this version of the wording no longer has makes the sentence a text, which nothing judges.
    """
    own = tuple((one, re.compile(fluent_pattern(one))) for one in named)
    for predicate, pattern in (*_fluents(), *own):
        if (match := pattern.fullmatch(text)) is not None and _understood(match, wording):
            condition = _condition(match["condition"], named)
            if condition is not None or match["condition"] is None:
                fillers = _fillers(match, predicate.slots)
                return Fluent(predicate, fillers, constraint_of(match), condition=condition)
    if (match := re.fullmatch(NOT, text)) is not None and _balanced(match["inner"]):
        return Junction("not", (read_clause(match["inner"], wording, named),))
    inner = text
    if (match := re.fullmatch(GROUP, text)) is not None and _balanced(match["inner"]):
        inner = match["inner"]
    for operator in ("and", "or"):
        parts = _split(inner, f" {operator} ")
        operands = tuple(read_clause(part, wording, named) for part in parts) if len(parts) > 1 else ()
        # Without parentheses, "and" and "or" may be words of free text.
        if operands and (inner != text or not any(isinstance(operand, Text) for operand in operands)):
            return Junction(operator, operands)
    if inner != text:
        return read_clause(inner, wording, named)
    match = re.fullmatch(rf"(?P<words>.*?) {TIME}", text)
    if match is None or not _understood(match, wording):
        return Text(text)
    words, _, stated = match["words"].rpartition(" whenever ")
    condition = _condition(stated, named) if words else None
    return Text(match["words"] if condition is None else words, constraint_of(match), condition=condition)


def unescaped(text: str) -> str:
    """Return the string that the user wrote, from its escaped form in a step."""
    return _ESCAPE.sub(lambda match: chr(int(match[1], 16)) if match[1] else _NAMED.get(match[2], match[2]), text)


@cache
def _fluents() -> tuple[tuple[Predicate, re.Pattern[str]], ...]:
    predicates = load_catalog().predicates.values()
    return tuple((predicate, re.compile(fluent_pattern(predicate))) for predicate in predicates)


@cache
def _conditions() -> tuple[tuple[Predicate, re.Pattern[str]], ...]:
    predicates = load_catalog().predicates.values()
    return tuple((predicate, re.compile(sentence_pattern(predicate.sentence))) for predicate in predicates)


def _condition(text: str | None, named: Named) -> Condition | None:
    """Return the conditions in a part of a sentence; ``None`` if a predicate is not in the catalog."""
    found = [] if text is None else [_one_condition(part, named) for part in _split(text, " and ")]
    known = [one for one in found if one is not None]
    return joint_condition(known) if len(known) == len(found) else None


def _one_condition(text: str, named: Named) -> Condition | None:
    own = tuple((one, re.compile(sentence_pattern(one.sentence))) for one in named)
    for predicate, pattern in (*_conditions(), *own):
        if (match := pattern.fullmatch(text)) is not None:
            return Condition(predicate, _fillers(match, predicate.slots))
    return None


@cache
def _behaviours() -> tuple[tuple[Behaviour, re.Pattern[str]], ...]:
    behaviours = load_catalog().behaviours.values()
    return tuple((word, re.compile(sentence_pattern(word.sentence))) for word in behaviours)


def _fillers(match: re.Match[str], slots: tuple[Slot, ...]) -> dict[str, Filler]:
    return {slot.name: _filler(match[slot.name]) for slot in slots}


def _filler(text: str) -> Filler:
    some = text.startswith(f"{ANY}[")
    listed = unescaped(text.removeprefix(ANY) if some else text)
    if text.startswith("\\") or not (listed.startswith("[") and listed.endswith("]")):
        return unescaped(text)
    try:
        value: list[object] = ast.literal_eval(listed)
    except (ValueError, SyntaxError):
        return unescaped(text)
    elements = tuple(str(element) for element in value)
    return AnyOf(elements) if some else elements


def _understood(match: re.Match[str], wording: int) -> bool:
    """Return whether the version of the wording has the time constraint of a sentence."""
    return match["lead"] != "within" or wording == FIRST_WORDING


def _balanced(text: str) -> bool:
    """Return whether the parentheses outside of quotes are balanced."""
    depth = 0
    for char in _outside_quotes(text):
        depth += (char == "(") - (char == ")")
        if depth < 0:
            return False
    return depth == 0


def _split(text: str, separator: str) -> list[str]:
    """Split at separators outside quotes and parentheses."""
    bare = _outside_quotes(text)
    parts: list[str] = []
    depth, start = 0, 0
    for index, char in enumerate(bare):
        depth += (char == "(") - (char == ")")
        if depth == 0 and bare.startswith(separator, index):
            parts.append(text[start:index])
            start = index + len(separator)
    return [*parts, text[start:]]


def _outside_quotes(text: str) -> str:
    """Return a text of the same length in which ``_`` replaces quoted text and escaped characters."""
    return _OPAQUE.sub(lambda match: "_" * len(match[0]), text)
