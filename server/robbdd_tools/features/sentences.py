"""Describe clauses and phrases in words: the Gherkin sentence of a clause, with its variables in ``<…>``."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.protocol.time_words import occurrence_words
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.predicate_tree import phrase_shape

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robbdd_tools.catalog.api import Behaviour, Predicate


def clause_sentence(clause: tree.Fluent | tree.BehaviourUse) -> str:
    """Return the sentence of a clause or behaviour. It contains variables instead of values."""
    if isinstance(clause, tree.BehaviourUse):
        return _phrase_sentence(clause.action)
    predicate = clause.predicate
    words = _text_sentence(predicate) if isinstance(predicate, tree.TextPredicate) else _phrase_sentence(predicate)
    if clause.conditions:
        words = f"{words} whenever {_joined(clause.conditions)}"
    return f"{words} {time_words(clause.time)}"


def state_sentence(state: tree.State, *, outer: bool = True) -> str:
    """Return the definition of a predicate, or a part of it, as a sentence."""
    match state:
        case tree.PhraseUse() | tree.NamedUse():
            return _phrase_sentence(state)
        case tree.NegatedState(operand=operand):
            return f"not ( {state_sentence(operand)} )"
        case tree.AllStates(operands=operands) | tree.AnyState(operands=operands):
            word = " and " if isinstance(state, tree.AllStates) else " or "
            joined = word.join(state_sentence(operand, outer=False) for operand in operands)
            return joined if outer or len(operands) == 1 else f"( {joined} )"


def event_sentence(event: tree.DefinedEvent) -> str:
    """Return the definition of an event as a sentence."""
    lasting = "" if event.seconds is None else f" for {_seconds(event.seconds)} seconds"
    return f"{event.name.text} occurs when {_joined(event.conditions)}{lasting}"


def event_meaning(event: tree.DefinedEvent) -> str:
    """Describe when a defined event occurs."""
    if event.seconds is None:
        when = "It occurs at each sample at which this becomes true"
    else:
        when = f"It occurs each time that this has been true for {_seconds(event.seconds)} s without interruption"
    return f"{when}. If it is true from the beginning, it first has to become false."


def time_words(time: tree.TimeConstraint) -> str:
    """Return a time constraint in words, as the end of a sentence."""
    if isinstance(time, tree.During):
        return f"{'at some time ' if time.some_time else ''}from {time.start.path} until {time.end.path}"
    word = "before" if isinstance(time, tree.Before) else "after"
    lead = "at some time within " if time.some_time else "for "
    horizon = "" if time.horizon is None else f"{lead}{_seconds(time.horizon)} seconds "
    return f"{horizon}{word} {occurrence_words(time.which)}{time.event.path}"


def time_meaning(time: tree.TimeConstraint) -> str:
    """Describe the samples of a trace at which a clause with this time constraint is judged."""
    if isinstance(time, tree.During):
        must = "at some time" if time.some_time else "throughout"
        return f"Judged from `{time.start.path}` until `{time.end.path}`, both included: it must hold {must}."
    side = "at or before" if isinstance(time, tree.Before) else "at or after"
    which = "last" if isinstance(time, tree.Before) else "first"
    event = f"{occurrence_words(time.which)}`{time.event.path}`"
    if time.horizon is None:
        return f"Judged at the {which} sample {side} {event}."
    ends = "that end at" if isinstance(time, tree.Before) else "that begin at"
    if time.some_time:
        return (
            f"It must hold at some time in the {_seconds(time.horizon)} s {ends} {event}. The margin is "
            "the largest in this time; the result says when it first held and how much time was left."
        )
    return f"Judged throughout the {_seconds(time.horizon)} s {ends} {event}."


def _seconds(horizon: tree.Number | tree.Ref) -> str:
    return f"<{horizon.path}>" if isinstance(horizon, tree.Ref) else str(horizon.value)


def condition_meaning(conditions: Sequence[tree.PhraseUse | tree.NamedUse]) -> str:
    """Describe the samples of a window at which a clause with these conditions is judged."""
    return (
        f"Judged only at the samples at which this holds: {_joined(conditions)}. The margin is that of the "
        "predicate at these samples. If there are none, the clause holds and is marked as vacuous."
    )


def emission_meaning(emission: tree.Emission) -> str:
    """Describe which of its own events a behaviour emits as an event of the model."""
    moment = emission.moment.text
    return f"When the behaviour emits its own event `{moment}`, the event `{emission.event.path}` of the model occurs."


def word_of(use: tree.PhraseUse) -> Predicate | Behaviour:
    """Return the catalog word of a phrase."""
    catalog = load_catalog()
    return catalog.predicates.get(use.word) or catalog.behaviours[use.word]


def word_meaning(word: Predicate | Behaviour) -> str:
    """Describe a catalog word: its phrase, its meaning and the unit of its margin."""
    lines = [f"`{word.phrase}`", word.doc]
    unit = getattr(word, "unit", None)
    if unit is not None:
        judged = f"a margin in {unit}" if unit else "a margin of +1 or −1"
        lines.append(
            f"Judged with {judged}, 0 or positive where it holds." if getattr(word, "evaluate", None) else UNJUDGED
        )
    events = getattr(word, "events", ())
    if events:
        lines.append("Events: " + ", ".join(f"`{event}`" for event in events))
    return "\n\n".join(lines)


UNJUDGED = "This installation cannot judge it: such a clause is unknown."


def _joined(phrases: Sequence[tree.PhraseUse | tree.NamedUse]) -> str:
    return " and ".join(map(_phrase_sentence, phrases))


def _phrase_sentence(use: tree.PhraseUse | tree.NamedUse) -> str:
    if isinstance(use, tree.NamedUse):
        values = iter(use.values)
        return " ".join(word or _written(next(values)) for word in phrase_shape(use))
    values = {name: _written(value) for name, value in use.arguments}
    return re.sub(r'"?\{(\w+)[^}]*\}"?', lambda match: values.get(match[1], match[0]), word_of(use).sentence)


def _written(value: tree.Argument) -> str:
    match value:
        case tree.Ref():
            return f"<{value.path}>"
        case tree.Number() | tree.Text():
            return str(value.value)
        case _:
            return value.text


def _text_sentence(predicate: tree.TextPredicate) -> str:
    values = {argument.name.text: _written(argument.value) for argument in predicate.arguments}
    return re.sub(r"\{(\w+)\}", lambda match: values.get(match[1], match[0]), predicate.template.value)
