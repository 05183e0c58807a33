"""Clauses of one scenario as data. Values replace all variables, and names are CURIEs.

The parent process makes them from the model, and writes the sentences of features from them. The agent reads them from
the manifest. It parses a sentence only if a person wrote it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, cast

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.monitor.joint_condition import joint_arguments, joint_predicate, parts_of
from robbdd_tools.monitor.time import After, Before, During, TimeConstraint
from robbdd_tools.protocol.plain_predicates import plain_predicate, predicate_of

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Behaviour, Predicate


@dataclass(frozen=True, slots=True)
class AnyOf:
    """Any element of a set. It is the value of an existential variable, or of a set that is used as a place."""

    elements: tuple[str, ...]


MEANWHILE = "meanwhile "
"""A behaviour's sentence begins with this if the behaviour is executed at the same time as the previous one."""
Filler = str | tuple[str, ...] | AnyOf
"""Value of a slot: an element or a value, a set, or any element of a set."""


@dataclass(frozen=True, slots=True)
class Condition:
    """The predicate of ``whenever``, with the values of its slots. Several predicates are joined into one."""

    predicate: Predicate
    arguments: Mapping[str, Filler]

    @property
    def parts(self) -> list[Condition]:
        """The predicates of the condition, each with its own slots."""
        return [Condition(predicate, own) for predicate, own in parts_of(self.predicate, self.arguments)]


def joint_condition(conditions: Sequence[Condition]) -> Condition | None:
    """Return several conditions as one; ``None`` if there is none."""
    if not conditions:
        return None
    predicate = joint_predicate([one.predicate for one in conditions])
    return Condition(predicate, joint_arguments([one.arguments for one in conditions]))


@dataclass(frozen=True, slots=True)
class Fluent:
    """The clause ``holds(predicate whenever condition, time)``, with the values of the predicate's slots.

    ``iri`` is the IRI of the clause in the model. ``named`` has the values of its slots and quantified variables by
    name, for users' code that judges it.
    """

    predicate: Predicate
    arguments: Mapping[str, Filler]
    time: TimeConstraint
    iri: str = ""
    named: Mapping[str, Any] = field(default_factory=dict[str, Any])
    condition: Condition | None = None


@dataclass(frozen=True, slots=True)
class DefinedEvent:
    """An event that occurs when all conditions have become true, or have been true for ``seconds``.

    The time constraint of a condition also names the event, and has no other meaning.
    """

    name: str
    conditions: tuple[Fluent, ...]
    seconds: float = 0.0


@dataclass(frozen=True, slots=True)
class Text:
    """The text of a step that no word of the catalog matches. ``time`` is ``None`` if it has no time constraint.

    ``iri``, ``named`` and ``condition`` have the same meaning as in a fluent.
    """

    words: str
    time: TimeConstraint | None = None
    iri: str = ""
    named: Mapping[str, Any] = field(default_factory=dict[str, Any])
    condition: Condition | None = None


@dataclass(frozen=True, slots=True)
class Junction:
    """Clauses that are joined by ``and`` or ``or``, or one clause that is negated."""

    operator: Literal["and", "or", "not"]
    operands: tuple[Clause, ...]


@dataclass(frozen=True, slots=True)
class BehaviourCall:
    """A behaviour with the values of its slots.

    In a When with several behaviours, ``part`` is the IRI of its clause, which distinguishes its events from those of
    the others, and ``start`` and ``end`` are the events of its duration. ``is_meanwhile`` states whether it is executed
    at the same time as the behaviour before it.
    """

    behaviour: Behaviour
    arguments: Mapping[str, Filler]
    part: str = ""
    start: str = ""
    end: str = ""
    is_meanwhile: bool = False


@dataclass(frozen=True, slots=True)
class EventOccurrence:
    """An event that a When clause waits for."""

    event: str


Clause = Fluent | Text | Junction
"""Content of a Given or Then clause."""
Statement = Clause | BehaviourCall | EventOccurrence
"""Content of any clause."""


def leaves_of(clause: Clause) -> Iterator[Fluent | Text]:
    """Yield the fluents and texts of a clause, in the order of its sentence."""
    if isinstance(clause, Junction):
        for operand in clause.operands:
            yield from leaves_of(operand)
    else:
        yield clause


def fluents_of(clause: Clause) -> Iterator[Fluent]:
    """Yield the fluents of a clause, in the order of its sentence."""
    return (leaf for leaf in leaves_of(clause) if isinstance(leaf, Fluent))


