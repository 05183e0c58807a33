"""The coverage of a study: what its executions have exercised of what they could, and whether that meets the goals."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, groupby
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.document import Document
from robbdd_tools.base.files import path_to_uri, read_text
from robbdd_tools.campaign.coverage_universe import level_of, universe_from
from robbdd_tools.campaign.study_file import SUFFIX
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.report import value_word, variable_word
from robbdd_tools.syntax.study_content import COVERABLE
from robbdd_tools.syntax.study_text import read_study

if TYPE_CHECKING:
    from pathlib import Path

    from robbdd_tools.campaign.coverage_universe import CoverageUniverse, Level
    from robbdd_tools.run.study_reader import StudyReader

_LEVEL = "level."


@dataclass(frozen=True, slots=True)
class KindCoverage:
    """The coverage of one kind of things. ``kind`` is one of ``COVERABLE``, ``missing`` are those not exercised.

    ``goal`` is the required share in percent; ``None`` without a goal.
    """

    kind: str
    exercised: int
    total: int
    missing: tuple[str, ...]
    goal: float | None

    @property
    def share(self) -> float:
        """The exercised share in percent; 100 if there is nothing to exercise."""
        return 100.0 * self.exercised / self.total if self.total else 100.0

    @property
    def is_met(self) -> bool:
        """Whether the goal is met; true without a goal."""
        return self.goal is None or self.share >= self.goal

    @property
    def words(self) -> str:
        """The coverage in words, with its goal."""
        counted = f"{self.kind}: {self.exercised:,} of {self.total:,} exercised ({self.share:.1f} %)"
        if self.goal is None:
            return counted
        return f"{counted}, goal {self.goal:g} % {'met' if self.is_met else 'not met'}"


def study_coverage(store: StudyReader, goals: Mapping[str, float]) -> list[KindCoverage]:
    """Return the coverage of a stored study; empty if the study did not record what it could exercise.

    Raises ``DatabaseProblem``.
    """
    universe = universe_from(store.fact("coverable"))
    return [] if universe is None else coverage(universe, store.rows(), goals)


def goals_of(path: Path) -> Mapping[str, float]:
    """Return the goals in a ``.study`` file; none if it cannot be read, or for the folder of a study's results."""
    text = read_text(path) if path.suffix == SUFFIX and path.is_file() else ""
    return read_study(Document(path_to_uri(path), 0, text))[0].goals if isinstance(text, str) else {}


def coverage(
    universe: CoverageUniverse, rows: Iterable[Mapping[str, Any]], goals: Mapping[str, float]
) -> list[KindCoverage]:
    """Return the coverage of a study with these exported rows, in the order of ``COVERABLE``.

    A clause is exercised if an execution has decided it: it holds or is violated. So are its predicates, and its
    events, which must have occurred. Levels and pairs are exercised by executions in which a clause was decided.
    """
    levels, pairs, clauses = _exercised(rows)
    decided = [one for one in universe.clauses if (one.variant, one.name) in clauses]
    both = [(universe.levels[first], universe.levels[second]) for first, second in universe.pairs]
    events = [{event: None for one in several for event in one.events} for several in (universe.clauses, decided)]
    words = [{name: None for one in several for name in one.predicates} for several in (universe.clauses, decided)]
    every: Mapping[str, tuple[Iterable[str], Iterable[bool]]] = {
        "levels": (map(_level_words, universe.levels), (one in levels for one in universe.levels)),
        "pairs": (map(_pair_words, both), (frozenset(one) in pairs for one in both)),
        "clauses": (
            (one.name for one in universe.clauses),
            ((one.variant, one.name) in clauses for one in universe.clauses),
        ),
        "events": (events[0], (one in events[1] for one in events[0])),
        "predicates": (words[0], (one in words[1] for one in words[0])),
    }
    return [_kind(kind, *every[kind], goals.get(kind)) for kind in COVERABLE]


def _kind(kind: str, names: Iterable[str], found: Iterable[bool], goal: float | None) -> KindCoverage:
    listed = list(zip(names, found, strict=True))
    missing = tuple(dict.fromkeys(name for name, is_exercised in listed if not is_exercised))
    return KindCoverage(kind, sum(is_exercised for _, is_exercised in listed), len(listed), missing, goal)


def _exercised(
    rows: Iterable[Mapping[str, Any]],
) -> tuple[set[Level], set[frozenset[Level]], set[tuple[str, str]]]:
    levels: set[Level] = set()
    pairs: set[frozenset[Level]] = set()
    clauses: set[tuple[str, str]] = set()
    known: set[str] = set()
    for _, group in groupby(rows, key=lambda row: row["number"]):
        decided = [row for row in group if row["verdict"] != Outcome.UNKNOWN]
        clauses.update((row["variant"], row["clause"]) for row in decided)
        own = {name: value for name, value in decided[0].items() if name.startswith(_LEVEL)} if decided else {}
        key = json.dumps(own)
        if own and key not in known:
            known.add(key)
            found = [level_of(name.removeprefix(_LEVEL), value) for name, value in own.items()]
            levels.update(found)
            pairs.update(map(frozenset, combinations(found, 2)))
    return levels, pairs, clauses


def _level_words(level: Level) -> str:
    name, value = level
    return f"{variable_word(name)} = {value_word(json.loads(value))}"


def _pair_words(pair: Sequence[Level]) -> str:
    return ", ".join(map(_level_words, pair))


def coverage_lines(found: Iterable[KindCoverage], *, most: int) -> Iterator[str]:
    """Yield the coverage of each kind, and up to ``most`` of what is missing from it."""
    for one in found:
        yield one.words
        for name in one.missing[:most]:
            yield f"  not exercised: {name}"
        if len(one.missing) > most > 0:
            yield f"  … and {len(one.missing) - most:,} more"
