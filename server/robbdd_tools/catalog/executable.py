"""Executable scenes and behaviours as plain data: the content of a ``.scenex`` and a ``.bddx``.

Names are IRIs in the data of the graph and CURIEs in a run. Python code is named ``module:attribute``, and this module
never imports it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import PurePath


@dataclass(frozen=True, slots=True)
class Origin:
    """A source position: a file (an absolute path), a line and a column, both from 1.

    Relative paths in a model are relative to the folder of the file. This folder may also contain users' code.
    """

    file: str
    line: int
    column: int

    def __str__(self) -> str:
        """Return ``file:line:column``, as in messages."""
        return f"{self.file}:{self.line}:{self.column}"


_KINDS = {
    "catalog": "catalog behaviour",
    "python": "Python code",
    "process": "process",
    "endpoint": "endpoint",
    "ros-action": "ROS action",
}
USERS_KINDS = ("python", "process", "endpoint")
"""The kinds of implementations that are code of users."""


@dataclass(frozen=True, slots=True)
class Substitution:
    """A catalog behaviour that a run executes instead of a model's implementation.

    - ``implementation``: the IRI of the implementation.
    - ``stated``: the binding in the model (``ROS action '/pick'``).
    - ``executed``: the name of the catalog behaviour.
    """

    implementation: str
    stated: str
    executed: str

    def __str__(self) -> str:
        """Return the substitution as results state it."""
        name = self.implementation.replace("#", "/").rpartition("/")[2]
        return f"catalog behaviour '{self.executed}' substitutes for {self.stated} of '{name}'"


@dataclass(frozen=True, slots=True)
class ChosenScene:
    """The scene instance that a run uses for a scenario without one: its IRI and the path of its ``.scenex``."""

    instance: str
    file: str

    def __str__(self) -> str:
        """Return the choice as results state it."""
        name = self.instance.replace("#", "/").rpartition("/")[2]
        return f"executed in the scene instance '{name}' of {PurePath(self.file).name}"


@dataclass(frozen=True, slots=True)
class Implementation:
    """The implementation of a behaviour.

    - ``kind``: ``catalog``, ``python``, ``process``, ``endpoint`` or ``ros-action``.
    - ``name``: the name of the catalog behaviour, the Python code, the command line, the address or the ROS action.
    - ``origin``: its source position; ``None`` for a graph without source text.
    - ``replaced``: the implementation in the model, if a run executes a catalog behaviour instead.
    - ``limit``: a process or an endpoint must answer within this time (s); ``None`` if the model gives no limit.
    """

    iri: str
    kind: str
    name: str
    origin: Origin | None = None
    replaced: str = ""
    limit: float | None = None

    @property
    def words(self) -> str:
        """The kind and the name for messages, for example ``ROS action '/pick'``."""
        return f"{_KINDS[self.kind]} '{self.name}'"

    @property
    def is_users(self) -> bool:
        """Whether users' code executes the behaviours: in this process, in another process, or on another machine."""
        return self.kind in USERS_KINDS

    @property
    def substitution(self) -> Substitution | None:
        """The substitution; ``None`` if the model states this implementation."""
        return Substitution(self.iri, self.replaced, self.name) if self.replaced else None


@dataclass(frozen=True, slots=True)
class Law:
    """A distribution. ``kind`` is ``uniform``, ``normal`` or ``uniform-rotation``.

    ``low`` and ``high`` are the bounds of each number in a uniform distribution. ``mean`` and ``covariance`` (row by
    row) are the parameters of a normal distribution.
    """

    iri: str
    kind: str
    low: tuple[float, ...] = ()
    high: tuple[float, ...] = ()
    mean: tuple[float, ...] = ()
    covariance: tuple[float, ...] = ()
    origin: Origin | None = None


def spherical(deviation: float, size: int) -> tuple[float, ...]:
    """Return the covariance (row by row) of independent numbers that have the same standard deviation."""
    return tuple(deviation**2 if row == column else 0.0 for row in range(size) for column in range(size))


def law_fault(law: Law) -> str:
    """Return the reason why a distribution cannot be sampled; empty if it can.

    The text is the predicate of a sentence.
    """
    # Import numpy here, so that reading a model does not wait for it.
    import numpy as np

    if law.kind == "uniform":
        if len(law.low) != len(law.high):
            return "has bounds of different lengths"
        above = any(low > high for low, high in zip(law.low, law.high, strict=True))
        return "has a lower bound above its upper one" if above else ""
    if law.kind != "normal":
        return ""
    size = len(law.mean)
    if len(law.covariance) != size * size:
        return f"needs a covariance of {size} × {size} numbers"
    covariance = np.array(law.covariance).reshape(size, size)
    if not np.allclose(covariance, covariance.T):
        return "has a covariance that is not symmetric"
    try:
        np.linalg.cholesky(covariance)
    except np.linalg.LinAlgError:
        return "has a singular covariance"
    return ""


@dataclass(frozen=True, slots=True)
class Link:
    """The placement of a frame relative to the frame ``base``. An empty ``base`` is the world.

    - A ``pose`` has a position (m) and a rotation (unit quaternion, w first), or a distribution from which they are
      sampled. Sampled positions are multiplied by ``scale`` (m).
    - A ``fixed`` joint connects its frames rigidly.
    - At the zero of a ``revolute`` joint, its frames are ``position`` apart, and its ``axes`` (of ``base`` and
      ``frame``) coincide.
    """

    frame: str
    base: str
    kind: str
    position: tuple[float, ...] = ()
    rotation: tuple[float, ...] = ()
    position_law: str = ""
    rotation_law: str = ""
    scale: float = 1.0
    axes: tuple[str, ...] = ()
    origin: Origin | None = None


