"""``robbdd judge``: judge a stored run or the log of a real robot by the clauses of a model, without simulating."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.printable import printable_json
from robbdd_tools.base.writing import replace_file
from robbdd_tools.commands import FAILED, FINDINGS, OK, signal_code
from robbdd_tools.commands.execute import follow
from robbdd_tools.commands.output import fail, print_note
from robbdd_tools.commands.run import Outputs, report_problems
from robbdd_tools.commands.runs import print_unfinished
from robbdd_tools.logs.log_files import is_log
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.protocol.specs import plain_name
from robbdd_tools.workbench.folder import Keeping
from robbdd_tools.workbench.judging import Judgement
from robbdd_tools.workbench.log_judging import LogJudgement, LogNames
from robbdd_tools.workbench.model import load_all, read_instances
from robbdd_tools.workbench.named_logs import named_logs, names_for
from robbdd_tools.workbench.plan import Plan, Selection
from robbdd_tools.workbench.stored import store_at

if TYPE_CHECKING:
    from robbdd_tools.run.results import RunResults


@dataclass(frozen=True, slots=True)
class JudgeOptions:
    """The options of ``robbdd judge``.

    - ``run``: the stored run, given as a number, as ``latest`` or as a folder; or the path of a log. Empty for the logs
      that the executions of the models name.
    - ``paths``: the edited models.
    - ``store``: the store of runs.
    - ``report``: the output file.
    - ``selection``: selects the scenario that the robot executed in the log.
    - ``names``: the settings for names and times of a log.
    - ``keep``: false if the judgement of a log is not stored.
    - ``scenex``: files with scene instances for scenarios without an execution that a log is judged by.
    """

    run: str
    paths: Sequence[Path]
    store: Path | None = None
    report: Path | None = None
    selection: Selection = field(default_factory=Selection)
    names: LogNames = field(default_factory=LogNames)
    keep: bool = True
    scenex: tuple[Path, ...] = ()


def judge(options: JudgeOptions) -> int:
    """Judge by a model's clauses and print the verdicts. Return the same exit code as ``robbdd run``."""
    work = _judge_named if not options.run else _judge_log if is_log(Path(options.run)) else _judge
    return report_problems(Outputs(report=options.report), viewer=False, work=lambda: work(options))


def _judge(options: JudgeOptions) -> int:
    place = store_at(options.paths[0], options.store).find(options.run)
    status = place.status()
    model = load_all(options.paths)
    _ = model.runnable
    print_unfinished(place, status)
    with tempfile.TemporaryDirectory(prefix="robbdd-") as folder:
        judgement = Judgement(place, model, Path(folder))
        ended_by = follow(judgement)
    return _concluded(judgement.progress, options, ended_by)


def _judge_log(options: JudgeOptions) -> int:
    model = load_all(options.paths)
    plan = Plan.of(model, replace(options.selection, instances=read_instances(options.scenex)))
    specs = plan.scenarios
    names = names_for(model, specs[0], options.names) if len(specs) == 1 else options.names
    return _judge_one(options, plan, Path(options.run), names)


def _judge_named(options: JudgeOptions) -> int:
    """Judge each log that an execution names. Return the exit code of the worst."""
    model = load_all(options.paths)
    logs = named_logs(model, options.selection, options.names)
    if options.report is not None and len(logs) > 1:
        names = ", ".join(plain_name(one.execution) for one in logs)
        return fail(f"--json is for one log, but several executions name one: choose with --scenario, of {names}")
    worst = OK
    for one in logs:
        print_note(f"{plain_name(one.execution)}: {one.path}")
        code = _judge_one(options, Plan.of(model, one.selection), one.path, one.names)
        worst = max(worst, code)
    return worst


def _judge_one(options: JudgeOptions, plan: Plan, log: Path, names: LogNames) -> int:
    keeping = Keeping(store=options.store, keep=options.keep)
    with LogJudgement(plan, log, names, keeping) as judgement:
        ended_by = follow(judgement, made="recorded, judged in", live=names.quiet is not None)
        for remark in judgement.remarks:
            print_note(remark)
        if judgement.place.kept:
            print_note(f"kept as run {judgement.place.number}")
    if judgement.problem:
        return fail(judgement.problem)
    return _concluded(judgement.progress, options, ended_by)


def _concluded(results: RunResults, options: JudgeOptions, ended_by: int) -> int:
    """Write the report and return the exit code."""
    if options.report is not None:
        replace_file(options.report, printable_json(results.as_json(), indent=1) + "\n")
    if ended_by:
        return signal_code(ended_by)
    if not results.complete:
        return FAILED
    return OK if results.count(Outcome.HOLDS) == len(results.scenarios) else FINDINGS
