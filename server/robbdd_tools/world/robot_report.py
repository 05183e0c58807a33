"""Report the data of an arm that a run uses: those that its file states, those found in it, and those assumed."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.base.srdf import srdf_files
from robbdd_tools.catalog.api import GripperKind
from robbdd_tools.catalog.executable import ArmModel
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.file_contents import changes_of
from robbdd_tools.world.finger_motion import finger_motion
from robbdd_tools.world.grip_force import grip_force
from robbdd_tools.world.gripper_names import name_in_file
from robbdd_tools.world.mesh_pieces import CUT
from robbdd_tools.world.mobile_base import base_of
from robbdd_tools.world.model_files import load, path_of, velocity_limits
from robbdd_tools.world.model_meshes import whole_meshes
from robbdd_tools.world.robot_files import robot_from
from robbdd_tools.world.robot_specs import load_robot
from robbdd_tools.world.robots_in_world import COLUMN
from robbdd_tools.world.srdf_semantics import file_of
from robbdd_tools.world.urdf_files import impossible_inertias

if TYPE_CHECKING:
    from pathlib import Path

    from robbdd_tools.catalog.api import RobotModel
    from robbdd_tools.catalog.executable import ModelSource
    from robbdd_tools.world.simulation import Simulation

NUMBERED = re.compile(r"(actuator|joint)\d+")
"""Names that actuators and joints without a name get."""
FOUND = "robbdd-"
"""Prefix of added names that no file of an arm has: names of parts without a name, and of things that were found."""
NUMBERS = {2: "two", 3: "three", 4: "four", 5: "five"}
SAME = 1e-3
"""An open gripper counts as the same if its joints differ by less than this (rad, m)."""


def report(simulation: Simulation, name: str, source: ModelSource | None) -> Iterator[str]:
    """Yield the lines of a report on an agent. ``source`` is its model's file, ``None`` for a model of the catalog."""
    robot, model = simulation.robots[name].model, simulation.model
    is_cup = robot.gripper is GripperKind.SUCTION
    fingers = "a suction cup" if is_cup else _fingers(model, name, robot)
    mass = sum(float(model.body_mass[body]) for body in _bodies(model, name))
    yield f"an arm of {len(robot.joints)} joints with {fingers}, {mass:.3g} kg"
    yield from _table([["joint", "kind", "limits", "largest speed", "home"], *_joints(model, name, robot, source)])
    if source is not None:
        yield from _semantic_description(source)
    for file in (source, None if source is None else source.gripper):
        if file is not None and file.kind in ("file", "ros"):
            yield from _remarks(path_of(file))
    yield from changes_of(robot.mjcf)
    base = base_of(robot)
    if base is not None:
        assumed = "" if base.stated else " (partly assumed)"
        limits = f"{base.speed:g} m/s, {base.turning:g} rad/s, {base.force:.0f} N and {base.torque:.0f} N m{assumed}"
        yield f"base: drives by the joints {', '.join(base.joints)}, at most with {limits}"
    yield f"home: {_origin_of_home(simulation, name, source)}"
    yield f"tool: {_tool(simulation, name)}"
    mounted = None if source is None or source.arm is None else source.arm.mounted
    if mounted is not None:
        yield f"gripper from {mounted.name}, fixed to '{mounted.mount}'"
    yield f"gripper: actuator '{name_in_file(robot.gripper_actuator)}', open at {robot.gripper_open:g}, closed at " + (
        f"{robot.gripper_closed:g}, {1000 * robot.stroke:.0f} mm {'across' if is_cup else 'wide'}"
    )
    if (force := grip_force(model, name, robot)) is not None:
        yield f"grip: {force:.3g} N {'of vacuum' if is_cup else 'with each finger'}"
    if finger_motion(robot).narrowest > SAME:
        yield f"closed gripper: its faces stay {1000 * finger_motion(robot).narrowest:.0f} mm apart"
    faces = finger_motion(robot).faces or tuple((pad,) for pad in robot.pads)
    shown = " | ".join(", ".join(_shape(model, name, shape) for shape in face) for face in faces)
    yield f"gripping faces: {shown}, {_friction(model, name, robot)}"