def to_plain(statement: Statement) -> dict[str, Any]:
    """Return a statement as its JSON form."""
    match statement:
        case Fluent(predicate, arguments):
            return {
                "predicate": plain_predicate(predicate),
                "arguments": _plain_arguments(arguments),
                **_leaf(statement),
            }
        case Text(words):
            return {"text": words, **_leaf(statement)}
        case Junction(operator, operands):
            return {"operator": operator, "operands": [to_plain(operand) for operand in operands]}
        case BehaviourCall(behaviour, arguments):
            plain: dict[str, Any] = {"behaviour": behaviour.name, "arguments": _plain_arguments(arguments)}
            if statement.part:
                plain |= {"part": statement.part, "from": statement.start, "until": statement.end}
            return {**plain, "meanwhile": True} if statement.is_meanwhile else plain
        case EventOccurrence(event):
            return {"event": event}


def from_plain(data: Mapping[str, Any]) -> Statement:
    """Return the statement whose JSON form is ``data``, as made by ``to_plain``.

    Raises ``KeyError``, ``TypeError`` or ``ValueError``.
    """
    match data:
        case {"behaviour": str(name), "arguments": arguments}:
            part, start, end = (str(data.get(key, "")) for key in ("part", "from", "until"))
            behaviour, meanwhile = load_catalog().behaviours[name], bool(data.get("meanwhile", False))
            return BehaviourCall(behaviour, _arguments(arguments), part, start, end, meanwhile)
        case {"event": str(event)}:
            return EventOccurrence(event)
        case _:
            return _clause(data)


def _clause(data: Mapping[str, Any]) -> Clause:
    match data:
        case {"operator": "and" | "or" | "not" as operator, "operands": operands}:
            return Junction(operator, tuple(map(_clause, operands)))
        case {"predicate": str() | {} as stated, "arguments": arguments, "time": time}:
            found = _time(time)
            if found is None:
                raise ValueError(f"{data!r} has no time constraint")
            predicate, condition = predicate_of(stated), _condition(data)
            return Fluent(
                predicate, _arguments(arguments), found, data.get("iri", ""), data.get("named", {}), condition
            )
        case {"text": str(words)}:
            return Text(words, _time(data.get("time")), data.get("iri", ""), data.get("named", {}), _condition(data))
        case _:
            raise ValueError(f"{data!r} is not a clause")


def _leaf(leaf: Fluent | Text) -> dict[str, Any]:
    found: dict[str, Any] = {} if leaf.time is None else {"time": _plain_time(leaf.time)}
    if leaf.condition is not None:
        parts = [_plain_condition(one) for one in leaf.condition.parts]
        found["whenever"] = parts[0] if len(parts) == 1 else {"all": parts}
    return {**found, "iri": leaf.iri, **({"named": dict(leaf.named)} if leaf.named else {})}


def _condition(data: Mapping[str, Any]) -> Condition | None:
    found = data.get("whenever")
    if found is None:
        return None
    parts = found.get("all", [found])
    each = [Condition(predicate_of(one["predicate"]), _arguments(one["arguments"])) for one in parts]
    return joint_condition(each)


def _plain_condition(condition: Condition) -> dict[str, Any]:
    return {"predicate": plain_predicate(condition.predicate), "arguments": _plain_arguments(condition.arguments)}


def _plain_arguments(arguments: Mapping[str, Filler]) -> dict[str, object]:
    plain = {name: {"any": list(one.elements)} if isinstance(one, AnyOf) else one for name, one in arguments.items()}
    return cast(dict[str, object], plain)


def _arguments(data: Mapping[str, Any]) -> dict[str, Filler]:
    return {name: _filler(value) for name, value in data.items()}


def _filler(value: Any) -> Filler:
    match value:
        case str():
            return value
        case {"any": elements}:
            return AnyOf(tuple(map(str, elements)))
        case _:
            return tuple(map(str, value))


def _plain_time(time: TimeConstraint) -> dict[str, Any]:
    some_time: dict[str, Any] = {"some_time": True} if time.some_time else {}
    if not isinstance(time, During) and time.which:
        some_time["which"] = time.which
    match time:
        case During(start, end):
            return {"from": start, "until": end, **some_time}
        case Before(event, horizon):
            return {"before": event, "horizon": horizon, **some_time}
        case After(event, horizon):
            return {"after": event, "horizon": horizon, **some_time}


def _time(data: Mapping[str, Any] | None) -> TimeConstraint | None:
    if data is None:
        return None
    some_time, which = bool(data.get("some_time", False)), str(data.get("which", ""))
    match data:
        case {"from": str(start), "until": str(end)}:
            return During(start, end, some_time=some_time)
        case {"before": str(event), "horizon": horizon}:
            return Before(event, horizon, some_time=some_time, which=which)
        case {"after": str(event), "horizon": horizon}:
            return After(event, horizon, some_time=some_time, which=which)
        case _:
            raise ValueError(f"{data!r} is not a time constraint")
