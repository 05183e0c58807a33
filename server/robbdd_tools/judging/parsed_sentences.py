"""Parse sentences that a person has written into a feature. All patterns are derived from the catalog."""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.judging.parsed_predicates import (
    DEFINITION,
    GROUP,
    NOT,
    QUOTED,
    Named,
    balanced,
    fillers,
    read_condition,
    read_definition,
    sentence_pattern,
    split,
)
from robbdd_tools.protocol.clauses import (
    MEANWHILE,
    BehaviourCall,
    Clause,
    EventOccurrence,
    Fluent,
    Junction,
    Statement,
    Text,
)
from robbdd_tools.protocol.time_words import FIRST_WORDING, TIME, WORDING, constraint_of

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Behaviour, Predicate

CONDITION = rf'(?: whenever (?P<condition>(?:"{QUOTED}"|[^"])*?))?'
"""The condition after the predicate of a sentence."""
OCCURS = r'event "(?P<event>[^"]*)" occurs'
DEFINED = rf"(?P<definition>{DEFINITION}){CONDITION} {TIME}"
"""A fluent with a definition in place of a named predicate's phrase."""


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
            return BehaviourCall(behaviour, fillers(match, behaviour.slots), is_meanwhile=words != text)
    return None


def read_clause(text: str, wording: int = WORDING, named: Named = ()) -> Clause:
    """Parse the sentence of a Given or Then step; never raises.

    A time constraint that this version of the wording no longer has makes the sentence a text, which nothing judges.
    """
    own = tuple((one, re.compile(fluent_pattern(one))) for one in named)
    for predicate, pattern in (*_fluents(), *own):
        if (match := pattern.fullmatch(text)) is not None and _understood(match, wording):
            condition = read_condition(match["condition"], named)
            if condition is not None or match["condition"] is None:
                return Fluent(predicate, fillers(match, predicate.slots), constraint_of(match), condition=condition)
    if (match := re.fullmatch(DEFINED, text)) is not None and _understood(match, wording):
        defined, condition = read_definition(match["definition"], named), read_condition(match["condition"], named)
        if defined is not None and (condition is not None or match["condition"] is None):
            return Fluent(defined.predicate, defined.arguments, constraint_of(match), condition=condition)
    if (match := re.fullmatch(NOT, text)) is not None and balanced(match["inner"]):
        return Junction("not", (read_clause(match["inner"], wording, named),))
    inner = text
    if (match := re.fullmatch(GROUP, text)) is not None and balanced(match["inner"]):
        inner = match["inner"]
    for operator in ("and", "or"):
        parts = split(inner, f" {operator} ")
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
    condition = read_condition(stated, named) if words else None
    return Text(match["words"] if condition is None else words, constraint_of(match), condition=condition)


@cache
def _fluents() -> tuple[tuple[Predicate, re.Pattern[str]], ...]:
    predicates = load_catalog().predicates.values()
    return tuple((predicate, re.compile(fluent_pattern(predicate))) for predicate in predicates)


@cache
def _behaviours() -> tuple[tuple[Behaviour, re.Pattern[str]], ...]:
    behaviours = load_catalog().behaviours.values()
    return tuple((word, re.compile(sentence_pattern(word.sentence))) for word in behaviours)


def _understood(match: re.Match[str], wording: int) -> bool:
    """Return whether the version of the wording has the time constraint of a sentence."""
    return match["lead"] != "within" or wording == FIRST_WORDING
