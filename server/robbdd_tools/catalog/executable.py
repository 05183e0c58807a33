"""Executable scenes and behaviours as plain data: the content of a ``.scenex`` and a ``.bddx``.

Names are IRIs in the graph's data and CURIEs in a run. Python code is named ``module:attribute``; nothing here imports
it.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Origin:
    """Source position: a file (an absolute path), line and column, both from 1.

    Relative paths in a model are relative to the file's folder, which may also contain user code.
    """

    file: str
    line: int
    column: int

    def __str__(self) -> str:
        """Return ``file:line:column``, as in messages."""
        return f"{self.file}:{self.line}:{self.column}"


_KINDS = {"catalog": "catalog behaviour", "python": "Python code", "ros-action": "ROS action"}


@dataclass(frozen=True, slots=True)
class Substitution:
    """A catalog behaviour that a run executes in place of a model's implementation.

    ``implementation`` is its IRI, ``stated`` the model's binding (``ROS action '/pick'``), ``executed`` the name
    of the catalog behaviour.
    """

    implementation: str
    stated: str
    executed: str

    def __str__(self) -> str:
        """Return the substitution as results state it."""
        name = self.implementation.replace("#", "/").rpartition("/")[2]
        return f"catalog behaviour '{self.executed}' substitutes for {self.stated} of '{name}'"


@dataclass(frozen=True, slots=True)
class Implementation:
    """Implementation of a behaviour: ``kind`` is ``catalog``, ``python`` or ``ros-action``; ``name`` is its name there.

    ``origin`` is its source position, ``None`` for a graph without source text. ``replaced`` is what the model states
    where a run executes a catalog behaviour instead.
    """

    iri: str
    kind: str
    name: str
    origin: Origin | None = None
    replaced: str = ""

    @property
    def words(self) -> str:
        """Kind and name for messages, such as ``ROS action '/pick'``."""
        return f"{_KINDS[self.kind]} '{self.name}'"

    @property
    def substitution(self) -> Substitution | None:
        """The substitution, ``None`` for an implementation as the model states it."""
        return Substitution(self.iri, self.replaced, self.name) if self.replaced else None


@dataclass(frozen=True, slots=True)
class Law:
    """A distribution: ``kind`` is ``uniform``, ``normal`` or ``uniform-rotation``.

    ``low`` and ``high`` bound each number of a uniform one; ``mean`` and ``covariance`` (row by row) belong to a normal
    one.
    """

    iri: str
    kind: str
    low: tuple[float, ...] = ()
    high: tuple[float, ...] = ()
    mean: tuple[float, ...] = ()
    covariance: tuple[float, ...] = ()
    origin: Origin | None = None


def spherical(deviation: float, size: int) -> tuple[float, ...]:
    """Return the covariance of independent numbers with the same standard deviation, row by row."""
    return tuple(deviation**2 if row == column else 0.0 for row in range(size) for column in range(size))


def law_fault(law: Law) -> str:
    """Return why a distribution cannot be sampled, as a predicate of a sentence; empty if it can."""
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
    """The placement of a frame relative to another one, ``base`` (empty: the world).

    A ``pose`` has a position (m) and a rotation (unit quaternion, w first), or a distribution to sample them from;
    sampled positions are multiplied by ``scale`` (m). A ``fixed`` joint connects its frames rigidly; at the zero of a
    ``revolute`` joint they are ``position`` apart and its ``axes`` (of ``base`` and ``frame``) coincide.
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
    """A body of a kinematic tree or graph with its frames in written order; the first is the body frame."""

    iri: str
    frames: tuple[str, ...]
    origin: Origin | None = None


@dataclass(frozen=True, slots=True)
class ArmModel:
    """Data on a picking arm that its model file lacks; names are those in the file.

    ``open`` and ``closed`` are values of the gripper's actuator, ``stroke`` (m) is the widest opening between the
    ``pads``. ``home`` (rad) and ``velocity`` (rad/s), one number per joint, are empty if not given.
    """

    tool: str
    actuator: str
    open: float
    closed: float
    pads: tuple[str, ...]
    stroke: float
    home: tuple[float, ...] = ()
    velocity: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class ModelSource:
    """Source of a model: ``kind`` is ``file``, ``ros``, ``python`` or ``catalog``.

    ``name`` is the path, the code or the catalog name, ``package`` the ROS package; ``format`` is ``mjcf``, ``urdf`` or
    ``usd``. ``bodies`` maps bodies of the scene's trees to their names in the file.
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


@dataclass(frozen=True, slots=True)
class Realisation:
    """The models of one element of a scene."""

    element: str
    models: tuple[ModelSource, ...]
    origin: Origin | None = None


@dataclass(frozen=True, slots=True)
class SceneInstance:
    """An executable scene: models of the whole scene, models of its elements, and the placements of bodies.

    ``anchor`` is the frame that represents the world; empty if none is given.
    """

    iri: str
    models: tuple[ModelSource, ...] = ()
    elements: tuple[Realisation, ...] = ()
    bodies: tuple[Body, ...] = ()
    links: tuple[Link, ...] = ()
    laws: tuple[Law, ...] = ()
    anchor: str = ""
    origin: Origin | None = None
