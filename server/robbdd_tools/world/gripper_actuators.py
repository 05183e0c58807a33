"""Find, couple or add the actuators of grippers in users' model files."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.catalog.executable import ModelEntry
from robbdd_tools.world.coupled_joints import RIGID, stiffen
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.gripper_faces import length_of
from robbdd_tools.world.gripper_names import name_in_file

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.catalog.executable import ArmModel, ModelSource

GRIP_FORCE = 15.0
"""Force (N) of each finger of a gripper whose file has no actuator and states no effort."""
STRONGEST = 200.0
"""Efforts with which a finger would press harder (N) stand for none: electric grippers of such arms are weaker."""
YIELD, GRIP_TIME = 0.005, 0.02
"""An added servo presses with its whole force from this error (m) on, and is damped with this time constant (s)."""
ROTOR = 1.6
"""The inertia of a finger with an added servo is at least its stiffness times the squared time step times this."""
SUCTION_FORCE = 42.0
"""Pull (N) of a suction cup whose file has no actuator: the same as of the catalog's cup."""


class GripperParts:
    """The parts of a gripper in the engine's editable description of an arm: ``palm`` and all bodies that it carries.

    Errors end with ``note``.
    """

    def __init__(self, spec: Any, source: ModelSource, arm: ArmModel, palm: str, note: str = "") -> None:
        self.spec = spec
        self.source = source
        self.arm = arm
        self.palm = palm
        self._note = note
        self.added: set[str] = set()
        """Names of added actuators."""
        self.changes: list[str] = []
        """Assumptions about the gripper, as lines for a report."""

    @property
    def bodies(self) -> list[Any]:
        """The palm and all bodies that it carries."""
        palm = self.spec.body(self.palm)
        return [palm, *palm.find_all("body")]

    @property
    def joints(self) -> list[Any]:
        """The joints of the fingers."""
        return [joint for body in self.bodies[1:] for joint in body.joints]

    def error(self, text: str, keyword: str = "") -> SceneError:
        """Return an error about the gripper; ``keyword`` names the wrong entry of the model, if any."""
        entry = ModelEntry(keyword) if keyword else None
        reason = f"the gripper of {self.source.name} {text}{self._note}"
        return SceneError(reason, origin=self.source.origin, entry=entry)

    def compiled(self) -> Any:
        """Return the compiled model of the arm. Raises ``SceneError``."""
        try:
            return self.spec.copy().compile()
        except ValueError as error:
            words = " ".join(str(error).split())  # the engine's messages have several lines
            reason = f"the model {self.source.name} does not compile: {words}"
            raise SceneError(reason, origin=self.source.origin) from error

    def name_geoms(self) -> None:
        """Name every collision shape of the gripper, so that it can be a gripping face."""
        for number, geom in enumerate(geom for body in self.bodies for geom in body.geoms):
            if (geom.contype or geom.conaffinity) and not geom.name:
                geom.name = f"robbdd-face{number}"


