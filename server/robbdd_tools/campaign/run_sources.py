"""Find what is to be compared: stored runs, and results files of ``robbdd run --json``."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import UnreadableFile, load_bytes
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.run.imported import BrokenResults, read_results
from robbdd_tools.workbench.execution_rows import ExecutionResult, execution_results
from robbdd_tools.workbench.stored import PastRun, find_run

if TYPE_CHECKING:
    from robbdd_tools.run.store import StoredRun


class NotResults(RobbddError):
    """A results file cannot be read."""


@dataclass(frozen=True, slots=True)
class RunSource:
    """The results to compare. ``name`` says where they are from; ``place`` is the stored run, if it is one."""

    name: str
    results: tuple[ExecutionResult, ...]
    place: StoredRun | None = None


def run_source(word: str, path: Path, store: Path | None = None) -> RunSource:
    """Return the results that ``word`` names: a results file (``.json``), a stored run's number, folder, or ``latest``.

    ``path`` is in the project, ``store`` another folder of runs. Raises ``NotResults`` and ``NoSuchRun``.
    """
    file = Path(word)
    if file.suffix == ".json":
        return RunSource(word, _from_file(file))
    return stored_source(find_run(word, path, store=store))


def stored_source(run: PastRun) -> RunSource:
    """Return the results of a stored run. Raises ``NoSuchRun``."""
    name = f"run {run.number}" if run.number else str(run.folder)
    return RunSource(f"{name} ({run.record.path}, seed {run.record.seed})", run.results, run.place)


def _from_file(path: Path) -> tuple[ExecutionResult, ...]:
    try:
        text = load_bytes(path, RESULT_SIZE).decode("utf-8-sig")
        read_results(text)  # explains what is wrong with a file
        document: Mapping[str, Any] = json.loads(text)
        return execution_results(document)
    except BrokenResults as error:
        raise NotResults(f"{path}:{error.line}:{error.column}: {error}") from error
    except UnicodeDecodeError as error:
        raise NotResults(f"{path}: this is not UTF-8 text") from error
    except UnreadableFile as error:
        raise NotResults(f"{path}: {error}") from error
    except (KeyError, TypeError, ValueError) as error:
        raise NotResults(f"{path}: {error} is missing or wrong: compare results of `robbdd run --json`") from error
