"""Execute the behaviours of a scenario in the simulated world, in sequence or by a behaviour tree."""

from __future__ import annotations

from collections.abc import Callable, Collection, Generator, Iterable, Iterator, Sequence
from math import ceil
from time import perf_counter
from typing import TYPE_CHECKING

from robbdd_tools.agent.behaviour_calls import Call, Choice, Timing, groups_of
from robbdd_tools.agent.behaviour_executors import BehaviourExecutors
from robbdd_tools.agent.idle_arms import IdleArms
from robbdd_tools.agent.on_demand_quantities import OnDemandQuantities
from robbdd_tools.catalog.coordination import DEFINED, EXTERNAL, each_emitter, emitter
from robbdd_tools.catalog.executors import DEFAULT, executes
from robbdd_tools.monitor.trace import EventStamp
from robbdd_tools.monitor.verdict import Cause, Verdict, unknown
from robbdd_tools.monitor.without_physics import KINEMATIC, WORLD
from robbdd_tools.world.composition import build_world
from robbdd_tools.world.configured_values import read_back
from robbdd_tools.world.engine import TICK
from robbdd_tools.world.errors import BehaviourError, SceneError, SimulationError, UserError, at
from robbdd_tools.world.extent import outline_of
from robbdd_tools.world.kinematic import KinematicSimulation
from robbdd_tools.world.overlaps import refuse_overlaps
from robbdd_tools.world.scene import contents_of
from robbdd_tools.world.simulation import Simulation

if TYPE_CHECKING:
    from robbdd_tools.agent.tree_execution import TreeRun
    from robbdd_tools.catalog.coordination import TreeSpec
    from robbdd_tools.catalog.executable import Implementation
    from robbdd_tools.monitor.fault import Fault
    from robbdd_tools.monitor.judge import Regions
    from robbdd_tools.protocol.specs import ScenarioSpec

START, END = "scenario-start", "scenario-end"
"""Emitters of the events that delimit a scenario."""
REST = 1.0
"""Objects can come to rest for this time (s) between the end of the last behaviour and the end of the scenario."""
LOOK = 16
"""An execution without events is examined again after this many control ticks."""


