"""``robbdd runs``: list the stored runs of a project."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.commands import OK
from robbdd_tools.commands.output import fail, print_line, print_note
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.missing_files import missing_parts
from robbdd_tools.run.store import NoSuchRun, StoredRun
from robbdd_tools.workbench.stored import kept_store

if TYPE_CHECKING:
    from robbdd_tools.run.stored_results import RunStatus


def list_runs(path: Path, store: Path | None) -> int:
    """Print the stored runs, newest last; return the exit code."""
    try:
        found = kept_store(path, store)
    except NoSuchRun as error:
        return fail(str(error))
    runs = found.runs()
    for run in runs:
        for line in _lines(run):
            print_line(line)
    if not runs:
        print_note(f"no runs in {found.folder}")
    return OK


def print_unfinished(run: StoredRun, status: RunStatus) -> None:
    """Print the progress of an unfinished run to standard error."""
    if status.words():
        print_note(f"robbdd: run {run.number or run.folder}: {status.words()}")


def _lines(run: StoredRun) -> list[str]:
    try:
        record, status = run.record(), run.status()
        missing = missing_parts(run)
    except NoSuchRun as error:
        return [f"{run.number:>4}  {error}"]
    words = {Outcome.HOLDS: "hold", Outcome.VIOLATED: "violated", Outcome.UNKNOWN: "unknown"}
    counts = ", ".join(f"{status.counts.get(outcome, 0)} {word}" for outcome, word in words.items())
    ending = f", {status.words()}" if status.words() else ""
    described = f"{run.number:>4}  {record.path}  {counts}{ending}  (seed {record.seed})"
    return [described, *(f"      {part}" for part in missing)]
