"""One execution of a scenario, advanced only as far as somebody wants to know."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import ceil
from time import perf_counter
from typing import TYPE_CHECKING

from robbdd_tools.agent.configuration import read_back
from robbdd_tools.agent.engine import TICK
from robbdd_tools.agent.errors import BehaviourError, SceneError, SimulationError, UserError
from robbdd_tools.agent.frames import at
from robbdd_tools.agent.outline import outline_of
from robbdd_tools.agent.pick_place import PickPlace
from robbdd_tools.agent.quantities import wanting
from robbdd_tools.agent.reach import ReachSampler
from robbdd_tools.agent.simulation import Simulation
from robbdd_tools.agent.user_behaviour import AgentWorld, run_user_behaviour
from robbdd_tools.agent.world import build_world
from robbdd_tools.monitor.time import Window, window
from robbdd_tools.monitor.trace import EventStamp, Trace

if TYPE_CHECKING:
    from robbdd_tools.agent.sentences import Clause
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.catalog.executable import Implementation
    from robbdd_tools.monitor.judge import Regions
    from robbdd_tools.run.protocol import ScenarioSpec

START, END = "scenario-start", "scenario-end"
"""What emits the events that delimit a scenario."""
REST = 1.0
"""Seconds between the end of the last behaviour and the end of the scenario, for things to come to rest."""
TIMEOUT = 60.0
"""Seconds of simulated time after which an execution is stopped."""
LOOK = 16
"""Ticks after which an execution without any news is looked at again."""


@dataclass(frozen=True, slots=True)
class Call:
    """A behaviour (by its catalog name) with the names that fill its slots."""

    behaviour: str
    arguments: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class Timing:
    """Seconds of simulated time: idle before the first behaviour, recorded after the scenario's end, at most."""

    lead: float = 0.5
    tail: float = 0.0
    timeout: float = TIMEOUT


