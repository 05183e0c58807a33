"""Executions as messages, without a simulator, and their stored rows."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import replace
from pathlib import Path

from kit import write_manifest
from robbdd_tools.catalog.coordination import TreeSpec
from robbdd_tools.monitor.contact import Contact
from robbdd_tools.protocol.messages import (
    ClauseJudged,
    ClauseStarted,
    MarginRanges,
    RunMessage,
    ScenarioFinished,
    ScenarioStarted,
)
from robbdd_tools.protocol.specs import ClauseSpec, Manifest, ScenarioSpec, SceneSpec
from robbdd_tools.run.recording import Recording
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.run.store import RunRecord, RunStore, StoredRun

RECORD = RunRecord("m.bdd", "../../../m.bdd", "abc", 1, "0.1.0")
CLAUSES = tuple(ClauseSpec(line, f"https://x/c{line}", f"c{line}", "then", f'"e:a" {line}') for line in (5, 6))
FREE = {"id", "run", "number", "execution", "wall", "stepping", "host", "began", "ended", "jobs"}
"""Columns that differ between equal runs: wall times, host, number of processes, identifiers of rows."""


def spec(index: int, tree: TreeSpec | None = None) -> ScenarioSpec:
    number, values = index + 1, {"e:var-x": index}
    name, events = f"e:v -- {number}", dict[str, str]()
    feature, story, variant = "features/s.feature", "https://x/s", "https://x/v"
    scene = SceneSpec()
    return ScenarioSpec(feature, 3, name, story, variant, number, values, index, scene, events, CLAUSES, tree=tree)


def execution(index: int, verdict: str = "holds") -> Iterator[RunMessage]:
    """Yield the messages of one execution, with numbers that no shorter type than a double holds."""
    margin = None if verdict == "unknown" else -1.0 / 3
    yield ScenarioStarted(index)
    yield ClauseStarted(index, 5)
    yield ClauseJudged(index, 5, "holds", 0.1 + index / 3, "m", 1.25, "", 2.5)
    yield ClauseJudged(index, 6, verdict, margin, "", None, "why", None, "vacuous", "fault")
    yield MarginRanges(index, 5, ((0.1, 0.1 + index / 7),))
    yield ScenarioFinished(
        index, 4.25, 1.5, 0.5, index, (Contact("e:arm", "", "e:shelf", 1.5, 12.0, 1.6, 0.25),) * index
    )


def record_run(
    store: RunStore,
    margins: Sequence[float | None],
    *,
    clauses: tuple[ClauseSpec, ...] = CLAUSES[:1],
    seed: int = 1,
    contacts: tuple[Contact, ...] = (),
) -> StoredRun:
    """Record a run with one execution per margin (m) of its clauses; ``None`` is an unknown verdict."""
    specs = tuple(replace(spec(index), clauses=clauses, seed=seed) for index in range(len(margins)))
    place, manifest, record = store.begin(), Manifest("m.bdd", seed, specs, True), replace(RECORD, seed=seed)
    write_manifest(place.folder, manifest)
    place.write_record(record)
    with closing(Recording(place, manifest)) as recording:
        recording.begin(record, Policy(), "prepared")
        for index, margin in enumerate(margins):
            recording.take(ScenarioStarted(index))
            verdict = "unknown" if margin is None else "holds" if margin > 0 else "violated"
            unit = "" if margin is None else "m"
            for clause in clauses:
                recording.take(ClauseJudged(index, clause.line, verdict, margin, unit, None, f"{margin}", None))
            recording.take(ScenarioFinished(index, 4.25, 1.5, 0.5, contacts=contacts))
        recording.end("")
    return place


def rows(database: Path, number: int) -> list[object]:
    """Return all that is stored of a run but what ``FREE`` names."""
    with closing(sqlite3.connect(database)) as connection:
        connection.row_factory = sqlite3.Row
        found: list[object] = []
        for query in (
            "SELECT * FROM run WHERE number = ?",
            "SELECT * FROM execution WHERE run = ? ORDER BY idx",
            "SELECT clause.* FROM clause JOIN execution ON id = execution WHERE run = ? ORDER BY idx, position",
        ):
            for row in connection.execute(query, (number,)):
                found.append({name: value for name, value in dict(row).items() if name not in FREE})
        return found
