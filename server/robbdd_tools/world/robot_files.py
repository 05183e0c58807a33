"""Arms from users' model files. What a scene instance does not state is found in the file; missing servos are added."""

from __future__ import annotations

from collections.abc import Collection
from functools import lru_cache
from math import inf
from typing import TYPE_CHECKING, Any

from robbdd_tools.catalog.api import RobotModel
from robbdd_tools.catalog.executable import ArmModel, ModelEntry
from robbdd_tools.world.arm_chain import chain_to_palm
from robbdd_tools.world.coupled_joints import (
    followers_among,
    refuse_uncoupled,
    slowest,
    stiffen,
    tighten,
)
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.file_contents import (
    fix_joints,
    give_mass,
    make_solid,
    note_changes,
    put_at_origin,
    reduce_to_arm,
    touch_at_surfaces,
)
from robbdd_tools.world.finger_motion import FingerMotion, set_finger_motion
from robbdd_tools.world.gripper_actuators import GripperParts
from robbdd_tools.world.gripper_files import GripperReader
from robbdd_tools.world.gripper_names import named_in_spec
from robbdd_tools.world.home_posture import find_home
from robbdd_tools.world.joint_drives import add_servos, refuse_weak_drives
from robbdd_tools.world.mesh_pieces import use_pieces
from robbdd_tools.world.model_files import compiled, load, path_of, velocity_limits
from robbdd_tools.world.model_meshes import read_whole
from robbdd_tools.world.mounted_gripper import gripper_of, mount_gripper
from robbdd_tools.world.planar_joints import drives
from robbdd_tools.world.srdf_semantics import apply_srdf, path_to
from robbdd_tools.world.tilted_base import UPRIGHT, tilt_model
from robbdd_tools.world.tool_frame import TOOL, face_ahead, tool_of
from robbdd_tools.world.urdf_files import is_urdf, massless_links

if TYPE_CHECKING:
    from robbdd_tools.catalog.executable import ModelSource
    from robbdd_tools.world.tilted_base import Tilt

SPEED = 1.0
"""Speed limit (rad/s, m/s) of an arm's joints if neither the file nor the model has one."""
BASE_JOINTS = 3
"""Number of joints of a base that drives."""
FLOOR = -0.65
"""Height (m, world frame) of the floor on which a base that drives stands."""
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
    stated = named_in_spec(source.arm or ArmModel())
    spec = load(source)
    changes: list[str] = []
    if source.kind in ("file", "ros") and is_urdf(path_of(source)):
        # The engine refuses inertias that no body can have; drivers of real arms never read them.
        spec.compiler.balanceinertia = True
        changes = give_mass(spec, massless_links(path_of(source)))
    changes = [*reduce_to_arm(spec, source), *changes, *mount_gripper(spec, source)]
    put_at_origin(spec, next((body for _, body in source.bodies), ""))
    semantics = apply_srdf(spec, source)
    arm = semantics.complete(spec, stated)
    uses_group = semantics.palm and not stated.pads and not stated.tool
    chain = path_to(spec.body(semantics.palm)) if uses_group else _chain(spec, source, arm, changes)
    changes += [*_solid(spec, source), *touch_at_surfaces(spec)]
    joints = _joints(source, chain)
    refuse_uncoupled(spec, source, chain, joints)
    if followers := followers_among(spec, joints):
        changes.append(f"joints that follow others of the arm: {', '.join(followers)}")
        joints = tuple(joint for joint in joints if joint not in followers)
        if source.format == "urdf":
            stiffen(spec, followers)
        tighten(spec, compiled(spec, source), joints)
    is_mobile = drives(compiled(spec, source), joints)
    joints = joints[BASE_JOINTS:] if is_mobile else joints
    if is_mobile and tilt is not None and tilt.rotation != UPRIGHT:
        raise SceneError(
            f"the robot in {source.name} drives on the floor, so its base cannot be tilted", origin=source.origin
        )
    parts = GripperParts(spec, gripper_of(source) or source, arm, str(chain[-1].name), semantics.note(stated, arm))
    parts.name_geoms()
    gripper = GripperReader(parts).read()
    changes += parts.changes
    tool = tool_of(spec, source, arm.tool, gripper, chain[-1])
    velocity = arm.velocity or velocity_limits(source, spec, joints, SPEED)
    if followers and not arm.velocity:
        others = dict(zip(followers, velocity_limits(source, spec, followers, inf), strict=True))
        velocity = slowest(compiled(spec, source), joints, velocity, others)
    add_servos(spec, joints, followers)
    changes += _without_idle_forces(spec, {gripper.actuator}, chain)
    for body in spec.bodies:
        # Arms compensate their own weight, as real controllers do.
        body.gravcomp = 1.0 if body.name != "world" else 0.0
    model = compiled(spec, source)
    turn = UPRIGHT if tilt is None else tilt.rotation
    tilt_model(model, turn)
    home = arm.home or find_home(
        model,
        source,
        joints,
        tool,
        dict(gripper.open_joints),
        chain[-1].name,
        [one.positions for one in semantics.homes],
        height=FLOOR if is_mobile else None if tilt is None else tilt.height,
        is_upright=turn == UPRIGHT,
    )
    for what, numbers in (("home", home), ("velocity", velocity)):
        if len(numbers) != len(joints):
            counted = f"the arm has {len(joints)} joints ({', '.join(joints)}), '{what}' has {len(numbers)} numbers"
            raise SceneError(counted, origin=source.origin, entry=ModelEntry(what))
    _refuse_outside(model, source, joints, home)
    refuse_weak_drives(model, source, joints, home, dict(gripper.open_joints))
    if tool == TOOL and not gripper.one_sided:
        face_ahead(spec, model, joints, home)
    key = f"{source.iri}#{name}" + ("" if tilt is None else f"#{tilt}")
    _prepared[key] = spec
    note_changes(key, changes)
    motion = FingerMotion(
        gripper.rate,
        gripper.settling,
        gripper.open_joints,
        gripper.faces,
        gripper.sweep,
        gripper.one_sided,
        gripper.narrowest,
        gripper.lever,
    )
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


