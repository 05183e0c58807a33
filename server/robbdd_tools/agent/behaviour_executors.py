"""Execute single behaviours: by controllers of the catalog, or by users' code."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Iterator
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.agent.swapped_elements import with_swapped_element
from robbdd_tools.catalog.executors import TIMED
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.world.drive_base import DriveBase
from robbdd_tools.world.errors import BehaviourError, SceneError
from robbdd_tools.world.external_behaviour import run_external_behaviour
from robbdd_tools.world.open_close import OpenClose, opening_by_handle
from robbdd_tools.world.pick_place import PickPlace
from robbdd_tools.world.push_object import PushObject
from robbdd_tools.world.timed_pick_place import TimedPickPlace
from robbdd_tools.world.transfer import HandOver
from robbdd_tools.world.user_behaviour import AgentWorld, run_user_behaviour

if TYPE_CHECKING:
    from robbdd_tools.agent.behaviour_calls import Call
    from robbdd_tools.catalog.executable import Implementation
    from robbdd_tools.catalog.robot_faults import RobotFault
    from robbdd_tools.monitor.judge import Regions
    from robbdd_tools.world.simulation import Simulation

PLACES = 1
"""Number of the random stream for places: the stream of the scene starts from the same seed."""


class BehaviourExecutors:
    """The executors of a simulation's agents. Each executor keeps its state between behaviours.

    ``emit`` is called with the name of each event, ``note_choice`` with the workspace chosen among several.
    """

    def __init__(
        self,
        simulation: Simulation,
        implementation: Implementation | None,
        regions: Regions,
        emit: Callable[[str], None],
        note_choice: Callable[[str], None],
    ) -> None:
        self._simulation = simulation
        self._implementation = implementation
        self._regions = regions
        self._emit = emit
        self._note_choice = note_choice
        self._controllers: dict[str, PickPlace] = {}
        self._fault: RobotFault | None = None
        self._draw = np.random.default_rng((simulation.world.seed, PLACES))

    @property
    def is_users(self) -> bool:
        """Whether users' code executes the behaviours."""
        return self._implementation is not None and self._implementation.is_users

    def introduce(self, fault: RobotFault, calls: Iterable[Call]) -> None:
        """Give the robots a fault from now on. Raises ``SceneError`` if it cannot occur in some behaviour."""
        for call in calls:
            with_swapped_element(call, fault, self._simulation)
        self._fault = fault
        self._simulation.introduce(fault)

    def attempt(self, call: Call) -> Generator[None, None, BehaviourError | None]:
        """Execute a behaviour, one control tick for each step of the iterator.

        Returns the reason why the behaviour failed; ``None`` if it succeeded.
        """
        try:
            yield from self._behaviour(call)
        except BehaviourError as error:
            return error
        return None

    def controller(self, agent: str) -> PickPlace:
        """Return the controller of an agent. Raises ``SceneError`` if the scene has no such agent."""
        if agent not in self._simulation.robots:
            raise self._simulation.world.cast.without_robot(agent)
        if agent not in self._controllers:
            self._controllers[agent] = PickPlace(self._simulation, agent, self._emit, self._note_choice)
        return self._controllers[agent]

    def park(self, agent: str) -> Iterator[None]:
        """Move the arm of an agent home, unless its gripper holds something or users' code moves it."""
        if not self.is_users and agent in self._controllers and not self._simulation.grips(agent):
            yield from self._controllers[agent].park()

    def refuse_impossible(self, call: Call) -> None:
        """Raise ``SceneError`` if no object carries a place of a behaviour, or a thing to open has no handle.

        In these cases, the model is wrong, not the robot.
        """
        if call.behaviour in ("open", "close") and not self.is_users:
            opening_by_handle(self._simulation.world.cast, call.element("object"))
        if call.behaviour == "push" and not self.is_users and not self._simulation.has_physics:
            raise SceneError("'push' needs physics: nothing is pushed in the kinematic world")
        if (
            call.behaviour == "move-to"
            and not self.is_users
            and self.controller(call.element("agent")).robot.mobile is None
        ):
            raise SceneError(f"'{call.element('agent')}' has no mobile base: only mobile robots move to a workspace")
        if call.behaviour == "hand-over" and len(set(call.agents)) < len(call.agents):
            raise SceneError(f"'{call.element('agent')}' cannot hand over to itself")
        places = call.places if "workspace" in call.arguments else ()
        if places and not self.is_users and not any(place in self._regions for place in places):
            one = f"'{places[0]}'" if len(places) == 1 else f"any of {', '.join(places)}"
            raise SceneError(f"'{call.behaviour}' cannot place at {one}: nothing in the scene carries that workspace")

    def _emit_own(self, behaviour: str, event: str) -> None:
        """Emit an event of a user's behaviour. Raises ``ValueError`` for a name that no behaviour has for an event."""
        known = load_catalog().behaviours
        if not any(event in one.events for one in known.values()):
            raise ValueError(f"'{behaviour}' has no event {event!r:.60}: it emits {', '.join(known[behaviour].events)}")
        self._emit(event)

    def _behaviour(self, call: Call) -> Iterator[None]:
        controller = self.controller(call.element("agent"))
        if self._fault is not None:
            call = with_swapped_element(call, self._fault, self._simulation)
        if self._implementation is not None and self.is_users:
            world = AgentWorld(self._simulation, call.element("agent"), partial(self._emit_own, call.behaviour))
            run = run_user_behaviour if self._implementation.kind == "python" else run_external_behaviour
            steps = run(self._implementation, world, call.behaviour, call.arguments)
            return steps if self._simulation.pace == 1.0 else _at_pace(steps, self._simulation.pace)
        match call.behaviour:
            case "pick":
                return controller.pick(call.element("object"))
            case "place":
                return controller.place(call.element("object"), self._in_any_order(call))
            case "pick-place" if self._implementation is not None and self._implementation.name == TIMED:
                return TimedPickPlace(self._simulation, call.element("agent"), self._emit).pick_place(
                    call.element("object"), call.places
                )
            case "pick-place":
                return controller.pick_place(call.element("object"), self._in_any_order(call))
            case "open":
                return OpenClose(controller, self._emit).open(call.element("object"))
            case "close":
                return OpenClose(controller, self._emit).close(call.element("object"))
            case "push":
                return PushObject(controller, self._emit).push(call.element("object"), call.places)
            case "move-to":
                return DriveBase(controller, self._emit).move_to(self._in_any_order(call))
            case "hand-over":
                receiver = self.controller(call.element("receiver"))
                return HandOver(controller, receiver, self._emit).hand_over(call.element("object"))
            case other:
                raise BehaviourError(f"no agent of this installation can execute the behaviour '{other}'")

    def _in_any_order(self, call: Call) -> tuple[str, ...]:
        """Return the places of a behaviour in an order derived from the scenario's seed."""
        places = call.places
        if len(places) < 2:
            return places
        order: list[int] = self._draw.permutation(len(places)).tolist()
        return tuple(places[index] for index in order)


def _at_pace(steps: Iterator[None], pace: float) -> Iterator[None]:
    """Execute the steps of users' code at ``pace`` steps per tick: 2 is twice in a tick, 0.5 every second tick."""
    due = 0.0
    while True:
        due += pace
        while due >= 1.0:
            due -= 1.0
            try:
                next(steps)
            except StopIteration:
                return
        yield
