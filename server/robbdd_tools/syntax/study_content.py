"""The contents of a ``.study`` file as plain data, and the limits of its settings."""

from __future__ import annotations

from dataclasses import dataclass, field

from robbdd_tools.base.document import Span

STUDY = "study"
"""The ending of the names of studies, without the dot."""
MOST_REPETITIONS = 1_000_000
"""Limit of ``repeat``, ``first`` and ``sample``."""
MOST_BATCH = 10_000
"""Limit of ``batch``: the scenarios of a batch are in memory."""
MOST_SEED = 2**63 - 1
"""Limit of a seed: the results are stored in 64 bits."""
MOST_SECONDS = 1_000_000
"""Limit of ``timeout`` in s."""
LATIN, SOBOL, GRID = "latin-hypercube", "sobol", "grid"
DESIGNS = (LATIN, SOBOL, GRID)
"""The designs of ranges."""
FAILURES, ALL = "failures", "all"
"""The executions whose traces a study can keep."""
MOST_TRACES = 1_000_000
"""Limit of the size of kept traces in MB."""
MOST_POINTS = 100_000
"""Limit of the points of a design."""


@dataclass(frozen=True, slots=True)
class Word:
    """A value of a study, and its place in the text. ``is_name`` is true for a name in angle brackets."""

    text: str
    span: Span
    is_name: bool = False

    @property
    def words(self) -> str:
        """The value as written."""
        return f"<{self.text}>" if self.is_name else self.text


@dataclass(frozen=True, slots=True)
class Factor:
    """A factor of a study. ``implementation`` is the implementation of a behaviour; ``None`` for scene instances.

    The levels of an implementation are catalog behaviours, and names of other implementations.
    """

    implementation: Word | None
    levels: tuple[Word, ...]


@dataclass(frozen=True, slots=True)
class Range:
    """A range of values of a variable of scenarios, both bounds included. ``unit`` is empty if none is written.

    ``span`` is the place of the two bounds.
    """

    variable: Word
    low: float
    high: float
    unit: str
    span: Span


@dataclass(frozen=True, slots=True)
class Design:
    """Where the values of ranges are taken. ``kind`` is one of ``DESIGNS``.

    ``size`` is the number of points; of a ``grid``, the number of levels of each range.
    """

    kind: str
    size: int
    span: Span


@dataclass(frozen=True, slots=True)
class KeptTraces:
    """The traces that a study keeps: those of all executions or, if ``failures``, of those that do not hold.

    ``limit`` is the size of all of them in MB (1e6 bytes).
    """

    failures: bool
    limit: int


@dataclass(slots=True)
class StudyText:
    """The contents of a ``.study`` file. ``numbers`` has the settings with a number by their names."""

    imports: list[Word] = field(default_factory=list[Word])
    name: str = ""
    head: Span = field(default_factory=lambda: Span(0, 0))
    """The place of the name; empty if there is none."""
    scenarios: tuple[Word, ...] = ()
    where: Word | None = None
    factors: list[Factor] = field(default_factory=list[Factor])
    ranges: list[Range] = field(default_factory=list[Range])
    design: Design | None = None
    traces: KeptTraces | None = None
    is_blocked: bool = False
    """Whether all executions of one repetition have the same seed."""
    numbers: dict[str, float] = field(default_factory=dict[str, float])
    places: dict[str, Span] = field(default_factory=dict[str, Span])
    """The places of the names of settings."""

    @property
    def scenes(self) -> tuple[Word, ...]:
        """The files whose scene instances are levels of a factor."""
        return tuple(level for one in self.factors if one.implementation is None for level in one.levels)

    def whole(self, name: str) -> int | None:
        """Return a setting that is a whole number; ``None`` if it is missing."""
        found = self.numbers.get(name)
        return None if found is None else int(found)