def _chain(spec: Any, source: ModelSource, arm: ArmModel, changes: list[str]) -> list[Any]:
    """Return the bodies from the base to the palm. Joints beside them are fixed, and added to ``changes``."""
    found = chain_to_palm(spec, source, arm)
    if found.beside:
        changes.append(f"joints beside the arm, fixed: {', '.join(found.beside)}")
        fix_joints(spec, source, found.beside)
    return found.bodies


def _solid(spec: Any, source: ModelSource) -> list[str]:
    """Let links without collision shapes collide as their visual shapes, or as the pieces of their meshes that are cut.

    Return what was changed, as lines for a report. Raises ``SceneError``.
    """
    changes = make_solid(spec)
    if changes and source.kind in ("file", "ros"):
        try:
            use_pieces(spec, read_whole(path_of(source))[1])
        except ValueError as error:
            raise SceneError(f"the model {source.name} cannot be read: {error}", origin=source.origin) from error
    return changes


def _joints(source: ModelSource, chain: list[Any]) -> tuple[str, ...]:
    """Return the joints of the arm, the one nearest to the base first."""
    joints = tuple(str(joint.name) for body in chain for joint in body.joints)
    if not joints:
        raise SceneError(f"no joint leads to the hand '{chain[-1].name}' of {source.name}", origin=source.origin)
    return joints


def _without_idle_forces(spec: Any, used: Collection[str], chain: list[Any]) -> list[str]:
    """Remove the other actuators that act although nothing commands them, and return what was changed.

    The engine clamps an idle control into its range: pads with adhesion from 1 to 2 would always stick to a part.
    """
    moved = {str(joint.name) for body in chain for joint in body.joints}
    idle = [one for one in spec.actuators if one.name not in used and str(one.target) not in moved and _acts_idle(one)]
    names = [str(one.name) for one in idle]
    for one in idle:
        spec.delete(one)
    return [f"actuators that act although nothing commands them, removed: {', '.join(names)}"] if names else []


def _acts_idle(actuator: Any) -> bool:
    """Return whether an actuator without a command is an adhesion or exerts a force that no position balances."""
    if actuator.trntype == mujoco.mjtTrn.mjTRN_BODY:
        return True
    low, high = (float(value) for value in actuator.ctrlrange)
    control = min(max(0.0, low), high) if low < high else 0.0
    bias = 0.0 if actuator.biastype == mujoco.mjtBias.mjBIAS_NONE else float(actuator.biasprm[0])
    return float(actuator.biasprm[1]) == 0.0 and float(actuator.gainprm[0]) * control + bias != 0.0


def _refuse_outside(model: Any, source: ModelSource, joints: tuple[str, ...], home: tuple[float, ...]) -> None:
    for index, (joint, value) in enumerate(zip(joints, home, strict=True)):
        number = model.joint(joint).id
        low, high = (float(bound) for bound in model.jnt_range[number])
        if model.jnt_limited[number] and not low - 1e-6 <= value <= high + 1e-6:
            text = (
                f"the home position {value:.4g} of the joint '{joint}' is outside its limits, {low:.4g} to {high:.4g}"
            )
            raise SceneError(f"{text} in {source.name}", origin=source.origin, entry=ModelEntry("home", index))
