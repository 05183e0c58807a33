"""Arms from users' model files. What a scene instance does not state is found in the file; missing servos are added."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.catalog.api import GripperKind, RobotModel
from robbdd_tools.catalog.executable import ArmModel, ModelEntry
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.finger_motion import FingerMotion, set_finger_motion
from robbdd_tools.world.gripper_actuators import GripperParts
from robbdd_tools.world.gripper_files import FoundGripper, GripperReader
from robbdd_tools.world.home_posture import find_home
from robbdd_tools.world.model_files import compiled, load, path_of, velocity_limits
from robbdd_tools.world.planar_joints import drives
from robbdd_tools.world.srdf_semantics import apply_srdf, path_to
from robbdd_tools.world.tilted_base import UPRIGHT, tilt_model
from robbdd_tools.world.urdf_files import HIDDEN, is_urdf

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.catalog.executable import ModelSource
    from robbdd_tools.world.tilted_base import Tilt

SPEED = 1.0
"""Speed limit (rad/s, m/s) of an arm's joints if neither the file nor the model has one."""
STIFFNESS, DAMPING = 2000.0, 100.0
"""Smallest gains (N m/rad, N m s/rad) of added servos."""
SLIDING = 10.0
"""For a sliding joint, the smallest gains (N/m, N s/m) are this many times as large."""
FREQUENCY, RATIO = 20.0, 0.7
"""Natural frequency (rad/s) and damping ratio of servos that are added to joints with a large inertia."""
BASE_JOINTS = 3
"""Number of joints of a base that drives."""
FLOOR = -0.65
"""Height (m, world frame) of the floor on which a base that drives stands."""
TOOL = "robbdd-tool"
ALIGNED = np.cos(np.radians(5.0))
"""The y axis of a stated tool is kept if the cosine of its angle to the closing direction is at least this."""
OUTWARDS = np.cos(np.radians(30.0))
"""The z axis of a stated tool is kept if the cosine of its angle to the direction out of the hand is at least this."""
ARMS = 16
"""Size of the cache of arms."""
_prepared: dict[str, Any] = {}


def prepared_robot(key: str) -> Any | None:
    """Return the engine's description of an arm prepared by ``robot_from``."""
    return _prepared.get(key)


def robot_from(source: ModelSource, name: str, tilt: Tilt | None = None) -> RobotModel:
    """Return the arm in a file, with missing servos and names added; raises ``SceneError``.

    Tools also point down from a base with a ``tilt``. A file is read once in a process; code that makes a model is
    called each time.
    """
    return _read_robot(source, name, tilt) if source.kind == "python" else _read_once(source, name, tilt)


@lru_cache(maxsize=ARMS)
def _read_once(source: ModelSource, name: str, tilt: Tilt | None) -> RobotModel:
    return _read_robot(source, name, tilt)