@dataclass(frozen=True, slots=True)
class Body:
    """A body of a kinematic tree or graph. Its frames are in written order, and the first one is the body frame."""

    iri: str
    frames: tuple[str, ...]
    origin: Origin | None = None


@dataclass(frozen=True, slots=True)
class MountedGripper:
    """A gripper from a file of its own, fixed to an arm.

    ``kind``, ``name`` and ``package`` are as in ``ModelSource``. ``mount`` is the body or site of the arm's file that
    carries the gripper, whose origin is at ``position`` (m) and ``rotation`` (quaternion w, x, y, z) in its frame.
    """

    kind: str
    name: str
    mount: str
    package: str = ""
    position: tuple[float, ...] = (0.0, 0.0, 0.0)
    rotation: tuple[float, ...] = (1.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class ArmModel:
    """Data about an arm that replace data found in its model file. Names are as in the file.

    Empty names, ``None`` and zeros mean that the file decides. Where a gripper is ``mounted``, the names of its parts
    are those in its file. ``open`` and ``closed`` are values of the gripper's actuator. ``stroke`` (m) is the widest
    opening between the ``pads``, or the diameter of a suction cup, which is a single pad. ``home`` (rad, m for a
    sliding joint) and ``velocity`` (rad/s, m/s) have one number for each joint.
    """

    tool: str = ""
    actuator: str = ""
    open: float | None = None
    closed: float | None = None
    pads: tuple[str, ...] = ()
    stroke: float = 0.0
    home: tuple[float, ...] = ()
    velocity: tuple[float, ...] = ()
    mounted: MountedGripper | None = None


@dataclass(frozen=True, slots=True)
class ModelEntry:
    """An entry of a model, by its keyword, such as ``home``; ``number`` is the index of one of its numbers."""

    keyword: str
    number: int | None = None


@dataclass(frozen=True, slots=True)
class OpeningModel:
    """Data about a thing that opens, which replace data found in its model file.

    ``joint`` is a name in the file. The thing counts as closed up to the joint position ``closed``, and as open from
    the joint position ``open`` on; both are quantities (``5 mm``). Empty texts mean that the file decides.
    """

    joint: str = ""
    closed: str = ""
    open: str = ""


@dataclass(frozen=True, slots=True)
class ModelSource:
    """The source of a model.

    - ``kind``: ``file``, ``ros``, ``python`` or ``catalog``.
    - ``name``: the path, the Python code or the name in the catalog.
    - ``package``: the ROS package.
    - ``format``: ``mjcf``, ``urdf`` or ``usd``.
    - ``bodies``: maps bodies of the scene's kinematic trees to their names in the file.
    """

    iri: str
    format: str
    kind: str
    name: str
    package: str = ""
    bodies: tuple[tuple[str, str], ...] = ()
    trees: tuple[tuple[str, str], ...] = ()
    arm: ArmModel | None = None
    origin: Origin | None = None
    opening: OpeningModel | None = None

    @property
    def gripper(self) -> ModelSource | None:
        """The file of a gripper that is mounted on this arm, without its format."""
        mounted = None if self.arm is None else self.arm.mounted
        if mounted is None:
            return None
        return ModelSource(self.iri, "", mounted.kind, mounted.name, mounted.package, origin=self.origin)


@dataclass(frozen=True, slots=True)
class Realisation:
    """The models of one element of a scene."""

    element: str
    models: tuple[ModelSource, ...]
    origin: Origin | None = None
    is_agent: bool = False


@dataclass(frozen=True, slots=True)
class Friction:
    """The coefficient of sliding friction between two elements; it replaces the smaller of their own coefficients."""

    first: str
    second: str
    coefficient: float
    origin: Origin | None = None


@dataclass(frozen=True, slots=True)
class WorkspaceBox:
    """A space of a workspace, given in place of those of the models that carry it.

    ``offset`` is the centre of the box in the frame of the model, and ``size`` has its edges, both in m. ``turn``, a
    unit quaternion with w first, rotates the edges from the axes of this frame; without it, they are along the axes.
    """

    workspace: str
    offset: tuple[float, ...]
    size: tuple[float, ...]
    turn: tuple[float, ...] = ()
    origin: Origin | None = None


@dataclass(frozen=True, slots=True)
class SceneInstance:
    """An executable scene: models of the whole scene, models of its elements, and the placements of bodies.

    ``anchor`` is the frame that represents the world; empty if none is given. ``scene`` is the IRI of the scene that it
    instantiates. ``correct_places`` maps objects to the workspaces that are correct for them (IRIs). It is only known
    for an instance that is chosen for a run, whose file may import graphs that the model does not.
    """

    iri: str
    models: tuple[ModelSource, ...] = ()
    elements: tuple[Realisation, ...] = ()
    bodies: tuple[Body, ...] = ()
    links: tuple[Link, ...] = ()
    laws: tuple[Law, ...] = ()
    anchor: str = ""
    origin: Origin | None = None
    scene: str = ""
    frictions: tuple[Friction, ...] = ()
    correct_places: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    boxes: tuple[WorkspaceBox, ...] = ()

    @property
    def sources(self) -> tuple[ModelSource, ...]:
        """The models of the scene and of its elements, and the grippers that are mounted on them."""
        models = (*self.models, *(model for one in self.elements for model in one.models))
        return (*models, *(model.gripper for model in models if model.gripper is not None))
