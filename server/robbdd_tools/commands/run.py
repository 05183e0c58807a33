"""``robbdd run``: execute scenarios and print every clause's verdict with its margin."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.printable import printable_json
from robbdd_tools.base.writing import replace_file
from robbdd_tools.commands import FAILED, FINDINGS, OK, signal_code
from robbdd_tools.commands.chosen_scenarios import print_coverage
from robbdd_tools.commands.execute import follow_run
from robbdd_tools.commands.models import print_findings
from robbdd_tools.commands.output import fail, print_line, print_note
from robbdd_tools.commands.runs import print_unfinished
from robbdd_tools.graph.verified_requirements import names_by_variant
from robbdd_tools.monitor.verdict import Cause, Outcome
from robbdd_tools.protocol.messages import VIEWER
from robbdd_tools.run.database import DatabaseProblem
from robbdd_tools.run.debugging import check_debugger
from robbdd_tools.run.pictures import NoPictures, no_display, render_videos, render_violations
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.workbench.folder import Keeping, new_folder
from robbdd_tools.workbench.model import ModelErrors, load_all, read_instances
from robbdd_tools.workbench.plan import Plan, Selection
from robbdd_tools.workbench.recorded_requirements import read_requirements
from robbdd_tools.workbench.rerun import NothingFailed, failed_in, last_run
from robbdd_tools.workbench.run import Run
from robbdd_tools.workbench.stored import store_at
from robbdd_tools.workbench.time_estimate import estimate

if TYPE_CHECKING:
    from robbdd_tools.run.results import RunResults


@dataclass(frozen=True, slots=True)
class Outputs:
    """Where to write: a JSON file, a JUnit XML file, a folder of pictures and videos, and the run's own folder.

    If ``every_clause`` is true, every clause is printed, however many scenarios there are.
    """

    report: Path | None = None
    junit: Path | None = None
    record: Path | None = None
    keeping: Keeping = field(default_factory=Keeping)
    every_clause: bool = False


@dataclass(frozen=True, slots=True)
class RunOptions:
    """The options of ``robbdd run``.

    - ``paths``: the models, or folders of models, to run.
    - ``repeat``: replaces the number of repetitions that executions state.
    - ``rerun_failed``: select the scenarios that failed in the last stored run.
    - ``viewer``: open a window on each scenario, one after another.
    - ``scenex``: files with scene instances for scenarios without an execution.
    """

    paths: Sequence[Path]
    selection: Selection
    policy: Policy
    outputs: Outputs
    repeat: int | None = None
    rerun_failed: bool = False
    viewer: bool = False
    scenex: tuple[Path, ...] = ()


def run(options: RunOptions) -> int:
    """Run models; return the exit code."""
    return report_problems(options.outputs, viewer=options.viewer, work=lambda: _run(options))


def report_problems(outputs: Outputs, *, viewer: bool, work: Callable[[], int]) -> int:
    """Call ``work``, which does the work of a run, and return the exit code. If it fails, print the reason."""
    problem = _unwritable(outputs) or (no_display() if viewer else "")
    if problem:
        return fail(problem)
    try:
        return work()
    except ModelErrors as error:
        print_findings(error.findings, print_note)
        return FAILED
    except NothingFailed as nothing:
        print_line(str(nothing))
        return OK
    except RobbddError as error:
        return fail(str(error))
    except BrokenPipeError:  # of the output, such as `robbdd compare … | head`: nobody reads more
        raise
    except OSError as error:
        return fail(f"{error.filename or outputs.keeping.folder or outputs.report}: {error.strerror or error}")


def viewed_policy(policy: Policy, *, viewer: bool) -> Policy:
    """Return the policy of a run.

    If ``viewer`` is true, scenarios are executed one after another, so that the viewer can show them.
    """
    if not viewer:
        return policy
    os.environ[VIEWER] = "1"
    return replace(policy, jobs=1)


def conclude(run: Run, outputs: Outputs, ended_by: int) -> int:
    """Write the reports of a run, print where the run is stored, and return the exit code. Raises ``OSError``."""
    results = run.progress
    # Print this first: a report that cannot be written loses no result.
    if run.place.kept:
        print_note(f"kept as {f'run {run.number}' if run.number else run.folder}")
        if not results.complete and results.cause is not Cause.STOPPED:
            print_note(f"resume it with: robbdd run --resume {run.number or run.folder}")
    if outputs.record is not None:
        _record(run.folder, outputs.record)
    _report(results, outputs, run.folder)
    if run.problem:
        return fail(run.problem)
    if ended_by:
        return signal_code(ended_by)
    return OK if results.count(Outcome.HOLDS) == len(results.scenarios) else FINDINGS


def _run(options: RunOptions) -> int:
    path = options.paths[0]
    if options.policy.debug is not None:
        check_debugger()
    model = load_all(options.paths)
    selection, repeat, scenex = options.selection, options.repeat, options.scenex
    if options.rerun_failed:
        _ = model.runnable
        last = last_run(store_at(path, options.outputs.keeping.store), path)
        print_unfinished(last, last.status())
        failed = failed_in(last)
        own = failed.seed if selection.seed is None else selection.seed
        selection = replace(
            selection,
            choices=[failed.choice],
            seed=own,
            default_seed=failed.default_seed,
            default_substitutions=failed.substitutions,
            world=selection.world or failed.world,
        )
        scenex = scenex or failed.scenex
        repeat = repeat or failed.repeat
    plan = Plan.of(model, replace(selection, instances=read_instances(scenex)))
    print_coverage(plan.covers)
    place = new_folder(path, options.outputs.keeping)
    if place.remark:
        print_note(f"robbdd: {place.remark}")
    policy = viewed_policy(options.policy, viewer=options.viewer)
    with Run.begin(plan, place.place, policy, repeat=repeat, on_close=place.remove) as run:
        _announce(run, policy)
        ended_by = follow_run(run, every_clause=options.outputs.every_clause)
        return conclude(run, options.outputs, ended_by)


def _announce(run: Run, policy: Policy) -> None:
    """Print the estimated duration of a large run. A database that cannot be read is reported with the results."""
    with suppress(DatabaseProblem):
        expected = estimate(run.manifest.scenarios, run.place.database, policy.jobs)
        if expected.is_large:
            print_note(f"robbdd: {expected} ({expected.basis})")


def _unwritable(outputs: Outputs) -> str:
    """Return the reason why reports cannot be written to their places; empty if they can be written."""
    for report in (outputs.report, outputs.junit):
        if report is not None and not report.absolute().parent.is_dir():
            return f"cannot write {report}: there is no folder {report.parent}"
    return ""


def _report(results: RunResults, outputs: Outputs, folder: Path) -> None:
    from robbdd_tools.run.junit import junit

    if outputs.report is not None:
        replace_file(outputs.report, printable_json(results.as_json(), indent=1) + "\n")
    if outputs.junit is not None:
        replace_file(outputs.junit, junit(results, names_by_variant(read_requirements(folder))))


def _record(folder: Path, target: Path) -> None:
    """Write the pictures; failures do not affect verdicts."""
    for render, what, of in (
        (render_violations, "picture", "violated clauses"),
        (render_videos, "video", "scenarios"),
    ):
        try:
            count = render(folder, target)
        except NoPictures as error:
            print_note(f"robbdd: no {what}s: {error}")
        else:
            print_note(f"{count} {what}{'' if count == 1 else 's'} of {of} in {target}")