def _read_robot(source: ModelSource, name: str, tilt: Tilt | None) -> RobotModel:
    stated = source.arm or ArmModel()
    spec = load(source)
    if source.kind in ("file", "ros") and is_urdf(path_of(source)):
        # The engine refuses inertias that no body can have; drivers of real arms never read them.
        spec.compiler.balanceinertia = True
    _clear(spec, source)
    semantics = apply_srdf(spec, source)
    arm = semantics.complete(spec, stated)
    uses_group = semantics.palm and not stated.pads and not stated.tool
    chain = path_to(spec.body(semantics.palm)) if uses_group else _chain_to_palm(spec, source, arm)
    joints = _joints(source, chain)
    is_mobile = drives(compiled(spec, source), joints)
    joints = joints[BASE_JOINTS:] if is_mobile else joints
    if is_mobile and tilt is not None:
        raise SceneError(
            f"the robot in {source.name} drives on the floor, so its base cannot be tilted", origin=source.origin
        )
    parts = GripperParts(spec, source, arm, str(chain[-1].name), semantics.note(stated, arm))
    parts.name_geoms()
    gripper = GripperReader(parts).read()
    tool = _tool(spec, source, arm.tool, gripper, chain[-1])
    _servos(spec, joints)
    for body in spec.bodies:
        # Arms compensate their own weight, as real controllers do.
        body.gravcomp = 1.0 if body.name != "world" else 0.0
    model = compiled(spec, source)
    turn = UPRIGHT if tilt is None else tilt.rotation
    tilt_model(model, turn)
    velocity = arm.velocity or velocity_limits(source, joints, SPEED)
    home = arm.home or find_home(
        model,
        source,
        joints,
        tool,
        dict(gripper.open_joints),
        chain[-1].name,
        [one.positions for one in semantics.homes],
        height=FLOOR if is_mobile else None if tilt is None else tilt.height,
    )
    for what, numbers in (("home", home), ("velocity", velocity)):
        if len(numbers) != len(joints):
            counted = f"the arm has {len(joints)} joints ({', '.join(joints)}), '{what}' has {len(numbers)} numbers"
            raise SceneError(counted, origin=source.origin, entry=ModelEntry(what))
    _refuse_outside(model, source, joints, home)
    if tool == TOOL:
        _face_ahead(spec, model, joints, home)
    key = f"{source.iri}#{name}" + ("" if tilt is None else f"#{tilt}")
    _prepared[key] = spec
    motion = FingerMotion(gripper.rate, gripper.settling, gripper.open_joints, gripper.faces, gripper.sweep)
    set_finger_motion(key, motion)
    limits = (float(model.jnt_actfrcrange[model.joint(joint).id, 1]) for joint in joints)
    return RobotModel(
        name=name,
        prefixes=(),
        mjcf=key,
        joints=joints,
        home=tuple(home),
        velocity_limits=tuple(velocity),
        torque_limits=tuple(limits),
        tool_site=tool,
        gripper_actuator=gripper.actuator,
        gripper_open=gripper.open,
        gripper_closed=gripper.closed,
        pads=gripper.pads,
        mount=(-0.8, 0.0, FLOOR) if is_mobile else (0.0, 0.0, 0.15),
        stroke=gripper.stroke,
        doc=f"from {source.name}",
        source=source.name,
        gripper=gripper.kind,
        tilt=turn,
    )


def _clear(spec: Any, source: ModelSource) -> None:
    """Remove the file's floors and names its joints. Raises ``SceneError`` for an arm on a floating base."""
    for geom in list(spec.worldbody.geoms):
        if geom.type == mujoco.mjtGeom.mjGEOM_PLANE:
            spec.delete(geom)
    for number, body in enumerate(spec.bodies[1:]):
        body.name = body.name or f"part{number}"
    for number, actuator in enumerate(spec.actuators):
        actuator.name = actuator.name or f"actuator{number}"
    for number, joint in enumerate(spec.joints):
        joint.name = joint.name or f"joint{number}"
        if joint.type in (mujoco.mjtJoint.mjJNT_FREE, mujoco.mjtJoint.mjJNT_BALL):
            kind = "a free joint" if joint.type == mujoco.mjtJoint.mjJNT_FREE else "a ball joint"
            text = (
                f"{source.name} has {kind} '{joint.name}': only arms with rotating and sliding joints can be simulated"
            )
            raise SceneError(text, origin=source.origin)


def _names(things: Any) -> str:
    return ", ".join(str(thing.name) for thing in things if thing.name) or "none"


def _tool_body(spec: Any, source: ModelSource, name: str) -> Any:
    """Return the body of the stated tool."""
    site = spec.site(name)
    body = site.parent if site is not None else spec.body(name)
    if body is None:
        known = f"it has the sites {_names(spec.sites)} and the bodies {_names(spec.bodies[1:])}"
        raise SceneError(f"{source.name} has no site or body '{name}' for the tool; {known}", origin=source.origin)
    return body


