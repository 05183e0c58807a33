"""The traces that a study keeps: one MCAP file per execution, up to a limit of size."""

from __future__ import annotations

import shutil
from collections.abc import Collection, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.renames import rename
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.protocol.run_folder import trace_file

if TYPE_CHECKING:
    from robbdd_tools.run.results import ScenarioResult
    from robbdd_tools.syntax.study_content import KeptTraces

TRACES = "traces"
"""Folder of the traces of a study. Each file is named after the number of its execution."""
MEGABYTE = 1_000_000


def kept_trace(folder: Path, number: int) -> Path:
    """Return the path of the trace of an execution of the study in ``folder``."""
    return folder / TRACES / f"{number}.mcap"


def traces_in(folder: Path) -> Mapping[int, int]:
    """Return the sizes in bytes of a study's traces, by the number of their execution, in increasing order."""
    found = {int(one.stem): one.stat().st_size for one in (folder / TRACES).glob("*.mcap") if one.stem.isdecimal()}
    return dict(sorted(found.items()))


def keep_traces(
    folder: Path, batch: Path, scenarios: Sequence[ScenarioResult], numbers: Sequence[int], wanted: KeptTraces
) -> None:
    """Move wanted traces of a batch to the folder of its study. Raises ``OSError``.

    ``numbers`` are the numbers of the scenarios' executions in the study. A second call has no effect.
    """
    for index, (scenario, number) in enumerate(zip(scenarios, numbers, strict=True)):
        trace = trace_file(batch, index)
        if trace.is_file() and not (wanted.failures and scenario.verdict is Outcome.HOLDS):
            (folder / TRACES).mkdir(exist_ok=True)
            rename(trace, kept_trace(folder, number))


def trim_traces(folder: Path, failing: Collection[int], limit: int) -> None:
    """Remove traces that do not fit into ``limit`` bytes. Raises ``OSError``.

    Traces of failures are kept first, then traces of earlier executions. So equal studies keep the same traces, even if
    they were interrupted.
    """
    sizes = traces_in(folder)
    used, is_full = 0, False
    for number in sorted(sizes, key=lambda one: (one not in failing, one)):
        used += sizes[number]
        is_full = is_full or used > limit
        if is_full:
            kept_trace(folder, number).unlink(missing_ok=True)


def remove_traces(folder: Path, numbers: Iterable[int]) -> None:
    """Remove the traces of some executions, and then the folder of traces if it is empty. Raises ``OSError``."""
    for number in numbers:
        kept_trace(folder, number).unlink(missing_ok=True)
    if not traces_in(folder):
        shutil.rmtree(folder / TRACES, ignore_errors=True)
