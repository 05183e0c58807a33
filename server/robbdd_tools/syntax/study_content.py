"""The contents of a ``.study`` file as plain data, and the limits of its settings."""

from __future__ import annotations

from dataclasses import dataclass, field

from robbdd_tools.base.document import Span

STUDY = "study"
"""File extension of studies, without the dot."""
MOST_REPETITIONS = 1_000_000
"""Maximum value of ``repeat``, ``first`` and ``sample``."""
MOST_BATCH = 10_000
"""Maximum value of ``batch``. The scenarios of a batch are all in memory."""
MOST_SEED = 2**63 - 1
"""Maximum value of a seed. The results are stored in 64 bits."""
MOST_SECONDS = 1_000_000
"""Maximum value of ``timeout`` in s."""
LATIN, SOBOL, GRID = "latin-hypercube", "sobol", "grid"
DESIGNS = (LATIN, SOBOL, GRID)
"""Designs that choose the values of ranges."""
FAILURES, ALL = "failures", "all"
"""A study can keep the traces of these executions."""
COVERABLE = ("levels", "pairs", "clauses", "events", "predicates")
"""The kinds of things whose coverage can be a goal of a study."""
MOST_TRACES = 1_000_000
"""Maximum size of all kept traces in MB."""
MOST_POINTS = 100_000
"""Maximum number of points of a design."""


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
    """The rule that chooses the values of ranges. ``kind`` is one of ``DESIGNS``.

    ``size`` is the number of points. For a ``grid``, it is the number of levels of each range.
    """

    kind: str
    size: int
    span: Span


@dataclass(frozen=True, slots=True)
class KeptTraces:
    """The traces that a study keeps. If ``failures`` is true, these are only traces of executions that do not hold.

    ``limit`` is the maximum size of all traces together in MB (1e6 bytes).
    """

    failures: bool
    limit: int


@dataclass(slots=True)
class StudyText:
    """The contents of a ``.study`` file. ``numbers`` maps the name of each numeric setting to its value."""

    imports: list[Word] = field(default_factory=list[Word])
    name: str = ""
    head: Span = field(default_factory=lambda: Span(0, 0))
    """The place of the study's name; empty if it has none."""
    scenarios: tuple[Word, ...] = ()
    where: Word | None = None
    factors: list[Factor] = field(default_factory=list[Factor])
    ranges: list[Range] = field(default_factory=list[Range])
    design: Design | None = None
    traces: KeptTraces | None = None
    is_blocked: bool = False
    """Whether all executions of one repetition have the same seed."""
    goals: dict[str, float] = field(default_factory=dict[str, float])
    """Kind of ``COVERABLE`` → the share in percent that the study must exercise."""
    numbers: dict[str, float] = field(default_factory=dict[str, float])
    places: dict[str, Span] = field(default_factory=dict[str, Span])
    """Name of a setting → its place."""

    @property
    def scenes(self) -> tuple[Word, ...]:
        """The files with the scene instances that are levels of a factor."""
        return tuple(level for one in self.factors if one.implementation is None for level in one.levels)

    def whole(self, name: str) -> int | None:
        """Return the value of a setting that is a whole number, or ``None`` if it is missing."""
        found = self.numbers.get(name)
        return None if found is None else int(found)