def _remarks(path: Path) -> Iterator[str]:
    """Yield what a file states that a run cannot use as it is."""
    unusual = ", ".join(impossible_inertias(path))
    if unusual:
        yield f"inertias that no body can have, replaced by the mean of their principal moments: {unusual}"
    hollow = whole_meshes(path)
    if hollow:
        meshes = ", ".join(f"{mesh.name} ({share:.1f} times its volume)" for mesh, share in hollow.items())
        yield f"hollow meshes, each of which collides as its convex hull: {meshes}; {CUT}"


def _shape(model: Any, name: str, shape: str) -> str:
    """Return the name of a gripping shape in the file or, without one, that of its link."""
    if not shape.startswith(FOUND):
        return name_in_file(shape)
    body = model.body(int(model.geom(f"{name}/{shape}").bodyid[0]))
    return f"a shape of '{name_in_file(body.name.removeprefix(f'{name}/'))}'"


def _fingers(model: Any, name: str, robot: RobotModel) -> str:
    """Return the number of fingers that have gripping faces, in words."""
    carriers = {int(model.body_weldid[int(model.geom(f"{name}/{pad}").bodyid[0])]) for pad in robot.pads}
    return f"{NUMBERS.get(len(carriers), len(carriers))} fingers"


def as_stated(robot: RobotModel, name: str, source: ModelSource) -> ArmModel:
    """Return the data of an arm that a scene instance can state without a change of the arm.

    Data about a gripper are left out if they would change it: several actuators may close it, but only one can be
    named.
    """
    mounted = None if source.arm is None else source.arm.mounted
    actuator = name_in_file(robot.gripper_actuator)
    if NUMBERED.fullmatch(actuator):
        return ArmModel(home=robot.home, velocity=robot.velocity_limits, mounted=mounted)
    faces = finger_motion(robot).faces
    pads = tuple(name_in_file(face[0]) for face in faces if len(face) == 1 and not face[0].startswith(FOUND))
    tool = "" if robot.tool_site.startswith(FOUND) else name_in_file(robot.tool_site)
    plain = ArmModel(tool=tool, home=robot.home, velocity=robot.velocity_limits, mounted=mounted)
    full = replace(
        plain,
        actuator=actuator,
        open=robot.gripper_open,
        closed=robot.gripper_closed,
        pads=pads if len(pads) == len(faces) else (),
        stroke=robot.stroke,
    )
    try:
        again = robot_from(replace(source, iri=f"{source.iri}-stated", arm=full), name)
    except SceneError:
        return plain
    one, other = (dict(finger_motion(found).open_joints) for found in (robot, again))
    same = one.keys() == other.keys() and all(abs(one[joint] - other[joint]) < SAME for joint in one)
    return full if same and again.pads == robot.pads else plain


def stated(arm: ArmModel, source: ModelSource, joints_slide: bool) -> Iterator[str]:
    """Yield the lines of a ``.scenex`` that state the data of an arm; a user changes them where they are wrong."""
    yield f"model arm_model as {source.format} {{"
    yield f"    sys path = '{source.name}'"
    if arm.tool:
        yield f'    tool: "{arm.tool}"'
    if arm.actuator or arm.mounted is not None:
        yield "    gripper {"
    if arm.mounted is not None:
        yield f"        sys path = '{arm.mounted.name}'"
        yield f'        on: "{arm.mounted.mount}"'
    if arm.actuator:
        yield f'        actuator: "{arm.actuator}"'
        yield f"        open: {arm.open:.6g}"
        yield f"        close: {arm.closed:.6g}"
        if arm.pads:
            pads = ", ".join(f'"{pad}"' for pad in arm.pads)
            yield f"        pads: {pads}"
        yield f"        stroke: {1000 * arm.stroke:.4g} mm"
    if arm.actuator or arm.mounted is not None:
        yield "    }"
    yield f"    home: ({', '.join(_number(value, 6) for value in arm.home)}) rad"
    note = "   // sliding joints in m/s" if joints_slide else ""
    yield f"    velocity: ({', '.join(f'{value:.4g}' for value in arm.velocity)}) rad/s{note}"
    yield "}"


