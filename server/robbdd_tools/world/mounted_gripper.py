"""Fix a gripper from a file of its own to an arm: makers often ship arms without a gripper."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.arm_chain import body_of
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.file_contents import give_mass, leave_out_scene, name_parts
from robbdd_tools.world.frames import PoseError, is_rotation
from robbdd_tools.world.gripper_names import MOUNT, PREFIX
from robbdd_tools.world.model_files import compiled, load, path_of
from robbdd_tools.world.urdf_files import is_urdf, massless_links

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.catalog.executable import ModelSource, MountedGripper


def mount_gripper(spec: Any, source: ModelSource) -> list[str]:
    """Add the gripper that an arm's model names, if any, to the description of the arm.

    Its parts get ``PREFIX`` before their names. Return what was changed in its file, as lines for a report. Raises
    ``SceneError``.
    """
    gripper, mounted = gripper_of(source), None if source.arm is None else source.arm.mounted
    if gripper is None or mounted is None:
        return []
    if len(mounted.position) != 3:
        text = f"the offset of the gripper {gripper.name} needs 3 numbers, not {len(mounted.position)}"
        raise PoseError(text, origin=source.origin)
    if not is_rotation(mounted.rotation):
        raise PoseError(f"the orientation of the gripper {gripper.name} is not a rotation", origin=source.origin)
    carrier = body_of(spec, source, mounted.mount, "gripper")
    beyond = [str(joint.name) for body in carrier.find_all("body") for joint in body.joints]
    if beyond:
        text = f"'{mounted.mount}' of {source.name} carries the joints {', '.join(beyond)}"
        raise SceneError(f"{text}: fix the gripper to the end of the arm", origin=source.origin)
    child = load(gripper)
    changes: list[str] = []
    if gripper.format == "urdf":
        changes = give_mass(child, massless_links(path_of(gripper)))
        child.compiler.balanceinertia = True
    name_parts(child)
    changes = [*leave_out_scene(child, gripper), *changes]
    for body in child.worldbody.bodies:
        for joint in [one for one in body.joints if one.type == mujoco.mjtJoint.mjJNT_FREE]:
            child.delete(joint)
    for key in list(child.keys):
        child.delete(key)
    place, turn = _pose(compiled(spec, source), mounted)
    # A body of its own keeps the mass of shapes that are fixed to the world of the gripper's file.
    mount = carrier.add_body(name=MOUNT, pos=place, quat=turn)
    spec.attach(child, prefix=PREFIX, frame=mount.add_frame())
    return changes


def gripper_of(source: ModelSource) -> ModelSource | None:
    """Return the file of the gripper that is mounted on an arm, ``None`` without one; its text says its format."""
    gripper = source.gripper
    if gripper is None:
        return None
    path = path_of(gripper)
    return replace(gripper, format="urdf" if path.is_file() and is_urdf(path) else "mjcf")


def _pose(model: Any, mounted: MountedGripper) -> tuple[FloatArray, FloatArray]:
    """Return the position (m) and rotation (quaternion) of a mounted gripper in the frame of the body that carries it.

    ``model`` is the arm without it.
    """
    place, turn = np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0])
    number = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, mounted.mount)
    if number >= 0:
        place, turn = model.site_pos[number], model.site_quat[number]
    found, turned = np.zeros(3), np.zeros(4)
    mujoco.mju_mulPose(found, turned, place, turn, np.array(mounted.position), np.array(mounted.rotation))
    return found, turned
