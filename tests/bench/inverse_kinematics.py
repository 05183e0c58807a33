"""``python -m tests.bench.inverse_kinematics``: compare our inverse kinematics with that of mink.

Needs ``pip install mink daqp``, which the product does not. Both move the tool from one point of a path to the next,
0.03 m away, from the same joint positions to the same accuracy. The figures are for ``docs/simulation.md``.
"""

from __future__ import annotations

from importlib import import_module
from math import inf
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.world.arm_kinematics import CLOSE, ROUNDS, Arm, Unreachable, arm_of
from robbdd_tools.world.motion import ToolPose, frame_of
from robbdd_tools.world.robot_specs import load_robot

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray, RobotModel

POINTS = 300
PULL = 1e-3
"""Cost of leaving the home posture, relative to 1 for the tool's pose."""


class Mink:
    """mink on the same arm: pose and posture as tasks, joint limits in the quadratic program."""

    def __init__(self, robot: RobotModel) -> None:
        self._mink: Any = import_module("mink")
        model: Any = load_robot(robot).compile()
        self._configuration: Any = self._mink.Configuration(model)
        self._places = [int(model.joint(name).qposadr[0]) for name in robot.joints]
        self._pose: Any = self._mink.FrameTask(robot.tool_site, "site", position_cost=1.0, orientation_cost=1.0)
        self._posture: Any = self._mink.PostureTask(model, cost=PULL)
        self._limits = [self._mink.ConfigurationLimit(model)]
        self._full: FloatArray = np.zeros(model.nq)

    def solve(self, seed: FloatArray, posture: FloatArray, position: FloatArray, rotation: FloatArray) -> FloatArray:
        """Return joint positions (n,) with the tool at a pose; raises ``Unreachable``."""
        turn = self._mink.SO3.from_matrix(rotation)
        self._pose.set_target(self._mink.SE3.from_rotation_and_translation(turn, position))
        self._full[self._places] = posture
        self._posture.set_target(self._full)
        self._full[self._places] = seed
        self._configuration.update(self._full)
        for _ in range(ROUNDS):
            if np.abs(self._pose.compute_error(self._configuration)).max() < CLOSE:
                return self._configuration.q[self._places].copy()
            tasks = [self._pose, self._posture]
            velocity = self._mink.solve_ik(self._configuration, tasks, 1.0, "daqp", limits=self._limits)
            self._configuration.integrate_inplace(velocity, 1.0)
        raise Unreachable(inf, inf)


def points(arm: Arm, robot: RobotModel) -> list[tuple[FloatArray, FloatArray, FloatArray]]:
    """Return where the arm is (n,), and position and rotation of the next point of its path."""
    rng = np.random.default_rng(1)
    found: list[tuple[FloatArray, FloatArray, FloatArray]] = []
    while len(found) < POINTS:
        radius, bearing, turn = rng.uniform(0.35, 0.6), rng.uniform(-2.0, 2.0), rng.uniform(-1.5, 1.5)
        height = rng.uniform(0.12, 0.30) - robot.mount[2]
        here, next_ = ToolPose(radius, bearing, height, turn), ToolPose(radius, bearing + 0.03 / radius, height, turn)
        position, rotation = frame_of(here)
        found.append((arm.solve(arm.towards(position), position, rotation), *frame_of(next_)))
    return found


def main() -> None:
    """Print microseconds per point, failures and largest error of both."""
    for robot in load_catalog().robots.values():
        arm, other = arm_of(robot), Mink(robot)
        path = points(arm, robot)
        for name in ("ours", "mink"):
            failed, error = 0, 0.0
            began = perf_counter()
            for seed, position, rotation in path:
                try:
                    if name == "ours":
                        joints = arm.solve(seed, position, rotation)
                    else:
                        joints = other.solve(seed, arm.towards(position), position, rotation)
                except Unreachable:
                    failed += 1
                    continue
                error = max(error, float(np.abs(arm.forward(joints)[0] - position).max()))
            spent = (perf_counter() - began) / POINTS
            print(f"{robot.name}, {name}: {1e6 * spent:.0f} µs, {failed} failed, error {1e6 * error:.0f} µm")


if __name__ == "__main__":
    main()
