"""Grippers of users' model files: find actuator, gripping faces and opening by simulating the file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.catalog.api import GripperKind
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.engine_faults import strict
from robbdd_tools.world.errors import SimulationError
from robbdd_tools.world.finger_opening import Opening
from robbdd_tools.world.finger_sweep import SETTLING, joints_beside, lever_of, move_alone, swept
from robbdd_tools.world.gripper_actuators import GripperActuator, GripperParts, gripping_face, make_rubber, press
from robbdd_tools.world.gripper_faces import MOVES, extent, gap, meeting_faces
from robbdd_tools.world.hand_direction import finger_frame, jaw_frame, outwards
from robbdd_tools.world.mesh_pieces import CUT
from robbdd_tools.world.model_meshes import hollow_meshes

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

CONTRADICTION = 0.25
"""A stated stroke may differ from the measured one by this share."""
SLACK = 1e-6
"""A stated value may be this far outside the actuator's range, because files round."""
LONGEST = (SETTLING - 1) * 0.002
"""A gripper that moves for this time (s) does not come to rest."""
TIP = 0.015
"""The tool is this far (m) from the ends of the gripping faces: half the length of usual pads."""


@dataclass(frozen=True, slots=True)
class FoundGripper:
    """A gripper in a model file.

    - ``faces``: the names of the geoms of each gripping face.
    - ``open`` and ``closed``: values of the ``actuator``.
    - ``stroke``: the widest opening (m), or the diameter of a suction cup.
    - ``rate``: change of the actuator's value per metre that a finger moves.
    - ``settling``: how long (s) the fingers take from one end to the other.
    - ``open_joints``: the positions of the gripper's joints when it is open.
    - ``sweep``: pairs for rotating fingers, from open to closed: the opening (m), and how far (m) the fingers then
      reach beyond the tool.
    - ``one_sided``: whether the second face does not move: one jaw closes on the hand.
    - ``narrowest``: distance (m) of the faces when the gripper is closed.
    - ``lever``: change of the actuator's length (m, rad) per metre that a finger moves.
    - ``middle``, ``across``, ``ahead``: the place (m) between the tips of the closed fingers, the closing direction,
      and the direction out of the hand, in the frame of the palm, shape (3,) each.
    """

    kind: GripperKind
    actuator: str
    faces: tuple[tuple[str, ...], ...]
    open: float
    closed: float
    stroke: float
    rate: float
    settling: float
    open_joints: tuple[tuple[str, float], ...]
    middle: FloatArray
    across: FloatArray
    ahead: FloatArray
    sweep: tuple[tuple[float, float], ...] = ()
    one_sided: bool = False
    narrowest: float = 0.0
    lever: float = 1.0

    @property
    def pads(self) -> tuple[str, ...]:
        """The geoms of all gripping faces."""
        return tuple(geom for face in self.faces for geom in face)