def slides(model: Any, name: str, robot: RobotModel) -> list[bool]:
    """Return for each joint of an arm whether it is a sliding joint."""
    kinds = (model.joint(f"{name}/{joint}").type[0] for joint in robot.joints)
    return [int(kind) == int(mujoco.mjtJoint.mjJNT_SLIDE) for kind in kinds]


def _bodies(model: Any, name: str) -> list[int]:
    names = [str(model.body(body).name) for body in range(model.nbody)]
    return [body for body, own in enumerate(names) if own.startswith(f"{name}/") and own != f"{name}/{COLUMN}"]


def _joints(model: Any, name: str, robot: RobotModel, source: ModelSource | None) -> Iterator[list[str]]:
    written = velocity_limits(source, load(source), robot.joints, 0.0) if source is not None else robot.velocity_limits
    for number, (joint, is_sliding) in enumerate(zip(robot.joints, slides(model, name, robot), strict=True)):
        found = model.joint(f"{name}/{joint}")
        unit = "m" if is_sliding else "rad"
        low, high = (float(bound) for bound in found.range)
        limits = f"{low:.4g} to {high:.4g} {unit}" if model.jnt_limited[found.id] else "none in the file: one turn"
        assumed = "" if written[number] else " (assumed)"
        speed = f"{robot.velocity_limits[number]:.4g} {unit}/s{assumed}"
        yield [
            joint,
            "sliding" if is_sliding else "rotating",
            limits,
            speed,
            f"{_number(robot.home[number], 4)} {unit}",
        ]


def _number(value: float, digits: int) -> str:
    """Return a number with some decimals, without trailing zeros and without a negative zero."""
    return f"{round(float(value), digits) + 0.0:g}"


def _table(rows: list[list[str]]) -> Iterator[str]:
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    for row in rows:
        yield "  " + "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()


def _semantic_description(source: ModelSource) -> Iterator[str]:
    """Yield a line on the SRDF file that is used; if a robot has several, none is used."""
    srdf = file_of(source)
    if srdf is not None:
        yield f"semantic description: {srdf.path.name}, {len(srdf.apart)} pairs of links without collisions"
        return
    several = ", ".join(path.name for path in srdf_files(path_of(source))) if source.kind in ("file", "ros") else ""
    if several:
        lacks = f"none is used, since several describe this robot ({several}): name one like the URDF file"
        yield f"semantic description: {lacks}"


def _origin_of_home(simulation: Simulation, name: str, source: ModelSource | None) -> str:
    robot = simulation.robots[name].model
    if source is None:
        return "of the catalog"
    key = _key_frame_of_home(robot)
    srdf = file_of(source)
    own = dict(zip(robot.joints, robot.home, strict=True))
    for state in srdf.states if srdf is not None and key is None else ():
        if all(abs(state.positions.get(joint, np.inf) - value) < SAME for joint, value in own.items()):
            return f"state '{state.name}' of the SRDF file"
    if key is None:
        return "found by a search: the tool points down, the arm reaches far"
    return f"key frame '{key}' of the file"


def _key_frame_of_home(robot: RobotModel) -> str | None:
    """Return the name of the key frame in the robot's file that gives its home; the world has no key frames."""
    model = load_robot(robot).compile()
    places = [int(model.joint(joint).qposadr[0]) for joint in robot.joints]
    homes: Any = model.key_qpos[:, places]
    same = (key for key in range(model.nkey) if np.allclose(homes[key], robot.home, atol=1e-4))
    return next((str(model.key(key).name) for key in same), None)


def _tool(simulation: Simulation, name: str) -> str:
    robot, model, data = simulation.robots[name], simulation.model, simulation.data
    place = ", ".join(_number(value, 3) for value in data.site_xpos[robot.tool] - np.array(robot.base.position))
    where = f"at ({place}) m from the base at home"
    if robot.model.tool_site.startswith(FOUND):
        body = str(model.body(int(model.site_bodyid[robot.tool])).name).rpartition("/")[2]
        return f"found between the tips of the gripping faces, on '{body}', {where}"
    return f"the site '{robot.model.tool_site}', {where}"


def _friction(model: Any, name: str, robot: RobotModel) -> str:
    values = {round(float(model.geom(f"{name}/{pad}").friction[0]), 3) for pad in robot.pads}
    return f"friction {' and '.join(f'{value:g}' for value in sorted(values))}"
