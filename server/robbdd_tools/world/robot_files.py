"""Arms from the model files of an executable scene; missing servos and names are added."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robbdd_tools.catalog.api import RobotModel
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.model_files import compiled, load

if TYPE_CHECKING:
    from robbdd_tools.catalog.executable import ModelSource

SPEED = 1.0
"""Speed limit (rad/s) of an arm's joints if neither the file nor the model has one."""
STIFFNESS, DAMPING = 2000.0, 100.0
"""Gains (N m/rad, N m s/rad) of the servos of an arm whose file has none."""
GRIP_STIFFNESS, GRIP_DAMPING, GRIP_FORCE = 3000.0, 60.0, 15.0
"""Gains (N/m, N s/m) and force limit (N) of a gripper whose file has no servo."""
_prepared: dict[str, Any] = {}


def prepared_robot(key: str) -> Any | None:
    """Return the engine's description of an arm prepared by ``robot_from``."""
    return _prepared.get(key)


def robot_from(source: ModelSource, name: str) -> RobotModel:
    """Return the arm in a file, with missing servos and names added; raises ``SceneError``."""
    arm = source.arm
    if arm is None or not arm.tool or not arm.actuator or not arm.pads or arm.open is None or arm.closed is None:
        wanted = "'tool: \"…\" gripper { … }' in its model block"
        raise SceneError(f"'{name}' cannot pick without a tool and a gripper: add {wanted}", origin=source.origin)
    spec = load(source)
    tool = _tool_site(spec, source, arm.tool)
    joints = _chain(spec, source, tool)
    pads = tuple(_pad(spec, source, pad) for pad in arm.pads)
    _servos(spec, source, joints)
    _gripper_servo(spec, source, arm.actuator)
    for body in spec.bodies:
        # Arms compensate their own weight, as real controllers do.
        body.gravcomp = 1.0 if body.name != "world" else 0.0
    model = compiled(spec, source)
    home = arm.home or _home(model, joints)
    for what, numbers in (("home", home), ("velocity", arm.velocity or (SPEED,) * len(joints))):
        if len(numbers) != len(joints):
            counted = f"the arm has {len(joints)} joints ({', '.join(joints)}), '{what}' has {len(numbers)} numbers"
            raise SceneError(counted, origin=source.origin)
    key = f"{source.iri}#{name}"
    _prepared[key] = spec
    limits = [
        float(model.joint(joint).actfrcrange[1]) if hasattr(model.joint(joint), "actfrcrange") else 0.0
        for joint in joints
    ]
    return RobotModel(
        name=name,
        prefixes=(),
        mjcf=key,
        joints=joints,
        home=tuple(home),
        velocity_limits=tuple(arm.velocity or (SPEED,) * len(joints)),
        torque_limits=tuple(limits),
        tool_site=tool,
        gripper_actuator=arm.actuator,
        gripper_open=arm.open,
        gripper_closed=arm.closed,
        pads=pads,
        mount=(0.0, 0.0, 0.15),
        stroke=arm.stroke,
        doc=f"from {source.name}",
        source=source.name,
    )


def _names(things: Any) -> str:
    return ", ".join(str(thing.name) for thing in things if thing.name) or "none"


def _tool_site(spec: Any, source: ModelSource, name: str) -> str:
    """Return the tool's site; for a body of that name, create one."""
    if spec.site(name) is not None:
        return name
    body = spec.body(name)
    if body is None:
        known = f"it has the sites {_names(spec.sites)} and the bodies {_names(spec.bodies[1:])}"
        raise SceneError(f"{source.name} has no site or body '{name}' for the tool; {known}", origin=source.origin)
    body.add_site(name=name)
    return name


def _chain(spec: Any, source: ModelSource, tool: str) -> tuple[str, ...]:
    """Return the hinges between the arm's base and its tool."""
    body = spec.site(tool).parent
    joints: list[str] = []
    while body is not None and body.name != "world":
        hinges = [joint.name for joint in body.joints if joint.type == mujoco.mjtJoint.mjJNT_HINGE]
        joints = hinges + joints
        body = body.parent
    if not joints:
        raise SceneError(f"no joint leads to the tool '{tool}' of {source.name}", origin=source.origin)
    return tuple(joints)


def _pad(spec: Any, source: ModelSource, name: str) -> str:
    """Return a gripping face; for a body of that name, its first shape."""
    if spec.geom(name) is not None:
        return name
    body = spec.body(name)
    touching = [] if body is None else [geom for geom in body.geoms if geom.contype or geom.conaffinity]
    if not touching:
        known = f"it has the geoms {_names(spec.geoms)} and the bodies {_names(spec.bodies[1:])}"
        raise SceneError(f"{source.name} has no gripping face '{name}'; {known}", origin=source.origin)
    face = touching[0]
    face.name = name
    # URDF does not describe contacts: make gripping faces stiff and rough like rubber, or light objects slip out.
    face.condim, face.friction = 4, [0.9, 0.01, 0.001]
    face.solref, face.solimp = [0.005, 1.0], [0.95, 0.99, 0.001, 0.5, 2.0]
    return name


def _servos(spec: Any, source: ModelSource, joints: tuple[str, ...]) -> None:
    """Give each joint without a position servo one."""
    driven = {str(actuator.target): actuator for actuator in spec.actuators}
    for joint in joints:
        actuator = driven.get(joint)
        if actuator is None:
            _add_servo(spec, joint, joint, STIFFNESS, DAMPING)
        elif actuator.biastype != mujoco.mjtBias.mjBIAS_AFFINE or actuator.gainprm[0] <= 0:
            message = f"the joint '{joint}' of {source.name} is not driven by a position servo"
            raise SceneError(f"{message}: use <position>, or leave its actuator out", origin=source.origin)


def _gripper_servo(spec: Any, source: ModelSource, name: str) -> None:
    if spec.actuator(name) is not None:
        return
    if spec.joint(name) is None:
        known = f"it has the actuators {_names(spec.actuators)} and the joints {_names(spec.joints)}"
        raise SceneError(
            f"{source.name} has no actuator or joint '{name}' for the gripper; {known}", origin=source.origin
        )
    servo = _add_servo(spec, name, name, GRIP_STIFFNESS, GRIP_DAMPING)
    servo.forcerange = [-GRIP_FORCE, GRIP_FORCE]
    servo.forcelimited = True


def _add_servo(spec: Any, name: str, joint: str, stiffness: float, damping: float) -> Any:
    servo = spec.add_actuator(name=name, target=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT)
    servo.set_to_position(kp=stiffness, kv=damping)
    return servo


def _home(model: Any, joints: tuple[str, ...]) -> tuple[float, ...]:
    """Return the joint positions of the first key frame, else the middle of each joint's range."""
    if model.nkey:
        return tuple(float(model.key_qpos[0, model.joint(joint).qposadr[0]]) for joint in joints)
    return tuple(float(sum(model.joint(joint).range)) / 2 for joint in joints)
