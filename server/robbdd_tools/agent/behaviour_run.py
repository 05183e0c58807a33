"""Execute the behaviours of a scenario in the simulated world, in sequence or by a behaviour tree."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from dataclasses import dataclass
from math import ceil
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.agent.on_demand_quantities import OnDemandQuantities
from robbdd_tools.catalog.coordination import emitter
from robbdd_tools.catalog.executors import DEFAULT, TIMED, executes
from robbdd_tools.monitor.trace import EventStamp
from robbdd_tools.monitor.verdict import Cause, Verdict, unknown
from robbdd_tools.world.composition import build_world
from robbdd_tools.world.configured_values import read_back
from robbdd_tools.world.engine import TICK
from robbdd_tools.world.errors import BehaviourError, SceneError, SimulationError, UserError, at
from robbdd_tools.world.extent import outline_of
from robbdd_tools.world.overlaps import refuse_overlaps
from robbdd_tools.world.pick_place import PickPlace
from robbdd_tools.world.scene import contents_of
from robbdd_tools.world.simulation import Simulation
from robbdd_tools.world.timed_pick_place import TimedPickPlace
from robbdd_tools.world.user_behaviour import AgentWorld, run_user_behaviour

if TYPE_CHECKING:
    from robbdd_tools.agent.tree_execution import TreeRun
    from robbdd_tools.catalog.api import Arguments
    from robbdd_tools.catalog.coordination import TreeSpec
    from robbdd_tools.catalog.executable import Implementation
    from robbdd_tools.monitor.fault import Fault
    from robbdd_tools.monitor.judge import Regions
    from robbdd_tools.protocol.specs import ScenarioSpec

START, END = "scenario-start", "scenario-end"
"""Emitters of the events that delimit a scenario."""
REST = 1.0
"""Seconds between the end of the last behaviour and the end of the scenario, in which objects come to rest."""
TIMEOUT = 60.0
"""Seconds of simulated time after which an execution is stopped."""
PLACES = 1
"""Separates the random stream for places from that of the scene, which starts from the same seed."""
LOOK = 16
"""Control ticks after which an execution without events is examined again."""


@dataclass(frozen=True, slots=True)
class Call:
    """A behaviour, by its catalog name, with the names in its slots.

    The place of a behaviour may be a set of workspaces.
    """

    behaviour: str
    arguments: Arguments

    def element(self, slot: str) -> str:
        """Return the single element in a slot. Raises ``SceneError`` if the slot contains a set."""
        found = self.arguments[slot]
        if isinstance(found, str):
            return found
        raise SceneError(f"'{self.behaviour}' needs one {slot}, not a set of them")

    @property
    def places(self) -> tuple[str, ...]:
        """The workspaces where the behaviour may place."""
        found = self.arguments["workspace"]
        return (found,) if isinstance(found, str) else tuple(found)


@dataclass(frozen=True, slots=True)
class Choice:
    """An element that a behaviour chose from a set of places.

    The iteration and the nodes of a behaviour tree are numbered as in event stamps.
    """

    iteration: int
    nodes: tuple[str, ...]
    place: str


@dataclass(frozen=True, slots=True)
class Timing:
    """The times of an execution in simulated s.

    They are the minimum idle time before the first behaviour, the time of recording after the scenario's end, and the
    timeout. ``touching`` are the elements whose contact forces are recorded; a workspace means its objects.
    """

    lead: float = 0.5
    tail: float = 0.0
    timeout: float = TIMEOUT
    touching: frozenset[str] = frozenset()


class BehaviourRun:
    """The execution of behaviours in a simulated world that has settled at time 0. Raises ``SceneError``.

    - ``stamps``: the events emitted so far.
    - ``completed``: the number of behaviours of a sequence that have succeeded.
    - ``tree``: the behaviour tree, if one is executed.
    - ``remark``: the latest problem.
    - ``broken``: an error in the user's code or model that prevents any verdict.
    - ``fault``: describes an error in the user's code.
    - ``cut_short``: the verdict on behaviours that had not ended when the execution was stopped.
    - ``failed``: true when a behaviour has failed.
    - ``wall``: the wall time spent in s.
    - ``observers``: called after each sample, when the events of its time have been emitted, and at the end.
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
        self.tree = None if spec.tree is None else _tree_run(spec.tree, self)
        world = build_world(spec.scene, spec.seed, actor, spec.instance)
        self.simulation = Simulation(world)
        carriers = {carrier for name in self._timing.touching for carrier, _ in world.cast.regions.get(name, ())}
        self.simulation.watch_touches(self._timing.touching | carriers)
        self.quantities = OnDemandQuantities(self.simulation)
        self._controllers: dict[str, PickPlace] = {}
        self.stamps: list[EventStamp] = []
        self.observers: list[Callable[[], None]] = []
        self.remark = ""
        self.finished = False
        self._muted = False
        self._iteration = 0
        self.choices: list[Choice] = []
        self._draw = np.random.default_rng((world.seed, PLACES))
        self.completed = 0
        self.broken = ""
        self.cut_short: Verdict | None = None
        self.failed = False
        self.fault: Fault | None = None
        self.regions: Regions = world.cast.regions
        self.contents = {workspace: contents_of(spec.scene, workspace) for workspace in spec.scene.contains}
        self.correct_places = spec.scene.correct_places
        self.settings = read_back(self.simulation, spec.scene)
        self.outlines = {name: outline_of(model) for name, model in world.cast.objects.items()}
        self._settle()
        self._script = self._scenario()
        self.wall = perf_counter() - began

    def go_on(self) -> None:
        """Simulate until an event occurs, or for a limited number of control ticks."""
        began = perf_counter()
        self._run_on()
        self.wall += perf_counter() - began

    def _run_on(self) -> None:
        known = len(self.stamps), self.completed
        for _ in range(LOOK):
            self._tick()
            if self.finished:
                self._observe()
            if self.finished or known != (len(self.stamps), self.completed):
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
            reason = f"the execution was stopped after {self._timing.timeout:g} s of simulated time"
            self.cut_short = unknown(reason, Cause.TIME_LIMIT)
            self._note(reason)

    def _observe(self) -> None:
        for observe in self.observers:
            observe()

    def _scenario(self) -> Iterator[None]:
        self._emit(START)
        yield from _idle(self._timing.lead)
        yield from self._in_turn() if self.tree is None else self.tree.steps()
        yield from _idle(REST)
        self._emit(END)
        yield from _idle(self._timing.tail)

    def _in_turn(self) -> Iterator[None]:
        for iteration, call in enumerate(self._calls, start=1):
            self._iteration = iteration
            failure = yield from self.attempt(call)
            self._iteration = 0
            if failure:
                return
            self.completed += 1

    def attempt(self, call: Call) -> Generator[None, None, str]:
        """Execute a behaviour, one control tick for each step of the iterator.

        Returns the reason why the behaviour failed; empty if it succeeded.
        """
        try:
            yield from self._behaviour(call)
        except BehaviourError as error:
            self.remark = str(error)
            self.failed = True
            if not self._is_users():
                yield from self._controller(call).withdraw()
            return str(error)
        return ""

    def _is_users(self) -> bool:
        return self._implementation is not None and self._implementation.kind == "python"

    def _behaviour(self, call: Call) -> Iterator[None]:
        controller = self._controller(call)
        if self._implementation is not None and self._is_users():
            world = AgentWorld(self.simulation, call.element("agent"), self._emit)
            return run_user_behaviour(self._implementation, world, call.behaviour, call.arguments)
        match call.behaviour:
            case "pick":
                return controller.pick(call.element("object"))
            case "place":
                return controller.place(call.element("object"), self._in_any_order(call))
            case "pick-place" if self._implementation is not None and self._implementation.name == TIMED:
                return TimedPickPlace(self.simulation, call.element("agent"), self._emit).pick_place(
                    call.element("object"), call.places
                )
            case "pick-place":
                return controller.pick_place(call.element("object"), self._in_any_order(call))
            case other:
                raise BehaviourError(f"no agent of this installation can execute the behaviour '{other}'")

    def _controller(self, call: Call) -> PickPlace:
        agent = call.element("agent")
        if agent not in self.simulation.robots:
            raise SceneError(f"the scene has no agent '{agent}'")
        if agent not in self._controllers:
            self._controllers[agent] = PickPlace(self.simulation, agent, self._emit, self._note_choice)
        return self._controllers[agent]

    def _in_any_order(self, call: Call) -> tuple[str, ...]:
        """Return the places of a behaviour in an order derived from the scenario's seed."""
        places = call.places
        if len(places) < 2:
            return places
        order: list[int] = self._draw.permutation(len(places)).tolist()
        return tuple(places[index] for index in order)

    def _note_choice(self, place: str) -> None:
        nodes = () if self.tree is None else self.tree.active
        self.choices.append(Choice(self._iteration, tuple(nodes), place))

    def _settle(self) -> None:
        for call in self._calls:
            self._controller(call)
            self._refuse_nowhere(call)
        refuse_overlaps(self.simulation)
        try:
            self.simulation.settle()
            if self._calls and self._calls[0].behaviour == "place":
                self._hand_over(self._calls[0])
        except SimulationError as error:
            origin = self.simulation.world.cast.cause(error)
            raise SceneError(f"the scene does not come to rest: {error}", origin=origin) from error

    def _refuse_nowhere(self, call: Call) -> None:
        """Raise ``SceneError`` if no object carries a place of a behaviour.

        In this case, the model is wrong, not the robot.
        """
        places = call.places if "workspace" in call.arguments else ()
        if places and not self._is_users() and not any(place in self.regions for place in places):
            one = f"'{places[0]}'" if len(places) == 1 else f"any of {', '.join(places)}"
            raise SceneError(f"'{call.behaviour}' cannot place at {one}: nothing in the scene carries that workspace")

    def _hand_over(self, call: Call) -> None:
        """Put the object to be placed into the gripper before the scenario starts."""
        self._muted = True
        try:
            for _ in self._controller(call).pick(call.element("object")):
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
        if self.tree is None or not self.tree.active:
            self.stamp(event, self._iteration)
            return
        for node in self.tree.active:
            name = emitter(node, event)
            self.stamp(name, self.tree.executions[name])

    def _note(self, remark: str) -> None:
        self.remark = self.remark or remark


def _tree_run(spec: TreeSpec, course: BehaviourRun) -> TreeRun:
    from robbdd_tools.agent.tree_execution import TreeRun

    return TreeRun(spec, lambda leaf: course.attempt(Call(leaf.behaviour, leaf.arguments)), course.stamp)


def _check_implementation(implementation: Implementation | None, calls: Iterable[Call]) -> None:
    """Raise ``SceneError`` if the implementation cannot execute the behaviours in simulation."""
    if implementation is None or implementation.kind == "python":
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