class Execution:
    """A scenario in execution: the world, settled, at time 0, and the behaviours that will be executed in turn.

    ``completed`` counts the behaviours that went through; ``broken`` says what is wrong with the user's code, if
    anything is, so that nothing can be concluded. ``simulation`` is for those who want to look at the world.
    Raises ``SceneError`` when the scene cannot be set up.
    """

    def __init__(self, spec: ScenarioSpec, calls: Sequence[Call], timing: Timing | None = None) -> None:
        began = perf_counter()
        self._calls = tuple(calls)
        self._timing = timing or Timing()
        self._last = ceil(self._timing.timeout / TICK - 1e-9)
        self._names = _names_of(spec.events)
        actor = self._calls[0].arguments.get("agent") if self._calls else None
        how = spec.execution
        self._implementation = None if how is None else how.implementation
        _check_implementation(self._implementation, self._calls)
        world = build_world(spec.scene, spec.seed, actor, None if how is None else how.scene)
        self.simulation = Simulation(world)
        self._reaches = ReachSampler(self.simulation)
        self._controllers: dict[str, PickPlace] = {}
        self._events: list[EventStamp] = []
        self._remark = ""
        self._finished = False
        self._muted = False
        self.completed = 0
        self.broken = ""
        self.regions: Regions = world.cast.regions
        self._settings = read_back(self.simulation, spec.scene)
        self._outlines = {name: outline_of(model) for name, model in world.cast.objects.items()}
        self._settle()
        self._script = self._scenario()
        self.wall = perf_counter() - began

    @property
    def simulated(self) -> float:
        """Simulated time so far, s."""
        return self.simulation.time

    @property
    def stepping(self) -> float:
        """Wall time spent in the engine's step so far, s."""
        return self.simulation.stepping

    @property
    def trace(self) -> Trace:
        """What happened so far."""
        return self.simulation.trace(tuple(self._events), self._finished, self._remark)

    def state_at(self, time: float) -> FloatArray:
        """Return the engine's joint positions at the last sample at or before a time (s)."""
        return self.simulation.recorder.states[self.trace.last_at_or_before(time + TICK / 2)]

    def advance_until(self, satisfied: Callable[[Trace], bool]) -> Trace:
        """Run on until a trace satisfies a condition or the execution is finished; returns the trace.

        It is asked when an event has occurred or a behaviour is over, and now and then in between.
        """
        began = perf_counter()
        trace = self.trace
        while not (self._finished or satisfied(trace)):
            self._go_on()
            trace = self.trace
        self.wall += perf_counter() - began
        return trace

    def measured(self, clause: Clause, trace: Trace) -> Trace:
        """Return a trace with the configuration and the quantities that a clause needs and that cost time."""
        began = perf_counter()
        for fluent, arguments in wanting(clause, "reach"):
            agent, name = arguments["agent"], arguments["object"]
            selected = window(fluent.time, trace)
            known = agent in self.simulation.robots and name in self.simulation.world.cast.objects
            if known and isinstance(selected, Window):
                self._reaches.sample(agent, name, range(selected.first, selected.last + 1))
        self.wall += perf_counter() - began
        return self.complete(trace)

    def complete(self, trace: Trace) -> Trace:
        """Return a trace with all that is known beside its samples."""
        size, forces = len(trace.times), self.simulation.forces
        return replace(
            trace,
            reaches=self._reaches.record(size),
            settings=self._settings,
            forces={} if forces is None else forces.record_of(size),
            outlines=self._outlines,
        )

    def run_behaviour(self, index: int) -> bool:
        """Run on until behaviour number ``index`` is over; returns whether it went through."""
        self.advance_until(lambda _: self.completed > index)
        return self.completed > index

    def _go_on(self) -> None:
        known = (len(self._events), self.completed)
        for _ in range(LOOK):
            self._tick()
            if self._finished or known != (len(self._events), self.completed):
                return

    def _tick(self) -> None:
        try:
            next(self._script)
            self.simulation.tick()
        except StopIteration:
            self._finished = True
            return
        except UserError as error:
            self._finished = True
            self._remark = self.broken = str(error)
            return
        except SimulationError as error:
            self._finished = True
            self._remark = str(error)
            return
        if self.simulation.ticks >= self._last:
            self._finished = True
            self._note(f"the execution was stopped after {self._timing.timeout:g} s of simulated time")

    def _scenario(self) -> Iterator[None]:
        self._emit(START)
        yield from _idle(self._timing.lead)
        for call in self._calls:
            try:
                yield from self._behaviour(call)
            except BehaviourError as error:
                self._note(str(error))
                if not self._is_users():
                    yield from self._controller(call).withdraw()
                break
            self.completed += 1
        yield from _idle(REST)
        self._emit(END)
        yield from _idle(self._timing.tail)

    def _is_users(self) -> bool:
        return self._implementation is not None and self._implementation.kind == "python"

    def _behaviour(self, call: Call) -> Iterator[None]:
        controller = self._controller(call)
        arguments = call.arguments
        if self._implementation is not None and self._is_users():
            world = AgentWorld(self.simulation, arguments["agent"], self._emit)
            return run_user_behaviour(self._implementation, world, call.behaviour, arguments)
        match call.behaviour:
            case "pick":
                return controller.pick(arguments["object"])
            case "place":
                return controller.place(arguments["object"], arguments["workspace"])
            case "pick-place":
                return controller.pick_place(arguments["object"], arguments["workspace"])
            case other:
                raise BehaviourError(f"no agent of this installation can execute the behaviour '{other}'")

    def _controller(self, call: Call) -> PickPlace:
        agent = call.arguments["agent"]
        if agent not in self.simulation.robots:
            raise SceneError(f"the scene has no agent '{agent}'")
        if agent not in self._controllers:
            self._controllers[agent] = PickPlace(self.simulation, agent, self._emit)
        return self._controllers[agent]

    def _settle(self) -> None:
        for call in self._calls:
            self._controller(call)
        try:
            self.simulation.settle()
            if self._calls and self._calls[0].behaviour == "place":
                self._hand_over(self._calls[0])
        except SimulationError as error:
            raise SceneError(f"the scene does not come to rest: {error}") from error

    def _hand_over(self, call: Call) -> None:
        """Let the agent take hold of what it is to place before the scenario starts."""
        self._muted = True
        try:
            for _ in self._controller(call).pick(call.arguments["object"]):
                self.simulation.tick()
        except BehaviourError as error:
            raise SceneError(f"'{call.arguments['object']}' cannot be put into the gripper: {error}") from error
        self._muted = False
        self.simulation.restart()

    def _emit(self, emitter: str) -> None:
        if not self._muted:
            self._events.extend(EventStamp(name, self.simulated) for name in self._names.get(emitter, ()))

    def _note(self, remark: str) -> None:
        self._remark = self._remark or remark


def _check_implementation(implementation: Implementation | None, calls: Iterable[Call]) -> None:
    """Raise ``SceneError`` when the implementation cannot execute the behaviours in simulation."""
    if implementation is None or implementation.kind == "python":
        return
    place = at(implementation.origin)
    if implementation.kind == "ros-action":
        message = f"the ROS action '{implementation.name}' is not available in simulation"
        raise SceneError(f'{place}{message}: name a behaviour of the catalog or "py {{ module: …, attr: … }}"')
    for call in calls:
        if implementation.name not in (call.behaviour, "pick-place"):
            raise SceneError(f"{place}'{implementation.name}' of the catalog does not execute '{call.behaviour}'")


def _names_of(events: Mapping[str, str]) -> dict[str, list[str]]:
    """Turn event → emitter into emitter → events."""
    names: dict[str, list[str]] = {}
    for event, emitter in events.items():
        names.setdefault(emitter, []).append(event)
    return names


def _idle(seconds: float) -> Iterator[None]:
    for _ in range(ceil(seconds / TICK - 1e-9)):
        yield
