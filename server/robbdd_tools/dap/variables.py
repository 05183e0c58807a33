"""The variables during a pause: clause, world and events. An expression can only be the name of a variable."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, cast

from robbdd_tools.run.report import margin, plain_sentence
from robbdd_tools.workbench.clause_debugging import scenario_values

if TYPE_CHECKING:
    from robbdd_tools.protocol.pauses import BodyState, ClauseState, PartState, Paused
    from robbdd_tools.protocol.specs import ScenarioSpec

EXPRESSION = re.compile(r"<?[\w:-]+(\.[\w:-]+)*>?")
NO_EXPRESSION = "write the name of an element, an event, a clause or a variable, such as cube1.position.z"


class UnknownName(ValueError):
    """An expression is not a name, or nothing in the scenario has this name."""


@dataclass(frozen=True, slots=True)
class Variable:
    """A name with its value as text, and the variables inside it."""

    name: str
    value: str
    inner: tuple[Variable, ...] = ()


def scopes_of(paused: Paused, spec: ScenarioSpec, line: int | None) -> list[Variable]:
    """Return the scopes of a stack frame: of the clause on a feature line or, if there is none, of the scenario."""
    about = _clause_scope(paused, spec, line) if line is not None else _scenario_scope(spec)
    return [about, Variable("World", "", tuple(_world(paused))), Variable("Events", "", tuple(_events(paused, spec)))]


def evaluate(expression: str, paused: Paused, spec: ScenarioSpec) -> Variable:
    """Return the variable that a name or a path of names denotes. Raises ``UnknownName``."""
    words = expression.strip()
    if not EXPRESSION.fullmatch(words):
        raise UnknownName(f"'{words}' is not a name: {NO_EXPRESSION}")
    known = _named(paused, spec)
    path = words.strip("<>").split(".")
    for index, first in enumerate(path):
        # A reference may begin with the set of an element or the template of a variable.
        found = known.get(first) or known.get(_local(first))
        for step in path[index + 1 :] if found is not None else ():
            found = None if found is None else next((one for one in found.inner if one.name == step), None)
        if found is not None:
            return found
    raise UnknownName(f"nothing in {_local(spec.name)} is called '{words}': {NO_EXPRESSION}")


def _named(paused: Paused, spec: ScenarioSpec) -> dict[str, Variable]:
    """Return everything that has a name, by its local name and its CURIE."""
    known: dict[str, Variable] = {}
    for one in (*_events(paused, spec), *_world(paused)):
        known[one.name] = one
    for clause in spec.clauses:
        known.setdefault(clause.name, _clause_scope(paused, spec, clause.line))
    for name in (*(body.name for body in paused.bodies), *(region.workspace for region in paused.regions)):
        known[name] = known[_local(name)]
    for name, value in scenario_values(spec).items():
        known.setdefault(name, _value(name, value, known))
    return known


def _value(name: str, value: object, known: Mapping[str, Variable]) -> Variable:
    if isinstance(value, list | tuple):
        elements = cast(Sequence[object], value)
        inner = tuple(_value(_local(str(one)), one, known) for one in elements)
        return Variable(name, "{" + ", ".join(one.name for one in inner) + "}", inner)
    local = _local(str(value))
    found = known.get(local)
    return Variable(name, local) if found is None else Variable(name, f"{local}: {found.value}", found.inner)


def _scenario_scope(spec: ScenarioSpec) -> Variable:
    values = tuple(_value(name, value, {}) for name, value in scenario_values(spec).items())
    return Variable("Scenario", "", (*values, Variable("seed", str(spec.seed))))


def _clause_scope(paused: Paused, spec: ScenarioSpec, line: int | None) -> Variable:
    clause = next(one for one in spec.clauses if one.line == line)
    state = next((one for one in paused.clauses if one.line == line), None)
    parts = () if state is None else state.parts
    verdict = _verdict(state)
    inner: tuple[Variable, ...] = (Variable("clause", plain_sentence(clause.sentence)), Variable("verdict", verdict))
    if len(parts) == 1:
        inner = (*inner, *_part(parts[0]))
        return Variable("Clause", _summary(parts[0], verdict), inner)
    names = (f"part {number}" for number in range(1, len(parts) + 1))
    each = (
        Variable(name, _summary(part, "not open yet"), tuple(_part(part)))
        for name, part in zip(names, parts, strict=True)
    )
    return Variable("Clause", verdict, (*inner, *each))


def _verdict(state: ClauseState | None) -> str:
    if state is None or not state.verdict:
        return "not judged yet"
    return f"{state.verdict}: {state.reason}" if state.reason else state.verdict


def _summary(part: PartState, otherwise: str) -> str:
    return _margin(part.margin, part.unit) if part.margin is not None else part.note or otherwise


def _part(part: PartState) -> Iterator[Variable]:
    yield Variable("margin now" if part.closed is None else "margin at the end", _summary(part, "not open yet"))
    if part.decisive is not None and part.decisive_at is not None:
        which = "largest" if part.some_time else "smallest"
        value = f"{_margin(part.decisive, part.unit)} at {part.decisive_at:.3f} s"
        yield Variable(f"{which} margin so far", value)
    yield Variable("window", _window(part))


def _window(part: PartState) -> str:
    if part.opened is None:
        return "not open yet"
    if part.closed is None:
        return f"open since {part.opened:.3f} s"
    return f"{part.opened:.3f} s to {part.closed:.3f} s"


def _margin(value: float | None, unit: str) -> str:
    if value is None:
        return "none"
    return margin(value, unit) or ("holds" if value >= 0 else "does not hold")


def _world(paused: Paused) -> Iterator[Variable]:
    agents = {agent.name: agent for agent in paused.agents}
    for body in paused.bodies:
        pose = _pose(body)
        agent = agents.get(body.name)
        if agent is not None:
            joints = tuple(Variable(name, f"{value:.4f}") for name, value in agent.joints)
            gripped = ", ".join(map(_local, agent.gripped)) or "nothing"
            listed = "(" + ", ".join(one.value for one in joints) + ")"
            more = (Variable("joints", listed, joints), Variable("grips", gripped))
            pose = replace(pose, value=f"tool at {pose.value}", inner=(*pose.inner, *more))
        touched = [_local(two) for pair in paused.contacts for one, two in (pair, pair[::-1]) if one == body.name]
        contacts = Variable("touches", ", ".join(sorted(touched)) or "nothing")
        yield replace(pose, inner=(*pose.inner, contacts))
    for region in paused.regions:
        center, half = _point("center", region.center), _point("half size", region.half)
        carrier = Variable("carried by", _local(region.carrier))
        yield Variable(_local(region.workspace), f"around {center.value}", (center, half, carrier))


def _pose(body: BodyState) -> Variable:
    position = _point("position", body.position)
    w, x, y, z = body.orientation
    parts = tuple(Variable(name, f"{value:.4f}") for name, value in zip("wxyz", (w, x, y, z), strict=True))
    turn = Variable("orientation", f"({w:.4f}, {x:.4f}, {y:.4f}, {z:.4f})", parts)
    return Variable(_local(body.name), position.value, (position, turn))


def _point(name: str, values: tuple[float, float, float]) -> Variable:
    inner = tuple(Variable(axis, f"{value:.4f} m") for axis, value in zip("xyz", values, strict=True))
    return Variable(name, "({:.4f}, {:.4f}, {:.4f}) m".format(*values), inner)


def _events(paused: Paused, spec: ScenarioSpec) -> Iterator[Variable]:
    for name in spec.events:
        times = [event.time for event in paused.events if event.name == name]
        value = ", ".join(f"{time:.3f} s" for time in times) or "has not occurred"
        yield Variable(_local(name), value)


def _local(name: str) -> str:
    return name.rpartition(":")[2]
