"""Syntax trees of kinematics: vectors, poses, bodies, joints, trees and graphs.

Numbers are kept as written, together with their units; nothing is converted here.
"""

from __future__ import annotations

from dataclasses import dataclass

from robbdd_tools.syntax.scene_tree import Name, NamespaceArgument, Node, Number, Ref


@dataclass(frozen=True, slots=True)
class Vector(Node):
    """``(1, 2, 3)``; a matrix is a vector of its rows."""

    values: tuple[Number | Vector, ...]


@dataclass(frozen=True, slots=True)
class Sample(Node):
    """``sample <distribution>`` instead of a value."""

    distribution: Ref


@dataclass(frozen=True, slots=True)
class Quaternion(Node):
    """``quat { xyzw: … }`` or ``quat { sample <…> }``."""

    value: Vector | Sample


@dataclass(frozen=True, slots=True)
class EulerAngles(Node):
    """``axes: xyz extrinsic angles: … unit: …``; ``unit`` is ``None`` if omitted."""

    axes: str
    extrinsic: bool
    angles: Vector
    unit: str | None


@dataclass(frozen=True, slots=True)
class Euler(Node):
    """``euler { … }``."""

    value: EulerAngles | Sample


@dataclass(frozen=True, slots=True)
class Axes(Node):
    """``x: … y: … z: …``: the columns of a rotation matrix."""

    x: Vector
    y: Vector
    z: Vector


@dataclass(frozen=True, slots=True)
class DirectionCosines(Node):
    """``direction-cosine { … }``."""

    value: Axes | Sample


Orientation = Quaternion | Euler | DirectionCosines | Sample


@dataclass(frozen=True, slots=True)
class Pose(Node):
    """``pose name { wrt: <frame> xyz: … unit orientation: … }``."""

    name: Name
    wrt: Ref | None
    position: Vector | Sample
    unit: str
    orientation: Orientation


@dataclass(frozen=True, slots=True)
class Frame(Node):
    """``frame name { pose … }``."""

    name: Name
    poses: tuple[Pose, ...]


@dataclass(frozen=True, slots=True)
class Inertia(Node):
    """``inertia { frame mass inertia-matrix }``; the matrix is in kg m²."""

    frame: Ref
    mass: Number | None
    mass_unit: str | None
    matrix: Vector | None


@dataclass(frozen=True, slots=True)
class RigidBody(Node):
    """``body name { frames, inertia }``."""

    name: Name
    parts: tuple[Frame | Inertia, ...]


@dataclass(frozen=True, slots=True)
class TreeUse(Node):
    """``tree <name>``: another tree as part of this one."""

    reference: Ref


@dataclass(frozen=True, slots=True)
class FrameAxis(Node):
    """``<frame>.z``."""

    frame: Ref
    axis: str


@dataclass(frozen=True, slots=True)
class FixedJoint(Node):
    """``fixed name { parent: <frame> child: <frame> }``."""

    name: Name
    parent_frame: Ref
    child_frame: Ref


@dataclass(frozen=True, slots=True)
class Actuation(Node):
    """``actuation { gear ratio, command-interface, state-interface }``."""

    ratio: Number
    commands: tuple[str, ...]
    states: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class JointOffset(Node):
    """``offset { xyz: … unit }``."""

    position: Vector
    unit: str


@dataclass(frozen=True, slots=True)
class Limit(Node):
    """``position: (low, high) unit``, likewise velocity, acceleration and effort."""

    quantity: str
    range: Vector
    unit: str


@dataclass(frozen=True, slots=True)
class Limits(Node):
    """``limits { … }``."""

    limits: tuple[Limit, ...]


@dataclass(frozen=True, slots=True)
class Mimic(Node):
    """``mimic { joint: <j> multiplier: … offset: … }``."""

    joint: Ref
    multiplier: Number
    offset: Number


@dataclass(frozen=True, slots=True)
class Polarity(Node):
    """``polarity: PositivePolarity`` or ``NegativePolarity``."""

    value: str


@dataclass(frozen=True, slots=True)
class RevoluteJoint(Node):
    """``revolute name { parent: <frame>.z child: <frame>.z … }``."""

    name: Name
    parent_frame: FrameAxis
    child_frame: FrameAxis
    details: tuple[Actuation | JointOffset | Limits | Mimic | Polarity, ...]


@dataclass(frozen=True, slots=True)
class SerialChain(Node):
    """``serial { root: <frame> tip: <frame> }``."""

    root: Ref
    tip: Ref


@dataclass(frozen=True, slots=True)
class ParallelChains(Node):
    """``parallel { }``."""


@dataclass(frozen=True, slots=True)
class Joints(Node):
    """``joints { … }``."""

    entries: tuple[FixedJoint | RevoluteJoint | SerialChain | ParallelChains, ...]


TreeEntry = TreeUse | RigidBody | Joints


@dataclass(frozen=True, slots=True)
class KinematicTree(Node):
    """``ktree name { … }``; a tree without a namespace is a template."""

    namespace: NamespaceArgument | None
    name: Name
    root: Ref | None
    entries: tuple[TreeEntry, ...]


@dataclass(frozen=True, slots=True)
class TreeInstance(Node):
    """``ktree inst (ns=…) name of <template>``."""

    namespace: NamespaceArgument
    name: Name
    template: Ref


@dataclass(frozen=True, slots=True)
class Graph(Node):
    """``kgraph (ns=…) name { … }`` inside a scene instance."""

    namespace: NamespaceArgument
    name: Name
    anchor: Ref | None
    entries: tuple[TreeEntry, ...]
