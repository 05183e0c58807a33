"""Step a world and record it: one sample per control tick."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from collections.abc import Set as AbstractSet
from functools import cached_property
from math import isfinite
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.belts import Belts
from robbdd_tools.world.cameras import Cameras
from robbdd_tools.world.contact_forces import ContactForces
from robbdd_tools.world.disturbance import Disturbance
from robbdd_tools.world.engine import SUBSTEPS, TICK, WARNINGS, mujoco
from robbdd_tools.world.engine_faults import strict
from robbdd_tools.world.errors import SceneError, SimulationError
from robbdd_tools.world.finger_motion import finger_motion
from robbdd_tools.world.holding import Grips
from robbdd_tools.world.intactness import contents_of
from robbdd_tools.world.momentary import Velocity, force_between, velocity_of
from robbdd_tools.world.owners import geom_owners, joint_of_part
from robbdd_tools.world.recorder import Bodies, Recorder
from robbdd_tools.world.robot import Robot
from robbdd_tools.world.touch_forces import TouchForces

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.catalog.robot_faults import RobotFault
    from robbdd_tools.monitor.trace import EventStamp, Trace
    from robbdd_tools.world.composition import World

AT_REST = 2e-3
"""Speed (m/s and rad/s) below which an object is at rest."""
REST_TICKS = 6
"""A world has settled when everything has been at rest for this many ticks in a row."""
SETTLE_TICKS = 190
"""After this many ticks (about three seconds), a world counts as settled in any case."""


class Simulation:
    """A world in motion. Time counts from the end of ``settle``; sample 0 is the settled world.

    ``stepping`` is the wall time (s) spent in the engine's steps; ``watchers``, such as a viewer, are called after each
    tick.
    """

    def __init__(self, world: World) -> None:
        """Raises ``SceneError`` if the engine cannot compute the initial state."""
        self.world = world
        self.model: Any = world.model
        self.data: Any = mujoco.MjData(world.model)
        self.cameras = Cameras(self.model, self.data)
        self.stepping = 0.0
        self.ticks = 0
        self.watchers: list[Callable[[], None]] = []
        self.robots = {name: Robot(world, name) for name in world.cast.agents}
        self._free = [name for name, model in world.cast.objects.items() if model.free]
        bodies = [self.model.body(name) for name in self._free]
        addresses = np.array([body.jntadr[0] for body in bodies], dtype=int)
        starts = self.model.jnt_qposadr[addresses].reshape(-1, 1)
        self._speeds = self.model.jnt_dofadr[addresses].reshape(-1, 1) + np.arange(6)
        names = (*world.cast.objects, *world.cast.agents)
        self.belts = Belts(self.model, list(world.cast.objects))
        self._column = {name: index for index, name in enumerate(names)}
        parts = [name for name, model in world.cast.objects.items() if model.joint is not None]
        self._grips = Grips(self.model, self.robots, self._column, [*self._free, *parts])
        # Views of the engine's memory. Its address is constant, so they need not be created in every tick.
        self._qpos: FloatArray = self.data.qpos
        self._qvel: FloatArray = self.data.qvel
        self._ctrl: FloatArray = self.data.ctrl
        self._act: FloatArray = self.data.act
        motors = [robot.motors for robot in self.robots.values()]
        motors += [robot.mobile.motors for robot in self.robots.values() if robot.mobile is not None]
        self._servos = np.concatenate([*motors, np.empty(0, dtype=int)]).astype(int)
        self._tools: list[tuple[FloatArray, FloatArray]] = [
            (self.data.site_xpos[robot.tool], self.data.site_xmat[robot.tool]) for robot in self.robots.values()
        ]
        self._tools += [(body.xpos, body.xmat) for body in (self.data.body(name) for name in parts)]
        limited = {element for element, name in world.cast.judged if name == "force_limit"}
        self.forces = ContactForces(self.model, self.robots, world.cast.objects, limited)
        self.touches: TouchForces | None = None
        self._disturbance: Disturbance | None = None
        self._go_home()
        things = [self.data.body(name) for name in world.cast.objects]
        unset = len(self.robots)
        bodies = Bodies(
            names,
            np.array([*(body.xpos for body in things), *[np.zeros(3)] * unset]),
            np.array([*(body.xquat for body in things), *[np.zeros(4)] * unset]),
            np.array([self._column[name] for name in self._free], dtype=int),
            starts + np.arange(3),
            starts + np.arange(3, 7),
            np.array([self._column[name] for name in (*self.robots, *parts)], dtype=int),
        )
        self.recorder = Recorder(bodies, tuple(self.robots), int(self.model.nq))

    def watch_touches(self, elements: AbstractSet[str]) -> None:
        """Record the contact forces of some elements from the next ``restart`` on."""
        chosen = [name for name in (*self.world.cast.objects, *self.robots) if name in elements]
        self.touches = TouchForces(self.model, chosen, self.world.cast.objects, self.robots) if chosen else None

    def introduce(self, fault: RobotFault) -> None:
        """Give the robots a fault from now on."""
        self._disturbance = Disturbance(
            fault, self.world.seed, self.robots, lambda agent: bool(self._held_by(agent)), self.model
        )

    @property
    def pace(self) -> float:
        """The speed of the robots, as a multiple of their speed without a fault."""
        return 1.0 if self._disturbance is None else self._disturbance.pace

    def seen(self, name: str) -> tuple[FloatArray, FloatArray]:
        """Return the pose of an object as the robots perceive it, in the form of ``pose``."""
        position, rotation = self.pose(name)
        return (position if self._disturbance is None else self._disturbance.seen(position)), rotation

    def seen_place(self, carrier: str) -> tuple[FloatArray, FloatArray]:
        """Return the pose, as the robots perceive it and in the form of ``pose``, of an object that carries a goal."""
        position, rotation = self.pose(carrier)
        return (position if self._disturbance is None else self._disturbance.seen_place(position)), rotation

    @property
    def has_physics(self) -> bool:
        """Whether forces and contacts move things."""
        return True

    @property
    def state(self) -> FloatArray:
        """The positions of all joints and loose objects, shape (q,)."""
        return self._qpos.copy()

    @property
    def contents(self) -> Mapping[str, bytes]:
        """The state and the parameters that only the simulator may change, by the engine's names."""
        return contents_of(self.model, self.data)

    def restore(self, state: FloatArray) -> None:
        """Move everything to the positions of a state, at rest. The recording and the clock do not change."""
        self._qpos[:] = state
        self._qvel[:] = 0.0
        mujoco.mj_forward(self.model, self.data)

    @property
    def time(self) -> float:
        """Simulated time of the last sample, s."""
        return round(self.ticks * TICK, 6)

    @cached_property
    def scratch(self) -> Any:
        """A spare state of the engine, created once because creation is slow; callers set everything that they use."""
        return mujoco.MjData(self.model)

    def settle(self) -> None:
        """Step until nothing moves, then start the clock and take the first sample."""
        quiet = 0
        for _ in range(SETTLE_TICKS):
            self._step()
            speeds = self.data.qvel[self._speeds]
            quiet = quiet + 1 if not speeds.size or np.abs(speeds).max() < AT_REST else 0
            if quiet == REST_TICKS:
                break
        self.restart()

    def restart(self) -> None:
        """Delete the recording and restart the clock; belts run from now on."""
        self.ticks = 0
        self.belts.start(self.data)
        self.recorder.clear()
        self.forces.clear()
        if self.touches is not None:
            self.touches.restart()
        self.record()

    def tick(self) -> None:
        """Advance by one control tick with the current controls and record a sample.

        Raises ``SimulationError`` if the state contains NaN or the engine warns.
        """
        if self._disturbance is not None:
            self._disturbance.end_tick(self.command)
        self._step()
        self.ticks += 1
        self.record()
        for watch in self.watchers:
            watch()

    def record(self) -> None:
        """Record a sample of the current world."""
        # Positions in the engine's data lag by one step until recomputed.
        mujoco.mj_kinematics(self.model, self.data)
        for robot in self.robots.values():
            robot.follow_base(self.data)
        self._sense()
        rows = self.recorder.append(self.time, self._qpos, self._grips.held)
        for row, (position, rotation) in zip(rows, self._tools, strict=True):
            row[:3] = position
            mujoco.mju_mat2Quat(row[3:], rotation)

    def _sense(self) -> None:
        """Find the object that each gripper holds, and take a sample of the contact forces."""
        self._grips.find(self.data)
        self.forces.record(self.data, {agent: self._held_by(agent) for agent in self.robots})
        if self.touches is not None:
            self.touches.record()

    def trace(self, events: tuple[EventStamp, ...], finished: bool, remark: str) -> Trace:
        """Return the recording so far, without copying it."""
        return self.recorder.trace(events, finished, remark)

    def pose(self, name: str) -> tuple[FloatArray, FloatArray]:
        """Return position (3,) m and rotation matrix (3, 3) of an object in the world frame; raises ``KeyError``."""
        body = self.data.body(name)
        return body.xpos.copy(), body.xmat.reshape(3, 3).copy()

    def velocity(self, name: str) -> Velocity:
        """Return the velocity of an object's position (m/s) and of its rotation (rad/s); raises ``KeyError``."""
        return velocity_of(self.model, self.data, name)

    def joint_velocities(self, robot: Robot) -> FloatArray:
        """Return the velocities of an arm's joints, rad/s, shape (n,)."""
        speeds: FloatArray = self._qvel[robot.speeds]
        return speeds.copy()

    def joint_of(self, name: str) -> float:
        """Return the position (m, rad) of the joint of a thing that opens; raises ``KeyError`` if it has none."""
        return float(self._qpos[self.model.joint(joint_of_part(name)).qposadr[0]])

    @cached_property
    def _owners(self) -> list[str]:
        return geom_owners(self.model, self.robots)

    def contact_force(self, first: str, second: str) -> float:
        """Return the sum of the contact forces (N) of two elements in the last step."""
        return force_between(self.model, self.data, self._owners, first, second)

    @property
    def gravity(self) -> FloatArray:
        """The acceleration of gravity, m/s², world frame, shape (3,)."""
        acceleration: FloatArray = self.model.opt.gravity
        return acceleration.copy()

    def tool(self, robot: Robot) -> tuple[FloatArray, FloatArray]:
        """Return position (3,) m and rotation matrix (3, 3) of an arm's tool in the world frame."""
        return self.data.site_xpos[robot.tool].copy(), self.data.site_xmat[robot.tool].reshape(3, 3).copy()

    def holds(self, agent: str, name: str) -> bool:
        """Return whether the agent's gripper holds the object."""
        return bool(self._grips.held[agent][self._column[name]])

    def grips(self, agent: str) -> bool:
        """Return whether the agent's gripper holds anything."""
        return bool(self._grips.held[agent].any())

    def targets(self, robot: Robot) -> FloatArray:
        """Return the joint positions (rad, shape (n,)) to which the arm's servos move."""
        positions: FloatArray = self._act[robot.targets].copy()
        return positions

    def joint_positions(self, robot: Robot) -> FloatArray:
        """Return the arm's joint positions, rad, shape (n,)."""
        positions: FloatArray = self.data.qpos[robot.joints]
        return positions

    def command(self, robot: Robot, joints: FloatArray, opening: float) -> None:
        """Move the targets of the arm's servos to ``joints`` (rad, shape (n,)) within one tick; set the gripper.

        A leaking cup has no vacuum.
        """
        if self._disturbance is not None:
            joints, opening = self._disturbance.command(robot, joints, opening)
        self._ctrl[robot.motors] = (joints - self._act[robot.targets]) / TICK
        leaks = robot.name in self._grips.leaking
        self._ctrl[robot.gripper] = robot.model.gripper_open if leaks else opening

    def drive(self, robot: Robot, pose: FloatArray) -> None:
        """Move the target of a mobile base to a pose (x m, y m, yaw rad) within one tick, world frame."""
        assert robot.mobile is not None, "only mobile bases drive"
        goal = robot.mobile.positions_at(pose)
        self._ctrl[robot.mobile.motors] = (goal - self._act[robot.mobile.targets]) / TICK

    def open_fingers(self, robot: Robot, data: Any, control: float | None = None) -> None:
        """Put a robot's fingers into the open position in ``data``, the initial state or a trial state.

        If ``control`` is given, fingers of the catalog are put where this value of their actuator moves them.
        """
        motion = finger_motion(robot.model)
        for name, position in motion.open_joints:
            data.qpos[self.model.joint(f"{robot.name}/{name}").qposadr[0]] = position
        if motion.open_joints:
            return
        for pad in robot.pads:
            body = self.model.body(int(self.model.geom_bodyid[pad]))
            for joint in range(body.jntadr[0], body.jntadr[0] + body.jntnum[0]):
                data.qpos[self.model.jnt_qposadr[joint]] = robot.model.gripper_open if control is None else control

    def _step(self) -> None:
        began = perf_counter()
        try:
            with strict(self.model, self.data):
                self._substeps()
        except SimulationError as error:
            raise SimulationError(f"{error}, at {self.time:.2f} s", error.element) from error
        self.belts.set_back(self.data)
        self.stepping += perf_counter() - began
        # A target that is not moved stays in place.
        self._ctrl[self._servos] = 0.0
        if not isfinite(self._qvel @ self._qvel):
            raise SimulationError(f"the simulation became unstable at {self.time:.2f} s")

    def _substeps(self) -> None:
        for _ in range(SUBSTEPS):
            mujoco.mj_step(self.model, self.data)
            self.forces.measure(self.data)
            if self.touches is not None:
                self.touches.measure(self.data)
            if WARNINGS:
                # The first warning names the cause; all others follow from it.
                return

    def _held_by(self, agent: str) -> list[str]:
        held = self._grips.held[agent]
        return [name for name in self.world.cast.objects if held[self._column[name]]] if held.any() else []

    def _go_home(self) -> None:
        for robot in self.robots.values():
            home = np.array(robot.model.home)
            self.data.qpos[robot.joints] = home
            robot.coupled.place(self.data.qpos)
            self.open_fingers(robot, self.data)
            self.data.act[robot.targets] = home
            self.command(robot, home, robot.model.gripper_open)
        for name, model in self.world.cast.objects.items():
            if model.joint is not None:
                self.data.qpos[self.model.joint(joint_of_part(name)).qposadr[0]] = model.joint.start
        try:
            with strict(self.model, self.data):
                mujoco.mj_forward(self.model, self.data)
        except SimulationError as error:
            raise SceneError(str(error), origin=self.world.cast.cause(error)) from error