def _chain_to_palm(spec: Any, source: ModelSource, arm: ArmModel) -> list[Any]:
    """Return the bodies from the base to the palm, which carries all gripping faces.

    Without stated faces, the palm is the first body with several jointed branches, or else the last body, but no body
    beyond the stated tool.
    """
    tool = path_to(_tool_body(spec, source, arm.tool)) if arm.tool else []
    carriers = [spec.geom(pad).parent if spec.geom(pad) is not None else spec.body(pad) for pad in arm.pads]
    paths = [[body.name for body in path_to(one)] for one in carriers if one is not None]
    if len(paths) > 1 and len(paths) == len(arm.pads):
        common = [name for name in paths[0] if all(name in path for path in paths)]
        if common:
            return path_to(spec.body(common[-1]))
    body = spec.worldbody
    while True:
        branches = _without_wheels(body, [child for child in body.bodies if _moves(child)])
        if len(branches) != 1:
            break
        body = branches[0]
    suctions = [one for one in spec.actuators if one.trntype == mujoco.mjtTrn.mjTRN_BODY]
    if not branches and suctions:
        body = spec.body(str(suctions[0].target))
    if not branches and len(carriers) == 1 and carriers[0] is not None:
        body = carriers[0]
    if body.name == "world":
        text = f"{source.name} is not one arm: " + (
            f"{len(branches)} chains of joints begin at its base" if branches else "it has no joints"
        )
        raise SceneError(text, origin=source.origin)
    common = {one.name for one in tool}
    return [one for one in path_to(body) if not tool or one.name in common]


def _without_wheels(body: Any, branches: list[Any]) -> list[Any]:
    """Return the jointed branches of a body, except the wheels of a base that drives."""
    kinds = [joint.type for one in path_to(body) for joint in one.joints]
    slide, hinge = mujoco.mjtJoint.mjJNT_SLIDE, mujoco.mjtJoint.mjJNT_HINGE
    if len(branches) < 2 or kinds != [slide, slide, hinge]:
        return branches
    return [
        max(branches, key=lambda branch: len(branch.joints) + sum(len(one.joints) for one in branch.find_all("body")))
    ]


def _moves(body: Any) -> bool:
    return bool(body.joints) or any(_moves(child) for child in body.bodies)


def _joints(source: ModelSource, chain: list[Any]) -> tuple[str, ...]:
    """Return the joints of the arm, the one nearest to the base first."""
    joints = tuple(str(joint.name) for body in chain for joint in body.joints)
    if not joints:
        raise SceneError(f"no joint leads to the hand '{chain[-1].name}' of {source.name}", origin=source.origin)
    return joints


def _tool(spec: Any, source: ModelSource, stated: str, gripper: FoundGripper, palm: Any) -> str:
    """Return the name of the tool's site, with z out of the hand and y along the closing direction.

    A stated site or body with these axes is kept; any other one gives only the place.
    """
    site, body = (spec.site(stated), spec.body(stated)) if stated else (None, None)
    if site is None and body is not None:
        site = body.add_site(name=stated)
    across, ahead = gripper.across, gripper.ahead
    place, kept = gripper.middle, None
    if site is not None:
        model = compiled(spec, source)
        data: Any = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        number, hand = model.site(stated).id, model.body(palm.name).id
        turn = data.xmat[hand].reshape(3, 3)
        axes = turn.T @ data.site_xmat[number].reshape(3, 3)
        place = turn.T @ (data.site_xpos[number] - data.xpos[hand])
        is_cup = gripper.kind is GripperKind.SUCTION
        if axes[:, 2] @ ahead >= OUTWARDS:
            kept, ahead = axes[:, 2], axes[:, 2]
            if is_cup or abs(axes[:, 1] @ across) >= ALIGNED:
                return stated
    across = across - (across @ ahead) * ahead
    across /= np.linalg.norm(across)
    frame = np.column_stack([np.cross(across, ahead), across, ahead if kept is None else kept])
    quaternion: FloatArray = np.empty(4)
    mujoco.mju_mat2Quat(quaternion, frame.ravel())
    palm.add_site(name=TOOL, pos=place, quat=quaternion, group=HIDDEN)
    return TOOL


