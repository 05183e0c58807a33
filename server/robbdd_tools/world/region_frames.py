"""The frames of workspaces whose boxes are turned in the frame of the object that carries them."""

from __future__ import annotations

from dataclasses import replace
from math import atan2
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.pose import Pose

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray, Region

SAME = 1e-6
"""Rounding of the entries of a rotation matrix."""


def along_edges(place: tuple[FloatArray, FloatArray], region: Region) -> tuple[FloatArray, FloatArray]:
    """Return origin (m) and rotation matrix of a carrier as if it were turned like a region about the region's centre.

    There, the edges of the region are along the axes, and its centre has the same coordinates.
    """
    if not region.turn:
        return place
    position, rotation = place
    center, turned = np.array(region.center), rotation @ matrix_of(region.turn)
    return position + rotation @ center - turned @ center, turned


def pose_along_edges(pose: Pose, region: Region) -> Pose:
    """Return the same for the pose of a carrier."""
    if not region.turn:
        return pose
    own = np.array(pose.rotation or [np.cos(pose.yaw / 2), 0.0, 0.0, np.sin(pose.yaw / 2)])
    whole: FloatArray = np.empty(4)
    mujoco.mju_mulQuat(whole, own, np.array(region.turn))
    rotation = matrix_of(whole.tolist())
    upright = not pose.rotation and abs(rotation[2, 2] - 1.0) < SAME
    turned = replace(pose, yaw=atan2(rotation[1, 0], rotation[0, 0]), rotation=() if upright else tuple(whole.tolist()))
    way = np.subtract(pose.at(region.center).position, turned.at(region.center).position)
    x, y, z = np.add(pose.position, way).tolist()
    return replace(turned, position=(x, y, z))


def box_of(half: FloatArray, rotation: FloatArray) -> tuple[FloatArray, tuple[float, ...]]:
    """Return half edges (m) and the ``turn`` of a box that a rotation matrix turns in the frame of its carrier.

    Of its edges, the one nearest to the vertical is along z. A box turned by quarters needs no turn.
    """
    up = int(np.argmax(np.abs(rotation[2])))
    order = [(up + 1) % 3, (up + 2) % 3, up]
    axes, edges = rotation[:, order], half[order]
    if axes[2, 2] < 0.0:
        axes = axes * [1.0, -1.0, -1.0]
    if (np.abs(axes).max(axis=0) > 1.0 - SAME).all():
        return np.abs(axes) @ edges, ()
    turn: FloatArray = np.empty(4)
    mujoco.mju_mat2Quat(turn, np.ascontiguousarray(axes).ravel())
    return edges, tuple(turn.tolist())


def bounds_of_box(region: Region) -> FloatArray:
    """Return half the edges (m) of the box around a region along the axes of its carrier's frame."""
    half = np.array(region.half)
    return np.abs(matrix_of(region.turn)) @ half if region.turn else half


def matrix_of(turn: tuple[float, ...] | list[float]) -> FloatArray:
    """Return the rotation matrix of a unit quaternion (w, x, y, z)."""
    matrix: FloatArray = np.empty(9)
    mujoco.mju_quat2Mat(matrix, np.array(turn))
    return matrix.reshape(3, 3)