class GripperReader:
    """Reads the gripper of an arm; its description is completed where necessary."""

    def __init__(self, parts: GripperParts) -> None:
        self._parts = parts
        self._source = parts.source
        self._arm = parts.arm
        self._palm = parts.palm
        self._settling = 0.0

    def read(self) -> FoundGripper:
        """Return the gripper. Raises ``SceneError``."""
        actuator = GripperActuator(self._parts).find()
        if actuator.trntype == mujoco.mjtTrn.mjTRN_BODY:
            return self._cup(actuator)
        low, high = self._controls(actuator)
        model = self._parts.compiled()
        states = {control: self._settled(model, actuator, control) for control in (low, high)}
        faces = self._moving_first(model, self._given_faces(model) or self._found_faces(model, states))
        gaps = {control: gap(model, state, faces) for control, state in states.items()}
        opened, closed = self._senses(gaps)
        return self._fingers(model, actuator, faces, (opened, closed), states, gaps)

    def _controls(self, actuator: Any) -> tuple[float, float]:
        """Return the two ends of the actuator's range, as stated or from the file."""
        opened, closed = self._arm.open, self._arm.closed
        low, high = (float(value) for value in actuator.ctrlrange)
        if opened is None and closed is None and low >= high:
            raise self._parts.error(
                f"has an actuator '{actuator.name}' without a 'ctrlrange': state its values open and close"
            )
        if opened is None:
            opened = low if closed == high else high
        if closed is None:
            closed = low if opened == high else high
        if opened == closed:
            keyword = "close" if self._arm.closed is not None else "open"
            raise self._parts.error(f"is open and closed at the same value, {opened:g}", keyword)
        self._refuse_outside(actuator)
        return min(opened, closed), max(opened, closed)

    def _refuse_outside(self, actuator: Any) -> None:
        """Raise ``SceneError`` if a stated value is outside the actuator's range: the engine would clamp it."""
        model = self._parts.compiled()
        number = model.actuator(actuator.name).id
        low, high = (float(bound) for bound in model.actuator_ctrlrange[number])
        for keyword, value in (("open", self._arm.open), ("close", self._arm.closed)):
            if value is not None and model.actuator_ctrllimited[number] and not low - SLACK <= value <= high + SLACK:
                text = f"has an actuator '{actuator.name}' that takes values from {low:g} to {high:g}"
                raise self._parts.error(f"{text}: '{keyword}' cannot be {value:g}", keyword)

    def _senses(self, gaps: dict[float, float]) -> tuple[float, float]:
        """Return the values that open and close the gripper. Raises ``SceneError`` if they contradict the file."""
        opened, closed = sorted(gaps, key=lambda control: -gaps[control])
        stated = self._arm.open, self._arm.closed
        described = "; ".join(f"{gaps[control]:.3f} m between its faces at {control:g}" for control in (opened, closed))
        if gaps[opened] - gaps[closed] < MOVES:
            raise self._parts.error(f"does not move its faces: {described}. Name other pads or another actuator")
        if stated[0] not in (None, opened) or stated[1] not in (None, closed):
            raise self._parts.error(f"has 'open' and 'close' reversed: {described}", "open")
        return opened, closed

    def _stroke(self, measured: float) -> float:
        """Return the stroke (m). Raises ``SceneError`` if the stated one contradicts the measured one."""
        stated = self._arm.stroke
        if stated and abs(stated - measured) > CONTRADICTION * measured:
            raise self._parts.error(f"opens {measured:.3f} m, not the stated stroke of {stated:.3f} m", "stroke")
        return stated or measured

    def _face(self, name: str) -> Any:
        return gripping_face(self._parts.spec, self._source, name)

    def _given_faces(self, model: Any) -> tuple[tuple[str, ...], ...]:
        names = [str(self._face(pad).name) for pad in self._arm.pads]
        if any(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, name) < 0 for name in names):
            raise self._parts.error("has gripping faces without a collision shape")
        return tuple((name,) for name in names)

    def _moving_first(self, model: Any, faces: tuple[tuple[str, ...], ...]) -> tuple[tuple[str, ...], ...]:
        """Return the faces with one that is part of the hand last."""
        return tuple(sorted(faces, key=lambda face: self._is_fixed(model, face)))

    def _is_fixed(self, model: Any, face: tuple[str, ...]) -> bool:
        """Return whether a face is part of the hand."""
        hand = int(model.body_weldid[model.body(self._palm).id])
        return int(model.body_weldid[int(model.geom_bodyid[model.geom(face[0]).id])]) == hand

    def _found_faces(self, model: Any, states: dict[float, FloatArray]) -> tuple[tuple[str, ...], ...]:
        bodies = [int(model.body(body.name).id) for body in self._parts.bodies]
        faces = meeting_faces(model, bodies, states)
        if not faces:
            hollow = hollow_meshes(model, bodies)
            why = f". A hollow mesh collides as its convex hull; {CUT}" if hollow else ""
            if self._settling >= LONGEST:
                why += f". It does not come to rest within {LONGEST:.0f} s: check the masses and drives of its fingers"
            raise self._parts.error(f"has no two parts that meet when it closes: name its pads{why}")
        if self._source.format == "urdf":
            for name in (name for face in faces for name in face):
                make_rubber(self._parts.spec.geom(name))
        return faces

    def _settled(self, model: Any, actuator: Any, control: float) -> FloatArray:
        """Return the joint positions of the whole model after the gripper has moved to an actuator value."""
        data = mujoco.MjData(model)
        model.opt.gravity[:] = 0.0
        model.opt.timestep = 0.002
        model.opt.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
        model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
        places, speeds = joints_beside(self._parts, model)
        data.ctrl[model.actuator(actuator.name).id] = control
        try:
            with strict(model, data):
                step = move_alone(model, data, places, speeds)
        except SimulationError as error:
            raise self._parts.error(f"cannot be simulated: {error}") from error
        self._settling = max(self._settling, step * float(model.opt.timestep))
        if not np.all(np.isfinite(data.qpos)):
            raise self._parts.error("is unstable: its actuator moves it to infinity")
        return data.qpos.copy()

    def _fingers(
        self,
        model: Any,
        actuator: Any,
        faces: tuple[tuple[str, ...], ...],
        controls: tuple[float, float],
        states: dict[float, FloatArray],
        gaps: dict[float, float],
    ) -> FoundGripper:
        opened, closed = controls
        one_sided = self._is_fixed(model, faces[1])
        palm = model.body(self._palm).id
        ends = states[closed], states[opened]
        middle, across, ahead = (jaw_frame if one_sided else finger_frame)(model, palm, faces, *ends)
        data = mujoco.MjData(model)
        data.qpos[:] = states[closed]
        mujoco.mj_kinematics(model, data)
        place, turn = data.xpos[palm], data.xmat[palm].reshape(3, 3)
        reached = [extent(model, data, name, ahead) for face in faces[:2] for name in face]
        bottom, top = min(low for low, _ in reached), max(high for _, high in reached)
        depth = top - min(TIP, (top - bottom) / 2)
        middle = middle + (depth - middle @ ahead) * ahead
        behind = [str(joint.name) for joint in self._parts.joints]
        positions = tuple((name, float(states[opened][model.joint(name).qposadr[0]])) for name in behind)
        opening = Opening(self._parts.spec, faces, middle, ahead)
        if one_sided:
            middle = middle - opening.to_second(states[closed]) * across
            opening = Opening(self._parts.spec, faces, middle, ahead)
        sweep = swept(self._parts, (model, actuator), opening, (states[opened], closed), (ahead, depth))
        widest = opening.at(states[opened])
        if one_sided:
            widest = max([widest, *(one.width for one in sweep)])
        stroke = self._stroke(widest)
        moving = 1 if one_sided else 2
        travel = (widest - max(0.0, gaps[closed])) / moving
        lever = moving * lever_of(model, actuator, ends, (widest, max(0.0, gaps[closed])), sweep)
        press(self._parts, actuator, lever, moving)
        return FoundGripper(
            GripperKind.PARALLEL,
            str(actuator.name),
            faces,
            opened,
            closed,
            stroke,
            abs(opened - closed) / travel,
            self._settling,
            positions,
            turn.T @ (middle - place),
            turn.T @ across,
            turn.T @ ahead,
            tuple((one.width, one.beyond) for one in sweep),
            one_sided,
            max(0.0, gaps[closed]),
            lever,
        )

    def _cup(self, actuator: Any) -> FoundGripper:
        body = self._parts.spec.body(str(actuator.target))
        touching = [geom for geom in body.geoms if geom.contype or geom.conaffinity]
        if not touching and not self._arm.pads:
            raise self._parts.error(f"is a suction cup without a collision shape: '{body.name}' has none")
        face = self._face(self._arm.pads[0]) if self._arm.pads else touching[-1]
        model = self._parts.compiled()
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        geom, palm = model.geom(face.name).id, model.body(self._palm).id
        turn = data.xmat[palm].reshape(3, 3)
        place = data.geom_xpos[geom]
        axes = data.geom_xmat[geom].reshape(3, 3)
        axis = outwards(model, data, palm, place, axes[:, 2])
        _, high = extent(model, data, str(face.name), axis)
        size = model.geom_size[geom]
        low_control, high_control = (float(value) for value in actuator.ctrlrange)
        self._refuse_outside(actuator)
        opened = self._arm.open if self._arm.open is not None else low_control
        closed = self._arm.closed if self._arm.closed is not None else (high_control or 1.0)
        return FoundGripper(
            GripperKind.SUCTION,
            str(actuator.name),
            ((str(face.name),),),
            opened,
            closed,
            self._arm.stroke or 2 * float(size[0]),
            1.0,
            0.0,
            (),
            turn.T @ (place + (high - place @ axis) * axis - data.xpos[palm]),
            turn.T @ axes[:, 0],
            turn.T @ axis,
        )
