"""The executions of a study that were executed again, with traces: which run has which of them."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, cast

from robbdd_tools.base.files import UnreadableFile, load_text
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.base.writing import replace_file
from robbdd_tools.campaign.study_place import RUNS
from robbdd_tools.protocol.run_folder import trace_file
from robbdd_tools.run.store import RunStore

if TYPE_CHECKING:
    from robbdd_tools.run.store import StoredRun

FILE = "study.json"
"""File in the folder of such a run: the numbers of its executions in the study."""


def write_numbers(run: Path, numbers: Sequence[int]) -> None:
    """Write the numbers of a run's executions in the study, in the order of the run. Raises ``OSError``."""
    replace_file(run / FILE, json.dumps(list(numbers)) + "\n")


def replays_in(folder: Path) -> RunStore:
    """Return the store of the runs in which executions of the study in ``folder`` were executed again."""
    return RunStore(folder / RUNS)


def replay_of(store: RunStore, number: int) -> tuple[StoredRun, int] | None:
    """Return the newest run with a trace of an execution of a study, and the number of the execution in this run."""
    for run in reversed(store.runs()):
        numbers = _numbers(run.folder)
        if number in numbers and trace_file(run.folder, numbers.index(number)).is_file():
            return run, numbers.index(number)
    return None


def _numbers(run: Path) -> list[object]:
    """Return the numbers of a run's executions; none if it was executed with files that differ from the study's."""
    try:
        found: object = json.loads(load_text(run / FILE, RESULT_SIZE))
    except (OSError, ValueError, UnreadableFile):
        return []
    return cast("list[object]", found) if isinstance(found, list) else []
