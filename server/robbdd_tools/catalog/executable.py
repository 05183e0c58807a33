"""How scenes and behaviours are executed, as plain data: what a ``.scenex`` and a ``.bddx`` say.

Names are IRIs where the graph is read and CURIEs in a run. Python code is named ``module:attribute``; nothing here
imports it.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Origin:
    """Where something is written: a file (an absolute path), line and column, both from 1.

    Paths that a model names are relative to the file's folder, and user code may lie there.
    """

    file: str
    line: int
    column: int

    def __str__(self) -> str:
        """Return ``file:line:column`` as messages have it."""
        return f"{self.file}:{self.line}:{self.column}"


@dataclass(frozen=True, slots=True)
class Implementation:
    """What executes a behaviour: ``kind`` is ``catalog``, ``python`` or ``ros-action``; ``name`` says which.

    ``origin`` is where that is written, ``None`` for a graph without source text.
    """

    iri: str
    kind: str
    name: str
    origin: Origin | None = None


@dataclass(frozen=True, slots=True)
class Law:
    """A distribution: ``kind`` is ``uniform``, ``normal`` or ``uniform-rotation``.

    ``low`` and ``high`` bound each number of a uniform one; ``mean`` and ``covariance`` (rows behind one another)
    are those of a normal one.
    """

    iri: str
    kind: str
    low: tuple[float, ...] = ()
    high: tuple[float, ...] = ()
    mean: tuple[float, ...] = ()
    covariance: tuple[float, ...] = ()
    origin: Origin | None = None


def spherical(deviation: float, size: int) -> tuple[float, ...]:
    """Return the covariance of independent numbers of one standard deviation, rows behind one another."""
    return tuple(deviation**2 if row == column else 0.0 for row in range(size) for column in range(size))


def law_fault(law: Law) -> str:
    """Return why a distribution cannot be drawn from, as what is said of it; empty when it can."""
    # Reading a model should not wait for numpy.
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
    """What places a frame relative to another one, ``base`` (empty: the world).

    A ``pose`` has a position (m) and a rotation (unit quaternion, w first), or a law that they are drawn from: what
    is drawn for a position is in units of ``scale`` m. A ``fixed`` joint holds its frames together, a ``revolute``
    one has them ``position`` apart and its ``axes`` (those of ``base`` and ``frame``) in one line, at its zero.
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
    """A body of a kinematic tree or graph with its frames in written order; the first is the body's own."""

    iri: str
    frames: tuple[str, ...]
    origin: Origin | None = None


@dataclass(frozen=True, slots=True)
class ArmModel:
    """What a model file does not say of an arm that is to pick: names are those in the file.

    ``open`` and ``closed`` are values of the gripper's actuator, ``stroke`` (m) is the widest opening between the
    ``pads``. ``home`` (rad) and ``velocity`` (rad/s), one number per joint, are empty where they are not written.
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
    """Where a model comes from: ``kind`` is ``file``, ``ros``, ``python`` or ``catalog``.

    ``name`` is the path, the code or the catalog name, ``package`` that of ROS; ``format`` is ``mjcf``, ``urdf`` or
    ``usd``. ``bodies`` tells for bodies of the scene's trees what the file calls them.
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
    """An executable scene: models of the whole scene, those of its elements, and what places bodies.

    ``anchor`` is the frame that stands for the world, empty where nothing says which.
    """

    iri: str
    models: tuple[ModelSource, ...] = ()
    elements: tuple[Realisation, ...] = ()
    bodies: tuple[Body, ...] = ()
    links: tuple[Link, ...] = ()
    laws: tuple[Law, ...] = ()
    anchor: str = ""
    origin: Origin | None = None