class BehaviourRun:
    """The execution of behaviours in a simulated world that has settled at time 0. Raises ``SceneError``.

    - ``stamps``: the events emitted so far.
    - ``succeeded``: the indices of the behaviours in ``calls`` that have succeeded.
    - ``failures``: the reasons of the behaviours that have failed.
    - ``tree``: the behaviour tree, if one is executed.
    - ``remark``: the latest problem.
    - ``broken``: an error in the user's code or model that prevents any verdict.
    - ``fault``: describes an error in the user's code.
    - ``cut_short``: the verdict on behaviours that had not ended when the execution was stopped.
    - ``failed``: true when a behaviour has failed.
    - ``begun``: the indices of the behaviours that have begun.
    - ``wall``: the wall time spent in s.
    - ``has_occurred``: returns whether an event that the template defines has occurred in an iteration.
    - ``observers``: called after each sample and its events, and at the end.
    """

    def __init__(self, spec: ScenarioSpec, calls: Sequence[Call], timing: Timing | None = None) -> None:
        began = perf_counter()
        self._calls = tuple(calls)
        self._timing = timing or Timing()
        self._last = ceil(self._timing.timeout / TICK - 1e-9)
        actor = self._calls[0].element("agent") if self._calls else None
        how = spec.execution
        self._implementation = None if how is None else how.implementation
        _check_implementation(self._implementation, self._calls)
        self._emitters = spec.events
        self._groups = groups_of(self._calls)
        self.tree = None if spec.tree is None else _tree_run(spec.tree, self)
        world = build_world(spec.scene, spec.seed, actor, spec.instance)
        self.simulation = KinematicSimulation(world) if spec.world == KINEMATIC else Simulation(world)
        carriers = {carrier for name in self._timing.touching for carrier, _ in world.cast.regions.get(name, ())}
        self.simulation.watch_touches(self._timing.touching | carriers)
        self.quantities = OnDemandQuantities(self.simulation)
        self.stamps: list[EventStamp] = []
        self.observers: list[Callable[[], None]] = []
        self.has_occurred: Callable[[str, int], bool] = lambda _, __: False
        self.remark = ""
        self.finished = False
        self._muted = False
        self._active: int | None = None
        self.choices: list[Choice] = []
        self.begun: set[int] = set()
        self.succeeded: set[int] = set()
        self.failures: dict[int, str] = {}
        self.broken = ""
        self.cut_short: Verdict | None = None
        self.failed = False
        self.fault: Fault | None = None
        self.regions: Regions = world.cast.regions
        self._executors = BehaviourExecutors(
            self.simulation, self._implementation, self.regions, self._emit, self._note_choice
        )
        self._idle_arms = IdleArms((agent for call in self._calls for agent in call.agents), self._executors.park)
        self.contents = {workspace: contents_of(spec.scene, workspace) for workspace in spec.scene.contains}
        self.correct_places = spec.scene.correct_places
        self.settings = {**read_back(self.simulation, spec.scene), **({WORLD: KINEMATIC} if spec.world else {})}
        self.outlines = {name: outline_of(model) for name, model in world.cast.objects.items()}
        self._settle()
        if spec.fault is not None:
            self._executors.introduce(spec.fault, self._calls)
        self._script = self._scenario()
        self.wall = perf_counter() - began

    def go_on(self) -> None:
        """Simulate until an event occurs, or for a limited number of control ticks."""
        began = perf_counter()
        self._run_on()
        self.wall += perf_counter() - began

    def _run_on(self) -> None:
        known = len(self.stamps), len(self.succeeded)
        for _ in range(LOOK):
            self._tick()
            if self.finished:
                self._observe()
            if self.finished or known != (len(self.stamps), len(self.succeeded)):
                return

    def _tick(self) -> None:
        try:
            next(self._script)
            self._observe()
            self.simulation.tick()
        except StopIteration:
            self.finished = True
            return
        except UserError as error:
            self.finished = True
            self.remark = self.broken = str(error)
            self.fault = error.fault
            return
        except SimulationError as error:
            self.finished = True
            self.remark = str(error)
            self.cut_short = unknown(self.remark, Cause.SIMULATION)
            return
        if self.simulation.ticks >= self._last:
            self.finished = True
            lead, timeout = self._timing.lead, self._timing.timeout
            reason = f"the execution was stopped after {timeout:g} s of simulated time"
            if lead >= timeout:
                reason += f", as a clause is about {lead:g} s before an event: its 'timeout' must be longer than that"
            self.cut_short = unknown(reason, Cause.TIME_LIMIT)
            self._note(reason)

    def _observe(self) -> None:
        for observe in self.observers:
            observe()

    def _scenario(self) -> Iterator[None]:
        self._emit(START)
        yield from _idle(self._timing.lead)
        yield from self._in_turn() if self.tree is None else self.tree.steps()
        for _ in _idle(REST):
            self._idle_arms.move(self.simulation.ticks)
            yield
        self._emit(END)
        yield from _idle(self._timing.tail)

    def _in_turn(self) -> Iterator[None]:
        for group in self._groups:
            due = [self._calls[index] for index in group if not self._awaited(self._calls[index])]
            yield from self._make_way([agent for call in due for agent in call.agents])
            yield from self._together(group)
            if self.failures:
                return

    def _make_way(self, agents: Sequence[str]) -> Iterator[None]:
        """Wait until the idle arms of other agents are out of the way of the agents that act next."""
        self._idle_arms.park_all(agents)
        while self._idle_arms.move(self.simulation.ticks):
            yield

    def _together(self, group: Sequence[int]) -> Iterator[None]:
        """Execute the behaviours of a group at the same time, until all of them have ended."""
        running = {index: self._when_due(index) for index in group}
        while True:
            for index in tuple(running):
                self._active = index
                try:
                    next(running[index])
                except StopIteration as end:
                    del running[index]
                    if end.value:
                        self.failures[index] = end.value
                    else:
                        self.succeeded.add(index)
                    if running:
                        self._idle_arms.park_all()
                finally:
                    self._active = None
            if not running:
                return
            self._idle_arms.move(self.simulation.ticks)
            self._refuse_to_wait(running)
            yield

    def _when_due(self, index: int) -> Generator[None, None, str]:
        """Wait for the events that a behaviour requires, then for arms that make room; then execute the behaviour."""
        call = self._calls[index]
        while self._awaited(call) or (call.awaited and self._idle_arms.are_moving):
            yield
        self.begun.add(index)
        return (yield from self.attempt(call))

    def _awaited(self, call: Call) -> list[str]:
        """Return the events that must still occur before a behaviour begins. Its own events are not awaited."""
        emitters = {event: each_emitter(self._emitters.get(event, EXTERNAL)) for event in call.awaited}
        iteration = self._iteration(call)
        occurred = {stamp.name for stamp in self.stamps if stamp.iteration in (0, iteration)}
        own = emitter(call.part, "")
        left = [
            event
            for event, names in emitters.items()
            if occurred.isdisjoint(names) and not any(name.startswith(own) for name in names)
        ]
        return [event for event in left if emitters[event] != (DEFINED,) or not self.has_occurred(event, iteration)]

    def _refuse_to_wait(self, running: Collection[int]) -> None:
        """Raise ``SimulationError`` if every behaviour that has not ended waits for an event."""
        waiting = [self._awaited(self._calls[index]) for index in running if index not in self.begun]
        if len(waiting) < len(running) or not all(waiting):
            return
        if any(self._emitters.get(event) == DEFINED for events in waiting for event in events):
            # The world may still change by itself: a belt moves, a door closes, an object stays at rest.
            return
        event = waiting[0][0]
        external = self._emitters.get(event, EXTERNAL) == EXTERNAL
        reason = "nothing in the simulation emits it" if external else "no behaviour that could emit it is executed"
        raise SimulationError(f"the next behaviour waits for event {event} at {self.simulation.time:.2f} s: {reason}")

    def _iteration(self, call: Call) -> int:
        return call.iteration or self._calls.index(call) + 1

    def attempt(self, call: Call) -> Generator[None, None, str]:
        """Execute a behaviour, one control tick for each step of the iterator.

        Returns the reason why the behaviour failed; empty if it succeeded.
        """
        self._idle_arms.begin(call.agents)
        error = yield from self._executors.attempt(call)
        if error is None:
            self._idle_arms.end(call.agents)
            return ""
        self.remark = str(error)
        self.failed = True
        if self._active is not None:
            # The time limit may end the execution while the arm withdraws.
            self.failures[self._active] = str(error)
        if not self._executors.is_users:
            for agent in call.agents:
                yield from self._executors.controller(agent).withdraw()
        self._idle_arms.end(call.agents)
        return str(error)

    def attempt_next(self, call: Call) -> Generator[None, None, str]:
        """Execute a behaviour of a behaviour tree after the arms of other, idle agents have made room."""
        yield from self._make_way(call.agents)
        return (yield from self.attempt(call))

    def _note_choice(self, place: str) -> None:
        nodes = () if self.tree is None else self.tree.active
        self.choices.append(Choice(0 if self._active is None else self._active + 1, tuple(nodes), place))

    def _settle(self) -> None:
        for call in self._calls:
            for agent in call.agents:
                self._executors.controller(agent)
            self._executors.refuse_impossible(call)
        refuse_overlaps(self.simulation)
        try:
            self.simulation.settle()
            for index in self._groups[0] if self._groups else ():
                if self._calls[index].behaviour == "place":
                    self._hand_over(self._calls[index])
        except SimulationError as error:
            origin = self.simulation.world.cast.cause(error)
            raise SceneError(f"the scene does not come to rest: {error}", origin=origin) from error

    def _hand_over(self, call: Call) -> None:
        """Put the object to be placed into the gripper before the scenario starts."""
        self._muted = True
        try:
            for _ in self._executors.controller(call.element("agent")).pick(call.element("object")):
                self.simulation.tick()
        except BehaviourError as error:
            raise SceneError(f"'{call.element('object')}' cannot be put into the gripper: {error}") from error
        self._muted = False
        self.simulation.restart()

    def stamp(self, name: str, iteration: int = 0) -> None:
        """Record the event of an emitter at the current time, with the number of its iteration."""
        self.stamps.append(EventStamp(name, self.simulation.time, iteration))

    def _emit(self, event: str) -> None:
        if self._muted:
            return
        if self._active is not None:
            call = self._calls[self._active]
            self.stamp(emitter(call.part, event) if call.part else event, self._iteration(call))
            return
        if self.tree is None or not self.tree.active:
            self.stamp(event)
            return
        for node in self.tree.active:
            name = emitter(node, event)
            self.stamp(name, self.tree.executions[name])

    def _note(self, remark: str) -> None:
        self.remark = self.remark or remark


def _tree_run(spec: TreeSpec, course: BehaviourRun) -> TreeRun:
    from robbdd_tools.agent.tree_execution import TreeRun

    return TreeRun(spec, lambda leaf: course.attempt_next(Call(leaf.behaviour, leaf.arguments)), course.stamp)


def _check_implementation(implementation: Implementation | None, calls: Iterable[Call]) -> None:
    """Raise ``SceneError`` if the implementation cannot execute the behaviours in simulation."""
    if implementation is None or implementation.is_users:
        return
    place = at(implementation.origin)
    if implementation.kind == "ros-action":
        name = implementation.iri.replace("#", "/").rpartition("/")[2]
        raise SceneError(
            f"{place}the ROS action '{implementation.name}' is not available in simulation: name a behaviour of the "
            f'catalog or "py {{ module: …, attr: … }}", or run with --bhv {name}={DEFAULT}'
        )
    for call in calls:
        if not executes(implementation.name, call.behaviour):
            raise SceneError(f"{place}'{implementation.name}' of the catalog does not execute '{call.behaviour}'")


def _idle(seconds: float) -> Iterator[None]:
    for _ in range(ceil(seconds / TICK - 1e-9)):
        yield
