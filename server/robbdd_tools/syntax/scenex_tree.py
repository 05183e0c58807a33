"""Syntax trees of executable scenes: distributions, models, sensors and scene instances."""

from __future__ import annotations

from dataclasses import dataclass

from robbdd_tools.syntax.kinematics_tree import DirectionCosines, Euler, Graph, Quaternion, Vector
from robbdd_tools.syntax.scene_tree import (
    CatalogEntry,
    Name,
    NamespaceArgument,
    Node,
    Number,
    PythonAttribute,
    Ref,
    Text,
)


@dataclass(frozen=True, slots=True)
class Uniform(Node):
    """``uniform { dimension lower upper }``."""

    dimension: Number
    lower: Vector | Number
    upper: Vector | Number


@dataclass(frozen=True, slots=True)
class UniformRotation(Node):
    """``uniform-rotation``."""


@dataclass(frozen=True, slots=True)
class Normal(Node):
    """``normal { dimension mean … }``; ``spread`` is a covariance matrix or a standard deviation."""

    dimension: Number
    mean: Vector | Number
    spread: Vector | Number


@dataclass(frozen=True, slots=True)
class Distribution(Node):
    """``distrib (ns=…) name { … }``."""

    namespace: NamespaceArgument
    name: Name
    law: Uniform | UniformRotation | Normal


@dataclass(frozen=True, slots=True)
class SystemPath(Node):
    """``sys path = '…'``: relative to the file; ``~`` is the user's home folder."""

    path: Text


@dataclass(frozen=True, slots=True)
class RosPath(Node):
    """``ros pkg = '…', path = '…'``."""

    package: Text
    path: Text


ModelSource = SystemPath | RosPath | PythonAttribute | CatalogEntry


@dataclass(frozen=True, slots=True)
class Mapping(Node):
    """``map body <…> to "…"`` or ``map tree <…> to "…"``. Without ``to``, the part has the same name in the file."""

    reference: Ref
    target: Text | None


@dataclass(frozen=True, slots=True)
class Gripper(Node):
    """``gripper { actuator: "…" open: … close: … pads: "…", "…" stroke: … m }``: fingers, or a suction cup.

    A gripper from a file of its own begins with ``sys path = '…' on: "…"``, then ``offset`` and ``orientation``.
    """

    source: SystemPath | RosPath | None
    mount: Text | None
    offset: Vector | None
    offset_unit: str | None
    orientation: Quaternion | Euler | DirectionCosines | None
    actuator: Text | None
    open: Number | None
    close: Number | None
    pads: tuple[Text, ...]
    stroke: Number | None
    stroke_unit: str | None


@dataclass(frozen=True, slots=True)
class Opening(Node):
    """``opening { joint: "…" closed: 5 mm open: 30 cm }``: how a drawer, a door or a lever opens."""

    joint: Text | None
    closed: Number | None
    closed_unit: str | None
    open: Number | None
    open_unit: str | None


@dataclass(frozen=True, slots=True)
class Model(Node):
    """``model name as mjcf { source mappings tool: "…" gripper { … } opening { … } home: (…) rad velocity: … }``."""

    name: Name
    kind: str
    source: ModelSource
    mappings: tuple[Mapping, ...]
    tool: Text | None
    gripper: Gripper | None
    opening: Opening | None
    home: Vector | None
    home_unit: str | None
    velocity: Vector | None
    velocity_unit: str | None


@dataclass(frozen=True, slots=True)
class Camera(Node):
    """``camera name { … }``: resolution in pixels, rate in Hz."""

    name: Name
    frame: Ref
    type: str
    resolution: Vector
    fov: Number
    fov_unit: str
    rate: Number


@dataclass(frozen=True, slots=True)
class Sensor(Node):
    """``force-torque name { … }`` or ``imu name { … }``: rate in Hz."""

    kind: str
    name: Name
    frame: Ref
    observes: tuple[str, ...]
    rate: Number


@dataclass(frozen=True, slots=True)
class WorkspaceBox(Node):
    """``box { offset: (…) m size: (…) m orientation: … }``: a space of a workspace, in the frame of its carrier."""

    offset: Vector | None
    offset_unit: str | None
    size: Vector
    size_unit: str
    orientation: Quaternion | Euler | DirectionCosines | None


@dataclass(frozen=True, slots=True)
class Modelled(Node):
    """``obj <…> { … }``, ``obj set``, ``ws``, ``agn``, ``agn set``: the models of an element of the scene."""

    reference: Ref
    entries: tuple[Model | Camera | Sensor | WorkspaceBox | Modelled, ...]


@dataclass(frozen=True, slots=True)
class PairFriction(Node):
    """``friction of obj <…> on agn <…>: 0.3``: the sliding friction between two elements or sets."""

    first: Ref
    second: Ref
    value: Number


@dataclass(frozen=True, slots=True)
class SceneInstance(Node):
    """``scene inst (ns=…) name { scene: <…> … }``."""

    namespace: NamespaceArgument
    name: Name
    scene: Ref
    entries: tuple[Graph | Model | PairFriction | Modelled, ...]
