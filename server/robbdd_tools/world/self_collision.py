"""Pairs of robot parts that can collide: all pairs except parts that are always close to each other."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, Any

from robbdd_tools.world.coupled_joints import coupled_by_name
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.finger_motion import finger_motion

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robbdd_tools.catalog.api import RobotModel

NEAR = 2
"""Collisions of parts with up to this many joints between them are ignored: housings of wrists overlap across two."""
WORLD = 0


def name_bodies(child: Any) -> None:
    """Name every unnamed body of a robot's editable description."""
    for number, body in enumerate(child.bodies[1:]):
        body.name = body.name or f"part{number}"


def pairs_apart(child: Any, robot: RobotModel) -> tuple[list[tuple[str, str]], list[str]]:
    """Return the pairs of a robot's bodies whose contacts are ignored, and the bodies close to its base.

    As usual in motion planning, the pairs are neighbours (``NEAR``), parts of one gripper, and bodies that touch at
    home with an open gripper, because shapes are coarser than the arm. All bodies must have names, see ``name_bodies``.
    """
    model = child.copy().compile()
    names = [str(model.body(body).name) for body in range(model.nbody)]
    near = (pair for pair in combinations(range(1, model.nbody), 2) if _joints_between(model, *pair) <= NEAR)
    found = {*near, *combinations(_gripper(model, robot), 2), *_touching_at_home(child, robot)}
    beside = [names[body] for body in range(1, model.nbody) if _joints_between(model, WORLD, body) <= NEAR]
    return [(names[one], names[other]) for one, other in sorted(found)], beside


def _path(model: Any, body: int) -> list[int]:
    """Return a body and its ancestors, the world last."""
    found = [body]
    while found[-1] != WORLD:
        found.append(int(model.body_parentid[found[-1]]))
    return found


def _joints_between(model: Any, one: int, other: int) -> int:
    apart = set(_path(model, one)) ^ set(_path(model, other))
    return sum(int(model.body_jntnum[body]) for body in apart)


def _gripper(model: Any, robot: RobotModel) -> list[int]:
    """Return the bodies of the gripper: all descendants of the last common ancestor of the gripping faces."""
    paths = [_path(model, int(model.geom_bodyid[model.geom(pad).id])) for pad in robot.pads]
    palm = next(body for body in paths[0] if all(body in path for path in paths))
    return [] if palm == WORLD else [body for body in range(1, model.nbody) if palm in _path(model, body)]


def _touching_at_home(child: Any, robot: RobotModel) -> Iterator[tuple[int, int]]:
    alone = child.copy()
    for geom in alone.geoms:
        geom.contype = geom.conaffinity = int(bool(geom.contype or geom.conaffinity))
    model = alone.compile()
    data = mujoco.MjData(model)
    for joint, angle in zip(robot.joints, robot.home, strict=True):
        data.qpos[model.joint(joint).qposadr[0]] = angle
    coupled_by_name(model, robot.joints).place(data.qpos)
    motion = finger_motion(robot)
    for name, position in motion.open_joints:
        data.qpos[model.joint(name).qposadr[0]] = position
    for pad in () if motion.open_joints else robot.pads:
        body = model.body(int(model.geom_bodyid[model.geom(pad).id]))
        for joint in range(int(body.jntadr[0]), int(body.jntadr[0] + body.jntnum[0])):
            data.qpos[model.jnt_qposadr[joint]] = robot.gripper_open
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    mujoco.mj_collision(model, data)
    for first, second in data.contact.geom.tolist():
        one, other = sorted((int(model.geom_bodyid[first]), int(model.geom_bodyid[second])))
        if one != WORLD:
            yield one, other
