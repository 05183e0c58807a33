"""Compose, place and read the joints of the moving parts of objects in a world."""

from __future__ import annotations

from dataclasses import replace
from math import degrees
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.base.articulation import Opening, OpeningRecord
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.owners import joint_of_part
from robbdd_tools.world.pose import Pose

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from robbdd_tools.catalog.api import FloatArray, ObjectModel


STICKING = (0.004, 1.0), (0.9999, 0.9999, 0.001, 0.5, 2.0)
"""Parameters of dry friction in a joint. With the engine's own ones, a joint of 20 N creeps at 14 mm/s under 8 N."""


def add_joint(spec: Any, body: Any, name: str, model: ObjectModel) -> None:
    """Add the joint of a moving part to its body. The part does not collide with the body that carries it.

    The shapes of both usually touch or overlap at the joint. The joint's range stops the part, as in the file.
    """
    joint = model.joint
    assert joint is not None, "a moving part has a joint"
    kinds = mujoco.mjtJoint
    made = body.add_joint(
        name=joint_of_part(name), type=kinds.mjJNT_SLIDE if joint.kind == "slide" else kinds.mjJNT_HINGE
    )
    unit = degrees(1.0) if joint.kind == "hinge" and spec.compiler.degree else 1.0
    made.axis, made.pos = list(joint.axis), np.add(joint.anchor, model.frame)
    made.ref, made.springref = unit * joint.zero, unit * joint.rest
    made.frictionloss, made.armature = joint.friction, joint.armature
    made.solref_friction, made.solimp_friction = STICKING
    # The engine takes polynomials; the files of users have linear springs and dampers.
    made.damping, made.stiffness = [joint.damping, 0.0, 0.0], [joint.stiffness, 0.0, 0.0]
    made.limited = mujoco.mjtLimited.mjLIMITED_TRUE if joint.bounds else mujoco.mjtLimited.mjLIMITED_FALSE
    if joint.bounds:
        made.range = [unit * end for end in joint.bounds]
    if joint.parent:
        spec.add_exclude(bodyname1=name, bodyname2=joint.parent)


def pose_at_zero(model: ObjectModel, carrier: ObjectModel) -> Pose:
    """Return the pose of a moving part's body in the frame of the body that carries it, as in the file."""
    joint = model.joint
    assert joint is not None, "a moving part has a joint"
    place: FloatArray = np.array(joint.position) + carrier.frame
    return Pose(_three(place), 0.0, joint.rotation).at(_three(-np.array(model.frame)))


def initial_pose(model: ObjectModel, carrier: ObjectModel, carried_at: Pose) -> Pose:
    """Return the initial world pose of a moving part whose carrier is at the world pose ``carried_at``."""
    joint, here = model.joint, pose_at_zero(model, carrier)
    assert joint is not None, "a moving part has a joint"
    way, anchor = joint.start - joint.zero, np.add(joint.anchor, model.frame)
    own = np.array(here.rotation)
    if joint.kind == "slide":
        here = here.at(_three(way * np.array(joint.axis)))
    else:
        turn, turned = np.zeros(4), np.zeros(3)
        mujoco.mju_axisAngle2Quat(turn, np.array(joint.axis), way)
        mujoco.mju_rotVecQuat(turned, anchor, turn)
        here = here.at(_three(anchor - turned))
        mujoco.mju_mulQuat(own, np.array(here.rotation), turn)
    base, whole = np.zeros(4), np.zeros(4)
    base[:] = carried_at.rotation or (np.cos(carried_at.yaw / 2), 0.0, 0.0, np.sin(carried_at.yaw / 2))
    mujoco.mju_mulQuat(whole, base, own)
    w, x, y, z = (float(part) for part in whole)
    yaw = float(np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))
    return Pose(carried_at.at(here.position).position, yaw, (w, x, y, z))


def ways_of_parts(
    objects: Mapping[str, ObjectModel], poses: Mapping[str, Pose]
) -> Iterator[tuple[str, Pose, ObjectModel]]:
    """Yield each moving part of the catalog's models: its name, and its closed and its open pose in the world."""
    for name, model in objects.items():
        joint = model.joint
        if joint is not None and joint.bounds is not None and joint.parent and objects[joint.parent].moving:
            for end in joint.bounds:
                there = replace(model, joint=replace(joint, start=end))
                yield name, initial_pose(there, objects[joint.parent], poses[joint.parent]), model


def opening_records(
    model: Any, openings: Mapping[str, Opening | str], states: FloatArray
) -> dict[str, OpeningRecord | str]:
    """Return how far things were open at each of the engine's states (n, q), or why this is not known."""
    return {
        name: opening
        if isinstance(opening, str)
        else OpeningRecord(
            opening.kind,
            opening.closed,
            opening.open,
            states[:, int(model.joint(joint_of_part(opening.part)).qposadr[0])].copy(),
        )
        for name, opening in openings.items()
    }


def _three(numbers: FloatArray) -> tuple[float, float, float]:
    x, y, z = (float(number) for number in numbers)
    return (x, y, z)