class GripperActuator:
    """Finds the actuator of a gripper."""

    def __init__(self, parts: GripperParts) -> None:
        self._parts = parts
        self._spec = parts.spec
        self._source = parts.source
        self._arm = parts.arm

    def find(self) -> Any:
        """Return the gripper's actuator. Add one for a joint without an actuator; couple several."""
        name = self._arm.actuator
        if name:
            found = self._spec.actuator(name)
            if found is None and self._spec.joint(name) is None:
                raise self._parts.error(
                    f"has no actuator or joint '{name_in_file(name)}': the file has {_known(self._spec)}"
                )
            return found or self._servo(self._spec.joint(name))
        found = [one for one in self._spec.actuators if self._is_behind(one)]
        if found:
            return self._coupled(found)
        free = [joint for joint in self._parts.joints if not self._follows(joint)]
        if free:
            return self._coupled([self._servo(joint) for joint in free])
        if len(self._arm.pads) == 1:
            return self._vacuum(self._arm.pads[0])
        if self._arm.mounted is not None:
            raise self._parts.error('has no joints and no actuators: name the face of a suction cup, pads: "cup"')
        lacks = f"beyond the body '{self._parts.palm}', the file has no joints and no actuators"
        ways = (
            "Name a file with both",
            'fix a gripper to it, gripper { sys path = "FILE" on: "BODY OR SITE" }',
            'or name the face of a suction cup, gripper { pads: "cup" stroke: 30 mm }',
        )
        text = f"the arm in {self._source.name} has no gripper: {lacks}. {', '.join(ways)}"
        raise SceneError(text, origin=self._source.origin)

    def _is_behind(self, actuator: Any) -> bool:
        """Return whether an actuator drives a part of the gripper."""
        behind = {joint.name for joint in self._parts.joints}
        match actuator.trntype:
            case mujoco.mjtTrn.mjTRN_JOINT:
                return str(actuator.target) in behind
            case mujoco.mjtTrn.mjTRN_BODY:
                return any(body.name == actuator.target for body in self._parts.bodies)
            case mujoco.mjtTrn.mjTRN_TENDON:
                return self._wraps(str(actuator.target), behind)
            case _:
                return False

    def _wraps(self, tendon: str, behind: set[str]) -> bool:
        model = self._parts.compiled()
        number = model.tendon(tendon).id
        start = int(model.tendon_adr[number])
        wraps = range(start, start + int(model.tendon_num[number]))
        joints = [int(model.wrap_objid[i]) for i in wraps if model.wrap_type[i] == int(mujoco.mjtWrap.mjWRAP_JOINT)]
        sites = [int(model.wrap_objid[i]) for i in wraps if model.wrap_type[i] == int(mujoco.mjtWrap.mjWRAP_SITE)]
        own = {body.name for body in self._parts.bodies}
        return any(model.joint(joint).name in behind for joint in joints) or any(
            model.body(int(model.site_bodyid[site])).name in own for site in sites
        )

    def _follows(self, joint: Any) -> bool:
        """Return whether an equality constraint makes a joint follow another one."""
        return any(one.type == mujoco.mjtEq.mjEQ_JOINT and one.name1 == joint.name for one in self._spec.equalities)

    def _servo(self, joint: Any) -> Any:
        """Add a position servo to a finger's joint."""
        lever = 1.0
        if joint.type == mujoco.mjtJoint.mjJNT_HINGE:
            lever = max(0.02, length_of(self._parts.compiled(), str(joint.name)))
        servo = self._spec.add_actuator(name=joint.name, target=joint.name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        _strengthen(servo, GRIP_FORCE * lever, YIELD / lever)
        servo.ctrlrange, servo.ctrllimited = joint.range, True
        self._parts.added.add(str(servo.name))
        return servo

    def _vacuum(self, name: str) -> Any:
        geom = gripping_face(self._spec, self._source, name)
        actuator = self._spec.add_actuator(name="robbdd-vacuum", target=geom.parent.name)
        actuator.trntype = mujoco.mjtTrn.mjTRN_BODY
        actuator.gainprm[0] = SUCTION_FORCE
        actuator.ctrlrange, actuator.ctrllimited = [0.0, 1.0], True
        return actuator

    def _coupled(self, actuators: Sequence[Any]) -> Any:
        """Return the first of several actuators after coupling: it moves all fingers with the force of all of them."""
        first, *others = actuators
        if others and any(one.trntype != mujoco.mjtTrn.mjTRN_JOINT for one in actuators):
            names = ", ".join(str(one.name) for one in actuators)
            raise self._parts.error(
                f'has several actuators ({names}): name the one that closes it, gripper {{ actuator: "…" }}'
            )
        leader = self._spec.joint(first.target)
        for other in others:
            follower = self._spec.joint(other.target)
            mirrored = _is_mirrored(first.ctrlrange, other.ctrlrange) or _is_opposite(leader.range, follower.range)
            if not self._follows(follower):
                equality = self._spec.add_equality(type=mujoco.mjtEq.mjEQ_JOINT)
                equality.name1, equality.name2 = follower.name, leader.name
                equality.objtype = mujoco.mjtObj.mjOBJ_JOINT
                equality.data[:5] = [0.0, -1.0 if mirrored else 1.0, 0.0, 0.0, 0.0]
                if first.name in self._parts.added:
                    equality.solref = RIGID
                # The constraint is stiffer than a limit: it would push the other finger beyond its range.
                leader.range = _common(leader.range, -follower.range[::-1] if mirrored else follower.range)
            self._spec.delete(other)
        if others:
            share = 1.0 + len(others)
            first.gainprm, first.biasprm = first.gainprm * share, first.biasprm * share
            first.forcerange = first.forcerange * share
        return first


def press(parts: GripperParts, actuator: Any, lever: float, faces: int) -> None:
    """Let each finger of a gripper press with the effort that its file states, if this program has added the servo.

    The joint moves by ``lever`` (1, rad/m) per metre of a finger's way, and drives ``faces`` gripping faces. Without a
    plausible effort, ``GRIP_FORCE`` is assumed, and the report says so.
    """
    if actuator.name not in parts.added:
        return
    joint = parts.spec.joint(str(actuator.target))
    stated = float(joint.actfrcrange[1]) * lever
    force = stated if 0.0 < stated <= STRONGEST else GRIP_FORCE
    if force != stated:
        words = "the file states no effort of its fingers"
        if stated > 0.0:
            words = (
                f"with the effort in the file, the fingers would press with {stated:.3g} N, more than such grippers do"
            )
        parts.changes.append(f"{words}: the grip is assumed")
    _strengthen(actuator, faces * force / lever, YIELD * lever)
    # The force of all fingers acts through this joint.
    joint.actfrcrange, joint.actfrclimited = [0.0, 0.0], False
    rotor = ROTOR * float(actuator.gainprm[0]) * float(parts.spec.option.timestep) ** 2
    ties = [one for one in parts.spec.equalities if one.type == mujoco.mjtEq.mjEQ_JOINT and one.name2 == joint.name]
    if parts.source.format == "urdf":
        stiffen(parts.spec, [str(one.name1) for one in ties])
    for finger in (joint, *(parts.spec.joint(str(one.name1)) for one in ties)):
        finger.armature = max(float(finger.armature), rotor)


def _strengthen(servo: Any, force: float, error: float) -> None:
    """Set the largest force (N, N m) of a position servo, which it exerts from an ``error`` (m, rad) on."""
    servo.set_to_position(kp=force / error, kv=GRIP_TIME * force / error)
    servo.forcerange, servo.forcelimited = [-force, force], True


def gripping_face(spec: Any, source: ModelSource, name: str) -> Any:
    """Return the gripping face ``name``: a geom, or the first collision shape of a body. Raises ``SceneError``."""
    geom = spec.geom(name)
    if geom is not None:
        return geom
    body = spec.body(name)
    touching = [] if body is None else [one for one in body.geoms if one.contype or one.conaffinity]
    if not touching:
        known = f"it has the geoms {_names(spec.geoms)} and the bodies {_names(spec.bodies[1:])}"
        raise SceneError(f"{source.name} has no gripping face '{name_in_file(name)}'; {known}", origin=source.origin)
    touching[0].name = touching[0].name or name
    if source.format == "urdf":
        make_rubber(touching[0])
    return touching[0]


def make_rubber(face: Any) -> None:
    """Make a gripping face stiff and rough like rubber: URDF does not describe contacts, and light objects slip out."""
    face.condim, face.friction = 4, [0.9, 0.01, 0.001]
    face.solref, face.solimp = [0.005, 1.0], [0.95, 0.99, 0.001, 0.5, 2.0]


def _is_mirrored(one: FloatArray, other: FloatArray) -> bool:
    """Return whether two ranges of values are opposite, like for two fingers that move in opposite directions."""
    return bool(one[0] != one[1] and abs(one[0] + other[1]) + abs(one[1] + other[0]) < 1e-6 and one[0] != other[0])


def _is_opposite(one: FloatArray, other: FloatArray) -> bool:
    """Return whether two ranges of joints are mirrored, or on different sides of zero, where both fingers begin."""
    above, below = (one, other) if one[0] >= other[0] else (other, one)
    return _is_mirrored(one, other) or bool(below[0] < below[1] <= 0.0 <= above[0] < above[1])


def _common(one: FloatArray, other: FloatArray) -> FloatArray:
    """Return what two ranges have in common; the first one if one has no limits or they have nothing in common."""
    low, high = max(one[0], other[0]), min(one[1], other[1])
    return np.array([low, high]) if low < high else one


def _names(things: Any) -> str:
    return ", ".join(name_in_file(str(thing.name)) for thing in things if thing.name) or "none"


def _known(spec: Any) -> str:
    return f"the actuators {_names(spec.actuators)} and the joints {_names(spec.joints)}"
