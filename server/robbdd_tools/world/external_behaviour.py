"""Execute a behaviour with an external system under test. ``docs/external-systems.md`` has the protocol."""

from __future__ import annotations

import atexit
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from robbdd_tools.catalog.own_behaviour import BehaviourFailed
from robbdd_tools.monitor.fault import Fault
from robbdd_tools.user_code.modules import folder_of
from robbdd_tools.user_code.system_links import SystemFailed, SystemLink, open_link
from robbdd_tools.world.engine import TICK
from robbdd_tools.world.errors import BehaviourError, UserError, at

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Arguments, FloatArray
    from robbdd_tools.catalog.executable import Implementation
    from robbdd_tools.world.user_behaviour import AgentWorld

VERSION = 1
"""Version of the protocol."""
ANSWERS = 5.0
"""A system must answer within this time (s), unless the model gives another limit."""
STARTS = 30.0
"""A system must answer the first message after its start within this time (s): it may load a policy."""
MOST_EVENTS = 100
"""Maximum number of events in one answer."""

_links: dict[tuple[str, str, str, str], SystemLink] = {}
"""The links of this process by kind, name, model and agent. They are kept between executions."""


def run_external_behaviour(
    implementation: Implementation, world: AgentWorld, behaviour: str, arguments: Arguments
) -> Iterator[None]:
    """Yield once per control tick until the behaviour is over.

    Raises ``BehaviourError`` if the system reports failure, and ``UserError`` if it dies, does not answer in time or
    violates the protocol. After such an error, its next behaviour begins with another process or connection.
    """
    model = "" if implementation.origin is None else implementation.origin.file
    key = (implementation.kind, implementation.name, model, str(arguments["agent"]))
    try:
        link = _begin(implementation, key, world, behaviour, arguments)
        while not _obey(world, _answer(link, _observation(world), _limit(implementation))):
            yield
    except BehaviourFailed as error:
        raise BehaviourError(f"{error} at {world.time:.2f} s") from error
    except SystemFailed as error:
        _drop(key)
        fault = Fault("", f"{implementation.words} {error}", implementation.name, origin=implementation.iri)
        place = at(implementation.origin)
        raise UserError(f"{place}the {implementation.words} {error} at {world.time:.2f} s", fault) from error


def _begin(
    implementation: Implementation,
    key: tuple[str, str, str, str],
    world: AgentWorld,
    behaviour: str,
    arguments: Arguments,
) -> SystemLink:
    """Reset the system, or start it if it does not run. A link that has died since its last use is renewed."""
    message = {
        "type": "reset",
        "version": VERSION,
        "seed": world.seed,
        "time": world.time,
        "tick": TICK,
        "behaviour": behaviour,
        "arguments": {name: list(value) if isinstance(value, tuple) else value for name, value in arguments.items()},
    }
    known = _links.get(key)
    if known is not None:
        try:
            return _ready(known, message, _limit(implementation))
        except SystemFailed:
            _drop(key)
    link = _links[key] = open_link(implementation.kind, implementation.name, folder_of(key[2]), STARTS)
    return _ready(link, message, max(STARTS, _limit(implementation)))


def _ready(link: SystemLink, message: dict[str, Any], seconds: float) -> SystemLink:
    answer = _answer(link, message, seconds)
    _refuse_failure(answer)
    if answer.get("type") != "ready" or answer.get("version") != VERSION:
        raise SystemFailed(f"answered {answer!r:.80} to 'reset', not {{'type': 'ready', 'version': {VERSION}}}")
    return link


def _answer(link: SystemLink, message: dict[str, Any], seconds: float) -> dict[str, Any]:
    link.send(message)
    return link.receive(seconds)


def _observation(world: AgentWorld) -> dict[str, Any]:
    position, rotation = world.tool
    return {
        "type": "observation",
        "time": world.time,
        "joints": world.joints.tolist(),
        "tool": _pose(position, rotation),
        "objects": {name: _pose(*world.pose(name)) for name in world.objects},
        "places": {name: world.place(name).tolist() for name in world.places},
        "holds": [name for name in world.objects if world.holds(name)],
    }


def _pose(position: FloatArray, rotation: FloatArray) -> dict[str, Any]:
    return {"position": position.tolist(), "rotation": rotation.tolist()}


def _obey(world: AgentWorld, answer: Mapping[str, Any]) -> bool:
    """Execute an answer; return whether the behaviour is over. Raises ``SystemFailed`` and ``BehaviourFailed``."""
    _refuse_failure(answer)
    if answer.get("type") != "command":
        raise SystemFailed(f"answered {answer!r:.80} to an observation, not {{'type': 'command', …}}")
    stated: Any = answer.get("events", [])
    events = cast("list[Any]", stated) if isinstance(stated, list) else [None]
    if len(events) > MOST_EVENTS or not all(isinstance(one, str) for one in events):
        raise SystemFailed(f"sent 'events' that are no list of at most {MOST_EVENTS} names: {stated!r:.80}")
    for event in events:
        try:
            world.emit(str(event))
        except ValueError as error:
            raise SystemFailed(f"sent a wrong event: {error}") from error
    if "joints" in answer or "tool" in answer:
        opening = _numbers(answer, "opening", (), 1.0)
        if "joints" in answer:
            joints = _numbers(answer, "joints", world.joints.shape)
        else:
            if not isinstance(answer["tool"], dict):
                raise SystemFailed(f"sent 'tool' that is no map: {answer['tool']!r:.80}")
            tool = cast("dict[str, Any]", answer["tool"])
            joints = world.solve(_numbers(tool, "position", (3,)), float(_numbers(tool, "closing", (), 0.0)))
        world.command(joints, float(opening))
    done = answer.get("done", False)
    if not isinstance(done, bool):
        raise SystemFailed(f"sent 'done' that is neither true nor false: {done!r:.80}")
    return done


def _refuse_failure(answer: Mapping[str, Any]) -> None:
    if answer.get("type") == "failed":
        raise BehaviourFailed(str(answer.get("reason", "the system gives no reason"))[:500])


def _numbers(answer: Mapping[str, Any], name: str, shape: tuple[int, ...], default: float | None = None) -> FloatArray:
    """Return finite numbers of an answer as an array of a shape."""
    stated: Any = answer.get(name, default)
    try:
        found = np.asarray(stated, dtype=float)
    except (TypeError, ValueError):
        found = np.array(np.nan)
    if found.shape != shape or not np.all(np.isfinite(found)):
        wanted = "a finite number" if shape == () else f"a list of {shape[0]} finite numbers"
        raise SystemFailed(f"sent '{name}' that is not {wanted}: {stated!r:.80}")
    return found


def _limit(implementation: Implementation) -> float:
    return ANSWERS if implementation.limit is None else implementation.limit


def _drop(key: tuple[str, str, str, str]) -> None:
    link = _links.pop(key, None)
    if link is not None:
        link.close()


@atexit.register
def close_links() -> None:
    """End all processes and connections of this process."""
    for key in list(_links):
        _drop(key)