def _face_ahead(spec: Any, model: Any, joints: tuple[str, ...], home: tuple[float, ...]) -> None:
    """Turn a found tool by half a turn if its x axis then points ahead at home.

    The fingers are interchangeable; with x ahead, the wrist can turn as far to one side as to the other.
    """
    data: Any = mujoco.MjData(model)
    for joint, value in zip(joints, home, strict=True):
        data.qpos[model.joint(joint).qposadr[0]] = value
    mujoco.mj_kinematics(model, data)
    site = spec.site(TOOL)
    place, ahead = data.site(TOOL).xpos, data.site(TOOL).xmat[0::3]
    if place[:2] @ ahead[:2] < 0.0:
        turned: FloatArray = np.empty(4)
        mujoco.mju_mulQuat(turned, np.array(site.quat), np.array([0.0, 0.0, 0.0, 1.0]))
        site.quat = turned


def _servos(spec: Any, joints: tuple[str, ...]) -> None:
    """Replace the motor or velocity servo of each joint without a position servo by a position servo.

    A servo with gravity compensation is a joint impedance controller: it drives torque-controlled arms, too.
    """
    driven = {str(one.target): one for one in spec.actuators if one.trntype == mujoco.mjtTrn.mjTRN_JOINT}
    inertias = _inertias(spec, joints)
    for joint in joints:
        actuator = driven.get(joint)
        if actuator is not None and _is_position_servo(actuator):
            continue
        limit = 0.0
        if actuator is not None:
            limit = _largest_force(actuator)
            spec.delete(actuator)
        sliding = SLIDING if spec.joint(joint).type == mujoco.mjtJoint.mjJNT_SLIDE else 1.0
        stiffness = max(STIFFNESS * sliding, FREQUENCY**2 * inertias[joint])
        damping = max(DAMPING * sliding, 2 * RATIO * (stiffness * inertias[joint]) ** 0.5)
        servo = spec.add_actuator(name=f"{joint}-servo", target=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        servo.set_to_position(kp=stiffness, kv=damping)
        if limit > 0:
            servo.forcerange, servo.forcelimited = [-limit, limit], True


def _is_position_servo(actuator: Any) -> bool:
    return (
        actuator.biastype == mujoco.mjtBias.mjBIAS_AFFINE
        and actuator.gainprm[0] > 0
        and abs(actuator.gainprm[0] + actuator.biasprm[1]) <= 1e-6 * actuator.gainprm[0]
        and actuator.gear[0] == 1.0
    )


def _largest_force(actuator: Any) -> float:
    """Return the largest force (N, N m) of an actuator on its joint; 0 if it has no limit."""
    if actuator.forcerange[1] > actuator.forcerange[0]:
        return float(actuator.forcerange[1] * abs(actuator.gear[0]))
    is_motor = actuator.biastype == mujoco.mjtBias.mjBIAS_NONE
    if is_motor and actuator.ctrlrange[1] > actuator.ctrlrange[0]:
        return float(actuator.ctrlrange[1] * abs(actuator.gear[0]) * actuator.gainprm[0])
    return 0.0


def _inertias(spec: Any, joints: tuple[str, ...]) -> dict[str, float]:
    """Return the inertia (kg m², kg) that each joint moves in the arm's posture in the file."""
    model = spec.copy().compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    full = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, full)
    return {joint: float(full[dof, dof]) for joint in joints for dof in [int(model.joint(joint).dofadr[0])]}


def _refuse_outside(model: Any, source: ModelSource, joints: tuple[str, ...], home: tuple[float, ...]) -> None:
    for index, (joint, value) in enumerate(zip(joints, home, strict=True)):
        number = model.joint(joint).id
        low, high = (float(bound) for bound in model.jnt_range[number])
        if model.jnt_limited[number] and not low - 1e-6 <= value <= high + 1e-6:
            text = (
                f"the home position {value:.4g} of the joint '{joint}' is outside its limits, {low:.4g} to {high:.4g}"
            )
            raise SceneError(f"{text} in {source.name}", origin=source.origin, entry=ModelEntry("home", index))
