"""Types that describe the words of the language.

Plain data and protocols only: no simulator, graph library or numpy is imported here, so an editor can load the whole
catalog in a few milliseconds.
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
    """Kind of element that a slot of a phrase refers to."""

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
    """One argument of a phrase: its name, its kinds, and the RDF property (CURIE) that carries it."""

    name: str
    kind: Kind
    property: str


@dataclass(frozen=True, slots=True)
class Region:
    """An axis-aligned box in the frame of the object that carries a workspace.

    ``center`` and ``half`` (half edges) in metres. A bin's region is its inside, ``walled``; a table's is the space
    above its top. ``name`` identifies a part of an object (a shelf's board).
    """

    center: Vector
    half: Vector
    name: str = ""
    walled: bool = False


Outline = tuple[tuple[Vector, float], ...]
"""Balls (centre and radius, m, in the object's frame) inscribed in an object that touch each of its sides."""


class Evidence(Protocol):
    """The data that an evaluator reads: the samples of one window, in order, and their scene.

    ``n`` samples; positions in metres in the world frame, orientations as unit quaternions (w, x, y, z). An unknown
    name raises ``KeyError``, which the monitor turns into *unknown*.
    """

    @property
    def times(self) -> FloatArray:
        """Simulated time of each sample, s, shape (n,)."""
        ...

    def position(self, name: str) -> FloatArray:
        """Position of an object's middle or of an agent's tool centre point, shape (n, 3)."""
        ...

    def orientation(self, name: str) -> FloatArray:
        """Orientation of an object or of an agent's tool, shape (n, 4)."""
        ...

    def velocity(self, name: str) -> FloatArray:
        """Mean velocity of that position since the previous sample, m/s, shape (n, 3)."""
        ...

    def position_at(self, name: str, times: FloatArray) -> FloatArray:
        """Position at the last sample at or before each of ``times`` (n,), within the window or before it, (n, 3)."""
        ...

    def orientation_at(self, name: str, times: FloatArray) -> FloatArray:
        """Orientation at the last sample at or before each of ``times`` (n,), (n, 4)."""
        ...

    def outline(self, name: str) -> Outline:
        """Extent of an object around its position."""
        ...

    def regions(self, workspace: str) -> Sequence[tuple[str, Region]]:
        """The regions of the objects that carry a workspace, each with the object whose frame it is in."""
        ...

    def contents(self, workspace: str) -> Sequence[str]:
        """The workspaces composed into this one, at any depth."""
        ...

    @property
    def workspaces(self) -> Sequence[str]:
        """The workspaces of the scene that some object carries."""
        ...

    def gripped(self, agent: str, name: str) -> FloatArray:
        """1.0 where the agent's gripper holds the object by its gripping faces, else 0.0, shape (n,)."""
        ...

    def reach(self, agent: str, name: str) -> FloatArray:
        """Joint-limit distance (rad) of the agent's best clear grasp of the object, -π without any, shape (n,)."""
        ...

    def force(self, agent: str, name: str) -> FloatArray:
        """Largest force (N) since the previous sample between an element and the agent or the object that it grips,
        shape (n,).

        The weight of the gripped object is not counted.
        """
        ...

    def is_immovable(self, name: str) -> bool:
        """Whether a hit does not push an element: a fixed object, or an agent."""
        ...

    def setting(self, target: str, name: str) -> str:
        """A configuration value of an element, as set up in the world."""
        ...


Arguments = Mapping[str, str | tuple[str, ...]]
"""Slot name → name of the element (or names of the set's elements) that fills it."""

Evaluator = Callable[[Evidence, Arguments], "FloatArray"]
"""Signed margin of the predicate at each sample, SI units, positive where it holds, shape (n,)."""

UnitChoice = Callable[[Evidence, Arguments], str]
"""SI unit of a predicate's margin, if it depends on configuration."""


@dataclass(frozen=True, slots=True)
class Predicate:
    """A predicate of fluents.

    ``phrase`` is the surface form, slots in ``<…>`` (a reference), ``$…`` (a bare name) or as words; ``aliases`` are
    other surface forms with the same meaning and slots; ``sentence`` is the Gherkin form with ``{slot}`` placeholders.
    ``unit`` is the SI unit of the margin (``""`` for a margin of ±1); ``unit_for`` overrides it for a configured
    variant. ``evaluate`` is ``None`` for a predicate that this installation cannot judge: its clauses are *unknown*,
    never a pass. ``quantities`` are those that the evaluator needs besides poses and grips (``reach``): they are
    expensive and sampled only in the windows of clauses that need them. ``set_up`` marks a predicate that is set up
    before the scenario starts instead of observed.
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

    ``events`` are the names of the events that it emits, in order; the first and the last delimit its duration.
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

    ``size`` in metres: half edges of a box; (radius, 0, 0) of a sphere; (radius, half length, 0) of a cylinder along z.
    ``position`` is its centre. ``surface`` is the surface velocity (m/s, along one axis) of a driven belt, ``None`` for
    other shapes.
    """

    kind: ShapeKind
    size: Vector
    position: Vector = (0.0, 0.0, 0.0)
    surface: Vector | None = None


@dataclass(frozen=True, slots=True)
class ObjectModel:
    """A kind of object of the simulated world.

    Used for a scene object if one of ``prefixes`` occurs in its name, or in that of its set. ``mass`` in kg,
    ``friction`` the sliding coefficient. A ``free`` object can move (a bin can be pushed); any other is fixed. A
    ``graspable`` one fits into a gripper and is placed at random unless the scene places it. ``rest_height`` is the
    height (m) of its origin above the surface below it. ``region`` is the workspace that it carries, if any. ``color``
    is RGBA in [0, 1].
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
    """Standard places (m; x, y on the surface below; z is ignored for an object on a table), best first."""
    parts: tuple[Region, ...] = ()
    """Parts of the object that are workspaces of their own, such as the boards of a shelf."""
    frame: Vector = (0.0, 0.0, 0.0)
    """Position (m) of the frame that poses in a scene refer to: the body frame of its file, which is arbitrary."""

    def spaces(self, workspace: str) -> tuple[Region, ...]:
        """Return the regions of a workspace that the object carries.

        These are the parts that the workspace's local name contains (``shelf_upper``: the part ``upper``), otherwise
        all parts, otherwise the whole region.
        """
        named = tuple(part for part in self.parts if part.name in workspace.lower())
        return named or self.parts or (() if self.region is None else (self.region,))


class GripperKind(StrEnum):
    """How a tool grips: with two closing fingers, or with a suction cup."""

    PARALLEL = "parallel"
    SUCTION = "suction"


@dataclass(frozen=True, slots=True)
class RobotModel:
    """A robot arm with its tool.

    Used for a scene agent if one of ``prefixes`` occurs in its name, or in that of its set. ``mjcf`` is a file next to
    the catalog file. ``home`` are the initial joint positions (rad); ``velocity_limits`` (rad/s) and ``torque_limits``
    (N m) per arm joint, as published. ``joints``, ``tool_site`` and ``gripper_actuator`` are names in the MJCF;
    ``gripper_open`` and ``gripper_closed`` its control values. ``pads`` are the geoms of the gripping faces. ``mount``
    is the base position of the first such robot (m, world frame); ``stroke`` is the widest opening between the gripping
    faces, or the diameter of the suction cup (m). ``source`` names the publications of the numbers.
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
    """Largest speed of the tool along a planned path, m/s (paper: typically reached by the Panda)."""
    approach_speed: float | None = None
    """Largest speed of the tool while it descends to an object or lowers one, m/s; ``None``: ``tool_speed``."""
    travel_height: float = 0.30
    """Height in the world frame at which the tool travels, m (paper)."""
    grip_time: float = 0.16
    """How long the agent checks a grip before the arm moves, s."""
    release_time: float = 0.32
    """How long the open gripper waits before it retracts, s."""
    gripper: GripperKind = GripperKind.PARALLEL
