"""The types that a word of the language is described with.

Plain data and protocols only: no simulator, no graph library and no numpy is imported here, so that an editor
can load the whole catalog in a few milliseconds.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]

Vector = tuple[float, float, float]
"""Metres, x y z."""


class Kind(StrEnum):
    """What a slot of a phrase may stand for."""

    OBJECT = "object"
    WORKSPACE = "workspace"
    AGENT = "agent"
    OBJECT_SET = "object set"
    WORKSPACE_SET = "workspace set"
    ANY = "element"
    NAME = "name"
    VALUE = "value"


@dataclass(frozen=True, slots=True)
class Slot:
    """One argument of a phrase: its name there, what it may be, and the RDF property (CURIE) that carries it."""

    name: str
    kind: Kind
    property: str


@dataclass(frozen=True, slots=True)
class Region:
    """An axis-aligned box in the frame of the object that carries a workspace.

    ``center`` and ``half`` (half edges) in metres. A bin's region is its inside, ``walled``; a table's the space above
    its top. ``name`` tells one part of an object (a shelf's board) from the others.
    """

    center: Vector
    half: Vector
    name: str = ""
    walled: bool = False


Outline = tuple[tuple[Vector, float], ...]
"""Balls (centre and radius, m, in the object's frame) that touch every side of an object from within."""


class Evidence(Protocol):
    """What an evaluator sees: the samples of one window, in order, and the scene they were taken in.

    ``n`` samples; positions in metres in the world frame, orientations as unit quaternions (w, x, y, z).
    A name the trace does not know raises ``KeyError``, which the monitor turns into *unknown*.
    """

    @property
    def times(self) -> FloatArray:
        """Simulated time of each sample, s, shape (n,)."""
        ...

    def position(self, name: str) -> FloatArray:
        """Position of the middle of an object or an agent's tool centre point, shape (n, 3)."""
        ...

    def orientation(self, name: str) -> FloatArray:
        """Orientation of an object or of an agent's tool, shape (n, 4)."""
        ...

    def velocity(self, name: str) -> FloatArray:
        """Mean velocity of that position since the sample before, m/s, shape (n, 3)."""
        ...

    def position_at(self, name: str, times: FloatArray) -> FloatArray:
        """Position at the last sample at or before each of some times (n,), within the window or before it, (n, 3)."""
        ...

    def orientation_at(self, name: str, times: FloatArray) -> FloatArray:
        """Orientation at the last sample at or before each of some times (n,), (n, 4)."""
        ...

    def outline(self, name: str) -> Outline:
        """How far an object reaches around its position."""
        ...

    def regions(self, workspace: str) -> Sequence[tuple[str, Region]]:
        """The regions of the objects that carry a workspace, each with the object whose frame it is given in."""
        ...

    def contents(self, workspace: str) -> Sequence[str]:
        """The workspaces that are composed into one, at any depth."""
        ...

    @property
    def workspaces(self) -> Sequence[str]:
        """The workspaces of the scene that something carries."""
        ...

    def gripped(self, agent: str, name: str) -> FloatArray:
        """1.0 where the agent's gripper holds the object by its gripping faces, else 0.0, shape (n,)."""
        ...

    def reach(self, agent: str, name: str) -> FloatArray:
        """Joint-limit distance (rad) of the agent's best clear grasp of the object, -π without any, shape (n,)."""
        ...

    def force(self, agent: str, name: str) -> FloatArray:
        """Largest force (N) since the sample before between an element and the agent or what it grips, shape (n,).

        The weight of what the agent grips is not counted.
        """
        ...

    def is_immovable(self, name: str) -> bool:
        """Whether an element is not pushed when it is hit: a fixed object, or an agent."""
        ...

    def setting(self, target: str, name: str) -> str:
        """A configuration value of an element as the world that was set up has it."""
        ...


Arguments = Mapping[str, str | tuple[str, ...]]
"""Slot name → name of the element (or names of the set's elements) that fills it."""

Evaluator = Callable[[Evidence, Arguments], "FloatArray"]
"""Signed margin of the predicate at each sample, SI units, positive where it holds, shape (n,)."""

UnitChoice = Callable[[Evidence, Arguments], str]
"""SI unit of a predicate's margin where it depends on configuration."""


@dataclass(frozen=True, slots=True)
class Predicate:
    """A predicate of fluents.

    ``phrase`` is the surface form, slots in ``<…>`` (a reference), ``$…`` (a bare name) or as words; ``aliases``
    are other surface forms that are read as the same, with the same slots; ``sentence`` the Gherkin form with
    ``{slot}`` placeholders. ``unit`` is the SI unit of the margin (``""`` when the margin is ±1), unless ``unit_for``
    says otherwise for a variant that was configured. ``evaluate`` is
    ``None`` for what this installation can state but not judge yet: such a clause is *unknown*, never a pass.
    ``quantities`` are those that the evaluator needs beside poses and grips
    (``reach``): they cost time and are sampled only in the windows of clauses that ask. ``set_up`` tells that it is
    made true before the scenario starts, not observed.
    """

    name: str
    phrase: str
    rdf_type: str
    slots: tuple[Slot, ...]
    sentence: str
    unit: str
    doc: str
    evaluate: Evaluator | None = None
    quantities: tuple[str, ...] = ()
    aliases: tuple[str, ...] = ()
    unit_for: UnitChoice | None = None
    set_up: bool = False


@dataclass(frozen=True, slots=True)
class Behaviour:
    """A behaviour that an agent executes in ``When``.

    ``events`` are the names of the events it emits, in order; the first and the last delimit its duration.
    ``aliases`` are other surface forms of ``phrase``, with the same slots.
    """

    name: str
    phrase: str
    rdf_types: tuple[str, ...]
    slots: tuple[Slot, ...]
    sentence: str
    events: tuple[str, ...]
    doc: str
    aliases: tuple[str, ...] = ()


class ShapeKind(StrEnum):
    """Primitive collision shapes."""

    BOX = "box"
    SPHERE = "sphere"
    CYLINDER = "cylinder"


@dataclass(frozen=True, slots=True)
class Shape:
    """A primitive in the object's frame.

    ``size`` in metres: half edges of a box; (radius, 0, 0) of a sphere; (radius, half length, 0) of a cylinder
    along z. ``position`` is its centre. ``surface`` is the velocity (m/s, along one axis) at which the surface of a
    driven belt runs, ``None`` for a shape that is at rest in its object.
    """

    kind: ShapeKind
    size: Vector
    position: Vector = (0.0, 0.0, 0.0)
    surface: Vector | None = None


@dataclass(frozen=True, slots=True)
class ObjectModel:
    """A thing of the simulated world.

    Chosen for a scene object in whose name, or that of its set, one of ``prefixes`` occurs. ``mass`` in kg,
    ``friction`` the sliding coefficient. A ``free`` object can move (a bin can be pushed), any other is fixed where it
    stands; a ``graspable`` one is small enough for a gripper and is placed at random unless the scene says where.
    ``rest_height`` is the height (m) of its origin above the surface it stands on. ``region`` is the workspace it
    carries, if any. ``color`` is RGBA in [0, 1].
    """

    name: str
    prefixes: tuple[str, ...]
    shapes: tuple[Shape, ...]
    mass: float
    friction: float
    free: bool
    graspable: bool
    rest_height: float
    color: tuple[float, float, float, float]
    doc: str
    region: Region | None = None
    places: tuple[Vector, ...] = ()
    """Standard places (m; x, y on the surface below, z ignored for what stands on a table), best first."""
    parts: tuple[Region, ...] = ()
    """Parts of the object that are workspaces of their own, such as the boards of a shelf."""
    frame: Vector = (0.0, 0.0, 0.0)
    """Where (m) the frame that poses in a scene place lies: the body frame of its file, which may be anywhere."""

    def spaces(self, workspace: str) -> tuple[Region, ...]:
        """Return the regions of a workspace that the object carries: the parts that its local name speaks of
        (``shelf_upper`` of the part ``upper``), otherwise all parts, otherwise the whole region.
        """
        named = tuple(part for part in self.parts if part.name in workspace.lower())
        return named or self.parts or (() if self.region is None else (self.region,))


class GripperKind(StrEnum):
    """How a tool takes hold: between two fingers that close, or by a cup that sucks."""

    PARALLEL = "parallel"
    SUCTION = "suction"


@dataclass(frozen=True, slots=True)
class RobotModel:
    """A robot arm with its tool.

    Chosen for a scene agent in whose name, or that of its set, one of ``prefixes`` occurs. ``mjcf`` is a file beside
    the catalog file. ``home`` are the joint positions (rad) at the start; ``velocity_limits`` rad/s and
    ``torque_limits`` N m per arm joint, as published. ``joints``, ``tool_site`` and ``gripper_actuator`` are names
    inside the MJCF; ``gripper_open`` and ``gripper_closed`` its control values. ``pads`` are the geoms of the
    gripping faces. ``mount`` is where the base of the first such robot stands (m, world frame) and ``stroke`` the
    widest opening between the gripping faces, or the diameter of the suction cup (m). ``source`` names the
    publications the numbers come from.
    """

    name: str
    prefixes: tuple[str, ...]
    mjcf: str
    joints: tuple[str, ...]
    home: tuple[float, ...]
    velocity_limits: tuple[float, ...]
    torque_limits: tuple[float, ...]
    tool_site: str
    gripper_actuator: str
    gripper_open: float
    gripper_closed: float
    pads: tuple[str, ...]
    mount: Vector
    stroke: float
    doc: str
    source: str
    tool_speed: float = 0.5
    """Largest speed of the tool along a planned path, m/s (paper: what the Panda typically reached)."""
    approach_speed: float | None = None
    """Largest speed of the tool while it descends to a thing or lowers one, m/s; ``None``: ``tool_speed``."""
    travel_height: float = 0.30
    """Height in the world frame at which the tool travels, m (paper)."""
    grip_time: float = 0.16
    """How long a grip must last, and is then waited for, before the arm moves, s."""
    release_time: float = 0.32
    """How long the open gripper waits before it leaves, s."""
    gripper: GripperKind = GripperKind.PARALLEL
