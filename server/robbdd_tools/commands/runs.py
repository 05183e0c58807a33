"""``robbdd runs``: the stored runs of a project."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from robbdd_tools.commands import OK
from robbdd_tools.commands.output import print_line, print_note
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.store import NoSuchRun, RunStore, StoredRun, store_beside


def store_at(path: Path, store: Path | None) -> RunStore:
    """Return the store that a command is about: the one named, else that of the project of a path."""
    return store_beside(path) if store is None else RunStore(store)


def list_runs(path: Path, store: Path | None) -> int:
    """Print the stored runs, the newest last; returns the exit code."""
    found = store_at(path, store)
    runs = found.runs()
    for run in runs:
        print_line(_line(run))
    if not runs:
        print_note(f"no runs in {found.folder}")
    return OK


def _line(run: StoredRun) -> str:
    try:
        record, results = run.record(), run.results()
        verdicts = Counter(scenario["verdict"] for scenario in results["scenarios"])
    except NoSuchRun as error:
        return f"{run.number:>4}  {error}"
    words = {Outcome.HOLDS: "hold", Outcome.VIOLATED: "violated", Outcome.UNKNOWN: "unknown"}
    counts = ", ".join(f"{verdicts[outcome]} {word}" for outcome, word in words.items())
    ending = "" if results["complete"] else ", incomplete"
    return f"{run.number:>4}  {record.path}  {counts}{ending}  (seed {record.seed})"
