"""Describe a scenario during a pause, as data for a debugger."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.catalog.geometry import out_of_frame
from robbdd_tools.protocol.pauses import AgentState, BodyState, ClauseState, Hit, PastEvent, Paused, RegionState
from robbdd_tools.world.owners import geom_owners

if TYPE_CHECKING:
    from robbdd_tools.agent.clause_watch import ClauseWatch
    from robbdd_tools.agent.execution import Execution
    from robbdd_tools.monitor.trace import Trace
    from robbdd_tools.protocol.messages import ClauseJudged
    from robbdd_tools.world.simulation import Simulation

Triple = tuple[float, float, float]


def paused_state(
    index: int,
    execution: Execution,
    watch: ClauseWatch,
    verdicts: Mapping[int, ClauseJudged],
    reason: str,
    line: int | None,
    hits: tuple[Hit, ...],
) -> Paused:
    """Return the state of scenario number ``index`` at its last sample.

    ``verdicts`` are the verdicts so far, by feature line. The other arguments are as in ``Paused``.
    """
    trace, simulation = execution.trace, execution.simulation
    states = watch.states()
    clauses = [
        ClauseState(number, judged.verdict, judged.reason, parts)
        if (judged := verdicts.get(number)) is not None
        else ClauseState(number, "", "", parts)
        for number, parts in sorted(states.items())
    ]
    bodies = {body.name: body for body in _bodies(trace)}
    return Paused(
        index,
        simulation.time,
        reason,
        line,
        hits,
        tuple(clauses),
        tuple(bodies.values()),
        tuple(_agents(simulation)),
        tuple(_regions(execution, bodies)),
        _contacts(simulation),
        tuple(PastEvent(stamp.name, stamp.time, stamp.iteration) for stamp in trace.events),
    )


def _bodies(trace: Trace) -> Iterator[BodyState]:
    sample = trace.sample(len(trace.times) - 1)
    for name in trace.names:
        yield BodyState(name, sample.positions[name], sample.orientations[name])


def _agents(simulation: Simulation) -> Iterator[AgentState]:
    state = simulation.recorder.states[-1]
    for name, robot in simulation.robots.items():
        joints = zip(robot.model.joints, state[robot.joints].tolist(), strict=True)
        things = [thing for thing, model in simulation.world.cast.objects.items() if model.free]
        yield AgentState(name, tuple(joints), tuple(thing for thing in things if simulation.holds(name, thing)))


def _regions(execution: Execution, bodies: Mapping[str, BodyState]) -> Iterator[RegionState]:
    for workspace, boxes in execution.regions.items():
        for carrier, region in boxes:
            body = bodies[carrier]
            frame = np.array([body.position]), np.array([body.orientation])
            x, y, z = out_of_frame(region.center, *frame)[0].tolist()
            yield RegionState(workspace, carrier, (x, y, z), region.half)


def _contacts(simulation: Simulation) -> tuple[tuple[str, str], ...]:
    """Return the pairs of elements that touch, in alphabetical order, without parts of one element and the room."""
    data = simulation.data
    owners = geom_owners(simulation.model, simulation.robots)
    elements = {*simulation.world.cast.objects, *simulation.robots}
    pairs: list[list[int]] = data.contact.geom.tolist() if data.ncon else []
    found = {(owners[first], owners[second]) for first, second in pairs}
    ordered = {(min(pair), max(pair)) for pair in found if pair[0] != pair[1] and elements.issuperset(pair)}
    return tuple(sorted(ordered))
