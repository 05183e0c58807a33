"""Report the files that a stored run lacks, for example because only a part of its store was copied."""

from __future__ import annotations

from collections.abc import Iterable

from robbdd_tools.protocol.manifest_file import MANIFEST
from robbdd_tools.protocol.run_folder import trace_file
from robbdd_tools.run.database import LOG, DatabaseProblem
from robbdd_tools.run.store import RESULTS, StoredRun
from robbdd_tools.run.stored_results import finished_executions

NAMED = 3
"""A message names at most this many files."""


def missing_parts(run: StoredRun) -> list[str]:
    """Return one sentence for each missing part of a run; no sentence for a live run. Raises ``NoSuchRun``."""
    try:
        finished = finished_executions(run.database, run.number)
    except DatabaseProblem as error:
        return [f"only its {RESULTS} can be read: {error}"]
    if finished is None or run.is_live:
        return []
    status = run.status()
    traces = {int(path.stem) for path in trace_file(run.folder, 0).parent.glob("*.mcap") if path.stem.isdecimal()}
    found: list[str] = []
    # Each process may have been writing a trace when the run ended.
    unknown = traces.difference(finished)
    if len(unknown) > status.jobs:
        found.append(
            f"{run.database} lacks the results of {_named(unknown)}, whose traces exist: "
            f"copy its write-ahead log {run.database.name}{LOG}, too"
        )
    lost = {index for index, simulated in finished.items() if simulated}.difference(traces)
    if lost:
        found.append(f"the folder of the run lacks the traces of {_named(lost)}")
    if not (run.folder / MANIFEST).is_file():
        found.append(f"the folder of the run lacks {MANIFEST}, without which its results cannot be read")
    return found


def _named(indices: Iterable[int]) -> str:
    names = [f"{index:06}" for index in sorted(indices)]
    more = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
    return f"{len(names)} execution{'' if len(names) == 1 else 's'} ({', '.join(names[:NAMED])}{more})"
