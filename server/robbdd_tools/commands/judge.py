"""``robbdd judge``: judge the traces of a stored run by the clauses of an edited model, without simulating."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from robbdd_tools.base.printable import printable_json
from robbdd_tools.base.writing import replace_file
from robbdd_tools.commands import FAILED, FINDINGS, OK, signal_code
from robbdd_tools.commands.execute import follow
from robbdd_tools.commands.run import Outputs, report_problems
from robbdd_tools.commands.runs import print_unfinished
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.workbench.judging import Judgement
from robbdd_tools.workbench.model import load_all
from robbdd_tools.workbench.stored import store_at


@dataclass(frozen=True, slots=True)
class JudgeOptions:
    """The options of ``robbdd judge``.

    - ``run``: the stored run, given as a number, as ``latest`` or as a folder.
    - ``paths``: the edited models.
    - ``store``: the store of runs.
    - ``report``: the output file.
    """

    run: str
    paths: Sequence[Path]
    store: Path | None = None
    report: Path | None = None


def judge(options: JudgeOptions) -> int:
    """Judge stored traces by a model's clauses and print the verdicts. Return the exit code as ``robbdd run`` does."""
    return report_problems(Outputs(report=options.report), viewer=False, work=lambda: _judge(options))


def _judge(options: JudgeOptions) -> int:
    place = store_at(options.paths[0], options.store).find(options.run)
    status = place.status()
    model = load_all(options.paths)
    _ = model.runnable
    print_unfinished(place, status)
    with tempfile.TemporaryDirectory(prefix="robbdd-") as folder:
        judgement = Judgement(place, model, Path(folder))
        ended_by = follow(judgement)
    results = judgement.progress
    if options.report is not None:
        replace_file(options.report, printable_json(results.as_json(), indent=1) + "\n")
    if ended_by:
        return signal_code(ended_by)
    if not results.complete:
        return FAILED
    return OK if results.count(Outcome.HOLDS) == len(results.scenarios) else FINDINGS
