"""Types that describe the words of the language.

Plain data and protocols only, without a simulator, graph library or numpy: editors load the catalog in milliseconds.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Literal, Protocol

from robbdd_tools.base.solid_shapes import Inertia
from robbdd_tools.base.solid_shapes import Shape as Shape
from robbdd_tools.base.solid_shapes import ShapeKind as ShapeKind
from robbdd_tools.base.solid_shapes import Vector as Vector

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from robbdd_tools.base.articulation import OpeningRecord, PassiveJoint

    FloatArray = NDArray[np.float64]


class Kind(StrEnum):
    """The kind of element to which a slot of a phrase refers."""

    OBJECT = "object"
    WORKSPACE = "workspace"
    AGENT = "agent"
    OBJECT_SET = "object set"
    WORKSPACE_SET = "workspace set"
    ANY = "element"
    NAME = "name"
    VALUE = "value"
    QUANTITY = "quantity"


@dataclass(frozen=True, slots=True)
class Slot:
    """One argument of a phrase: its name, its kinds, and the RDF property (CURIE) that carries it.

    ``dimension`` is what a quantity measures, such as ``length``; ``unsigned`` marks one that is never negative.
    """

    name: str
    kind: Kind
    property: str
    dimension: str = ""
    unsigned: bool = False


@dataclass(frozen=True, slots=True)
class Region:
    """A box in the frame of a workspace's carrier: ``center`` and ``half`` (half edges), m.

    ``turn`` (unit quaternion w, x, y, z) rotates it about its centre. A bin's region is its inside and is ``walled``;
    ``name`` is that of a part, such as a shelf's board.
    """

    center: Vector
    half: Vector
    name: str = ""
    walled: bool = False
    turn: tuple[float, ...] = ()


Outline = tuple[tuple[Vector, float], ...]
"""Balls (centre and radius, m, object's frame) inscribed in an object, such that they touch each of its sides."""


class Evidence(Protocol):
    """The data that an evaluator reads: the samples of one window, in order, and their scene.

    There are ``n`` samples. Positions are in m in the world frame, and orientations are unit quaternions (w, x, y, z).
    Arrays are read-only. An unknown name raises ``KeyError``, for which the monitor returns *unknown*.
    """

    @property
    def times(self) -> FloatArray:
        """Simulated time of each sample, s, shape (n,)."""
        ...

    def position(self, name: str) -> FloatArray:
        """Return the position of an object's centre or of an agent's tool centre point, shape (n, 3)."""
        ...

    def orientation(self, name: str) -> FloatArray:
        """Return the orientation of an object or of an agent's tool, shape (n, 4)."""
        ...

    def velocity(self, name: str) -> FloatArray:
        """Return the mean velocity of the position of ``name`` since the previous sample, m/s, shape (n, 3)."""
        ...

    def turning(self, name: str) -> FloatArray:
        """Return the mean angular speed since the previous sample, rad/s, shape (n,)."""
        ...

    def position_at(self, name: str, times: FloatArray) -> FloatArray:
        """Return the position at the last sample up to each of ``times`` (n,), even before the window, (n, 3)."""
        ...

    def orientation_at(self, name: str, times: FloatArray) -> FloatArray:
        """Return the orientation at the last sample up to each of ``times`` (n,), shape (n, 4)."""
        ...

    def outline(self, name: str) -> Outline:
        """Return the extent of an object around its position."""
        ...

    def regions(self, workspace: str) -> Sequence[tuple[str, Region]]:
        """Return the regions of a workspace, each with the object in whose frame the region is given."""
        ...

    def contents(self, workspace: str) -> Sequence[str]:
        """Return the workspaces inside this one, at any depth."""
        ...

    def correct_places(self, name: str) -> Sequence[str]:
        """Return the workspaces that are stated to be correct for an object; *unknown* if none is stated."""
        ...

    @property
    def workspaces(self) -> Sequence[str]:
        """The workspaces of the scene that some object carries."""
        ...

    @property
    def grippers(self) -> Sequence[str]:
        """The agents whose grips are known."""
        ...

    def gripped(self, agent: str, name: str) -> FloatArray:
        """Return 1.0 where the agent's gripping faces hold the object, else 0.0, shape (n,)."""
        ...

    def reach(self, agent: str, name: str) -> FloatArray:
        """Return how far (rad) an agent's best clear grasp of an object is from joint limits, -π without one, (n,)."""
        ...

    def force(self, agent: str, name: str) -> FloatArray:
        """Return the largest contact force (N) since the last sample, with that of what the agent grips, (n,)."""
        ...

    def touch(self, one: str, other: str) -> FloatArray:
        """Return the largest contact force (N) since the previous sample, without objects that an agent grips, (n,)."""
        ...

    def gap(self, one: str, other: str) -> FloatArray:
        """Return the distance (m) of the surfaces of two elements, shape (n,); negative where they overlap."""
        ...

    def joint_clearance(self, agent: str) -> FloatArray:
        """Return the smallest distance of a joint from its limits, as a share of the joint's range, shape (n,)."""
        ...

    def opening(self, name: str) -> OpeningRecord:
        """Return how far a thing with a joint is open, at each of the n samples."""
        ...

    def travelled(self, name: str, limit: float) -> FloatArray:
        """Return how long (m) an element's path is since the window began, (n,); *unknown* if errors exceed a limit."""
        ...

    def is_immovable(self, name: str) -> bool:
        """Return whether an element does not move when it is hit. Fixed objects and agents are immovable."""
        ...

    def setting(self, target: str, name: str) -> str:
        """Return the value of a configuration of an element, as set up in the world."""
        ...

    def truth(self, topic: str) -> FloatArray:
        """Return 1 where the last message on a topic of a log is true, -1 where it is false, shape (n,)."""
        ...

    @property
    def is_logged(self) -> bool:
        """Whether the samples are observations of a log. Otherwise they are the true states of a simulation."""
        ...


Arguments = Mapping[str, str | tuple[str, ...]]
"""Slot name → name of the element that fills the slot, or names of the elements of the set."""

Evaluator = Callable[[Evidence, Arguments], "FloatArray"]
"""Returns the signed margin at each sample, in the predicate's unit, positive where it holds, shape (n,)."""

UnitChoice = Callable[[Evidence, Arguments], str]
"""Returns the unit of a predicate's margin if it depends on configuration or on a quantity's unit in the clause."""

DurationMargin = Callable[[float, Arguments], float]
"""Returns the signed margin of a predicate about a duration (s), in the predicate's unit."""


@dataclass(frozen=True, slots=True)
class Predicate:
    """A predicate of fluents.

    - ``phrase``: its form in a model. A slot is written in ``<…>`` (a reference), as ``$…`` (a bare name), as ``#…`` (a
      number with a unit, or a variable) or as words. ``aliases`` are other forms with the same meaning and slots.
    - ``sentence``: its form in Gherkin, with ``{slot}`` placeholders.
    - ``unit``: the SI unit of the margin; ``""`` for a margin of ±1. ``unit_for`` replaces it for a configured variant.
    - ``evaluate``: the evaluator; ``None`` if this installation has none. Then clauses are *unknown*, and never pass.
    - ``quantities``: what the evaluator needs besides poses and grips (``reach``), sampled in its windows only.
    - ``duration``: judges the time between the events of ``from … until …``; ``evaluate`` is then only for plots.
    - ``set_up``: true if the predicate is set up before the scenario, or stated by the model, instead of observed.
    - ``measured``: how errors of poses change the margin: as a length, …; ``error``: error of its own observations, SI.
    - ``synonyms``: wrong words that users write for it; the error message then names the predicate.
    - ``in_texts``: forms for the text of a ``pred("…")`` only; as phrases they are about other kinds of elements.
    - ``pointwise``: true if the margin at a sample depends only on it and the one before; windows may then be divided.
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
    duration: DurationMargin | None = None
    measured: Literal["nothing", "length", "path", "angle", "speed", "otherwise"] = "otherwise"
    synonyms: tuple[str, ...] = ()
    in_texts: tuple[str, ...] = ()
    pointwise: bool = False
    error: float = 0.0


@dataclass(frozen=True, slots=True)
class Behaviour:
    """A behaviour that an agent executes in ``When``.

    ``events`` are the names of the events that it emits, in order. The first and the last of them delimit its duration.
    ``aliases`` and ``synonyms`` are those of ``Predicate``.
    """

    name: str
    phrase: str
    rdf_types: tuple[str, ...]
    slots: tuple[Slot, ...]
    sentence: str
    events: tuple[str, ...]
    doc: str
    aliases: tuple[str, ...] = ()
    synonyms: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ObjectModel:
    """A kind of object in the simulated world, for objects with one of ``prefixes`` in their name or their set's name.

    - ``mass``: in kg; ``friction``: the coefficient of sliding friction; ``free``: true if the object can move.
    - ``graspable``: true if the object fits into a gripper. It is placed at random unless the scene places it.
    - ``rest_height``: the height (m) of its origin above the surface below; ``region``: the workspace that it carries.
    - ``color``: RGBA in [0, 1]; ``bystander``: true if an agent that executes nothing may have the model: a person.
    - ``whole_words``: true if only whole words of a name count; ``unspecific``: true if other models take precedence.
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
    inertia: Inertia | None = None
    """The distribution of its mass, if this is not uniform in its shapes."""
    frame: Vector = (0.0, 0.0, 0.0)
    """Position (m) of the frame to which poses in a scene refer: the body frame of its file."""
    joint: PassiveJoint | None = None
    """The joint, if this is a moving part of another object, such as a drawer. Moving parts are not ``free``."""
    moving: ObjectModel | None = None
    """The moving part that this object carries, with its joint."""
    bystander: bool = False
    whole_words: bool = False
    unspecific: bool = False


class GripperKind(StrEnum):
    """How a tool grips: with two closing fingers, or with a suction cup."""

    PARALLEL = "parallel"
    SUCTION = "suction"


@dataclass(frozen=True, slots=True)
class RobotModel:
    """A robot arm with its tool, for agents with one of ``prefixes`` in their name or their set's name.

    - ``mjcf``: a model file in the folder of the catalog file; ``home``: the initial joint positions (rad).
    - ``velocity_limits`` (rad/s) and ``torque_limits`` (N m): the published limits of each arm joint.
    - ``joints``, ``tool_site`` and ``gripper_actuator``: names in the model file; ``pads``: its gripping faces.
    - ``gripper_open`` and ``gripper_closed``: control values of the gripper's actuator.
    - ``mount``: the position of the base of the first such robot (m, world frame).
    - ``stroke``: the widest opening between the gripping faces, or the diameter of the suction cup (m).
    - ``source``: the publications from which the numbers are taken.
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
    """Largest speed (m/s) of the tool along a planned path (paper: typically reached by the Panda)."""
    approach_speed: float | None = None
    """Largest speed (m/s) of the tool while it descends to an object or lowers one; ``None`` means ``tool_speed``."""
    travel_height: float = 0.30
    """Height (m, world frame) at which the tool travels (paper)."""
    carry_clearance: float = 0.0
    """The tool travels so high that a carried object clears everything below its path by this (m); 0: no clearance."""
    grip_time: float = 0.16
    """The agent checks a grip for this time (s) before the arm moves."""
    release_time: float = 0.32
    """The open gripper waits for this time (s) before it retracts."""
    tilt: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)
    """Rotation (w, x, y, z) of an arm that hangs or leans, relative to its upright base."""
    gripper: GripperKind = GripperKind.PARALLEL
