"""Place the tool of an arm from a file: where its fingers meet, with z out of the hand."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.catalog.api import GripperKind
from robbdd_tools.world.coupled_joints import coupled_by_name
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.hand_direction import BETWEEN_FINGERS
from robbdd_tools.world.mesh_pieces import HIDDEN
from robbdd_tools.world.model_files import compiled

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.catalog.executable import ModelSource
    from robbdd_tools.world.gripper_files import FoundGripper

TOOL = "robbdd-tool"
ALIGNED = np.cos(np.radians(5.0))
"""The y axis of a stated tool is kept if the cosine of its angle to the closing direction is at least this."""
OUTWARDS = np.cos(np.radians(30.0))
"""The z axis of a stated tool is kept if the cosine of its angle to the direction out of the hand is at least this."""


def tool_of(spec: Any, source: ModelSource, stated: str, gripper: FoundGripper, palm: Any) -> str:
    """Return the name of the tool's site, with z out of the hand and y along the closing direction.

    A stated site or body with these axes is kept; any other one gives only the place. The palm itself, whose frame is
    usually far from the tips, only says which of several hands is meant.
    """
    site, body = (spec.site(stated), spec.body(stated)) if stated else (None, None)
    if site is None and body is not None and not _only_names_the_hand(stated, gripper, palm):
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
            along = float(axes[:, 1] @ across)
            if is_cup or (along if gripper.one_sided else abs(along)) >= ALIGNED:
                return stated
    across = across - (across @ ahead) * ahead
    across /= np.linalg.norm(across)
    frame = np.column_stack([np.cross(across, ahead), across, ahead if kept is None else kept])
    quaternion: FloatArray = np.empty(4)
    mujoco.mju_mat2Quat(quaternion, frame.ravel())
    palm.add_site(name=TOOL, pos=place, quat=quaternion, group=HIDDEN)
    return TOOL


def _only_names_the_hand(stated: str, gripper: FoundGripper, palm: Any) -> bool:
    """Return whether a stated tool is the palm, with its frame far from the tips."""
    if stated != palm.name:
        return False
    return bool(np.linalg.norm(gripper.middle) > BETWEEN_FINGERS)


def face_ahead(spec: Any, model: Any, joints: tuple[str, ...], home: tuple[float, ...]) -> None:
    """Turn a found tool by half a turn if its x axis then points ahead at home.

    The fingers are interchangeable; with x ahead, the wrist can turn as far to one side as to the other.
    """
    data: Any = mujoco.MjData(model)
    for joint, value in zip(joints, home, strict=True):
        data.qpos[model.joint(joint).qposadr[0]] = value
    coupled_by_name(model, joints).place(data.qpos)
    mujoco.mj_kinematics(model, data)
    site = spec.site(TOOL)
    place, ahead = data.site(TOOL).xpos, data.site(TOOL).xmat[0::3]
    if place[:2] @ ahead[:2] < 0.0:
        turned: FloatArray = np.empty(4)
        mujoco.mju_mulQuat(turned, np.array(site.quat), np.array([0.0, 0.0, 0.0, 1.0]))
        site.quat = turned
