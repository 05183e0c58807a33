"""Judge the logs of a folder, to compare them with simulated executions of the same scenarios."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.campaign.run_sources import NotResults, RunSource
from robbdd_tools.logs.log_files import METADATA, is_log
from robbdd_tools.workbench.execution_rows import execution_results
from robbdd_tools.workbench.folder import Keeping
from robbdd_tools.workbench.log_judging import LogJudgement, LogNames
from robbdd_tools.workbench.model import load_all
from robbdd_tools.workbench.named_logs import every_named_log
from robbdd_tools.workbench.plan import Plan, Selection

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robbdd_tools.workbench.execution_rows import ExecutionResult
    from robbdd_tools.workbench.model import Model
    from robbdd_tools.workbench.named_logs import NamedLog


def is_log_folder(word: str) -> bool:
    """Return whether a word is a folder that contains logs, but is not a bag with metadata."""
    folder = Path(word)
    return folder.is_dir() and not (folder / METADATA).exists() and next(_logs(folder), None) is not None


def log_source(word: str, path: Path) -> RunSource:
    """Return the results of all logs in a folder, judged by the executions of the model at ``path``.

    A log is judged as stated by the ``robot log`` that names it, and else by the only ``robot log`` of the model. Logs
    of the same scenario with the same values are its repetitions, in the order of their names. Their results have no
    seed in common with a simulated execution. Nothing is stored. Raises ``NotResults``, and the errors of
    ``LogJudgement``.
    """
    model = load_all([path])
    named = every_named_log(model, Selection(), LogNames())
    results: list[ExecutionResult] = []
    repetitions: Counter[str] = Counter()
    for number, log in enumerate(_logs(Path(word))):
        for result in _judged(log, _meaning(log, named, path), model):
            key = f"{result.variant} {result.execution} {sorted(result.values.items())}"
            repetitions[key] += 1
            results.append(replace(result, index=number, repetition=repetitions[key], seed=-1 - number))
    return RunSource(f"{word} ({len(results)} log{'s' * (len(results) > 1)})", tuple(results))


def _logs(folder: Path) -> Iterator[Path]:
    yield from (one for one in sorted(folder.iterdir()) if is_log(one))


def _meaning(log: Path, named: list[NamedLog], path: Path) -> NamedLog:
    own = [one for one in named if one.path.resolve() == log.resolve()]
    if own:
        return own[0]
    if len(named) == 1:
        return replace(named[0], names=replace(named[0].names, annotations=None))
    has = f"{len(named)} executions name" if named else "no execution names"
    raise NotResults(
        f"{log}: it is not known what its names mean, because {has} a log in {path}: write a 'robot log' with "
        f"path: \"{log}\" and 'log: <NAME>' in an execution"
    )


def _judged(log: Path, meaning: NamedLog, model: Model) -> tuple[ExecutionResult, ...]:
    plan = Plan.of(model, meaning.selection)
    with LogJudgement(plan, log, meaning.names, Keeping(keep=False)) as judgement:
        for _ in judgement.messages():
            pass
        if judgement.problem or judgement.ending:
            raise NotResults(judgement.problem or f"{log}: {judgement.ending}")
        return execution_results(judgement.progress.as_json())
