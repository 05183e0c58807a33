"""``robbdd study``: execute a study, continue it, and show its results."""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.processes import CTRL_C, end_requests
from robbdd_tools.campaign.coverage import coverage_lines, goals_of, study_coverage
from robbdd_tools.campaign.stopping import RatioTest, Ruling
from robbdd_tools.campaign.study_clauses import clause_words
from robbdd_tools.campaign.study_cleaning import clean, kept_sizes
from robbdd_tools.campaign.study_file import Study, load_study
from robbdd_tools.campaign.study_place import (
    StudyProblem,
    is_executed,
    open_results,
    remove_results,
    study_folder,
    tally_so_far,
)
from robbdd_tools.campaign.study_rates import study_rates
from robbdd_tools.campaign.study_run import StudyRun
from robbdd_tools.campaign.study_tables import write_table
from robbdd_tools.campaign.study_traces import MEGABYTE
from robbdd_tools.commands import CANNOT_TELL, FAILED, FINDINGS, OK, signal_code
from robbdd_tools.commands.models import print_findings
from robbdd_tools.commands.output import fail, print_line, print_note
from robbdd_tools.commands.rate_lines import level_line, level_lines
from robbdd_tools.commands.study_display import StudyDisplay
from robbdd_tools.commands.study_standing import standing
from robbdd_tools.run.report import margin
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.run.store import store_beside
from robbdd_tools.workbench.time_estimate import TimeEstimate, estimate

if TYPE_CHECKING:
    from robbdd_tools.run.study_reader import StudyReader

RULED = {None: CANNOT_TELL, Ruling.SHOWN: OK, Ruling.REFUTED: FINDINGS}
"""Ruling on a required pass rate → exit code."""
MOST_MISSING = 10
"""At most this many things of each kind that were not exercised are listed."""
INTERRUPTED = "the study was interrupted"
UNMEASURED = "no stored run has their time: it is stated after the first executions"


@dataclass(frozen=True, slots=True)
class StudyOptions:
    """The options of ``robbdd study run`` and, with ``resumed``, of ``robbdd study resume``.

    ``store`` is the folder of all studies. With ``restart``, earlier results are removed. ``scheduler`` is the address
    of a cluster's scheduler, whose workers get the files and folders in ``sent``, too.
    """

    path: Path
    store: Path | None = None
    jobs: int | None = None
    resumed: bool = False
    restart: bool = False
    scheduler: str = ""
    sent: Sequence[Path] = ()


def run_study(options: StudyOptions) -> int:
    """Execute the open executions of a study.

    Returns 0 if all clauses of all executions hold and all coverage goals are met, 1 if not, 2 if the study cannot be
    executed to its end. With a required pass rate, returns 0 if it is shown, 1 if it is refuted, 3 if there are too few
    executions to decide.
    """
    return explained(lambda: _run_study(options))


def print_status(path: Path, store: Path | None) -> int:
    """Print how many executions are finished, and whether a process executes the study.

    Returns 1 if a coverage goal of the study is not met.
    """
    return explained(lambda: _print_status(study_folder(path, store), goals_of(path)))


def print_rates(path: Path, store: Path | None) -> int:
    """Print the pass rates of the levels of each factor, then those of each clause, then the coverage.

    Returns 1 if a coverage goal of the study is not met.
    """
    return explained(lambda: _print_rates(study_folder(path, store), goals_of(path)))


def export_rows(path: Path, output: Path, store: Path | None) -> int:
    """Write one row for each clause of each execution as CSV, Parquet or a DuckDB database."""
    return explained(lambda: _export_rows(study_folder(path, store), output))


def clean_study(path: Path, store: Path | None, *, failures_stay: bool, everything: bool) -> int:
    """Remove everything that a study keeps except its results; with ``everything``, remove the results, too."""

    def work() -> int:
        found = clean(study_folder(path, store), failures_stay=failures_stay, everything=everything)
        results = "the results, " if everything else ""
        megabytes = f"{found.size / MEGABYTE:.1f} MB"
        print_line(f"removed {results}{_counted(found.traces, 'trace')} and {_counted(found.runs, 'run')}: {megabytes}")
        return OK

    return explained(work)


def explained(work: Callable[[], int]) -> int:
    """Execute some work and return its exit code. If it fails, print the reason."""
    try:
        return work()
    except (OSError, RobbddError) as error:
        return fail(_reason(error))


def _reason(error: OSError | RobbddError) -> str:
    if isinstance(error, OSError) and error.filename:
        return f"{error.filename}: {error.strerror or error}"
    return str(error)


def _counted(number: int, word: str) -> str:
    return f"{number:,} {word}{'' if number == 1 else 's'}"


def _run_study(options: StudyOptions) -> int:
    study = load_study(options.path)
    print_findings((one for one in study.findings if one.is_error), print_note)
    if any(one.is_error for one in study.findings):
        return FAILED
    folder = study_folder(options.path, options.store)
    if options.restart:
        remove_results(folder)
    policy = Policy.of(jobs=options.jobs)
    with _begun(study, folder, policy, options) as run:
        expected = _expected(study, policy)
        print_note(f"robbdd: {_announcement(study, run, expected)}")
        display = StudyDisplay(run, jobs=policy.jobs, measures=expected.seconds is None)
        try:
            ended_by = _follow(run, display)
        except OSError as error:
            return fail(f"{_reason(error)}: {_continued(options)}")
        _print_results(run.store)
        if ended_by or run.ending:
            print_note(f"robbdd: {run.ending}: {_continued(options)}")
            return signal_code(ended_by) if ended_by else FAILED
        goals = study.content.goals
        covered = _print_coverage(run.store, goals, most=MOST_MISSING) if goals else OK
        if study.stop is not None:
            ruling = run.ruling()
            print_line("")
            print_line(study.stop.words(ruling))
            if isinstance(study.stop, RatioTest):
                return RULED.get(ruling, CANNOT_TELL) or covered
        return covered if all(total == holding for _, total, holding in run.store.outcomes()) else FINDINGS


@contextmanager
def _begun(study: Study, folder: Path, policy: Policy, options: StudyOptions) -> Generator[StudyRun]:
    if not options.scheduler:
        with StudyRun(study, folder, policy, resumed=options.resumed) as run:
            yield run
        return
    from robbdd_tools.campaign.cluster import Cluster
    from robbdd_tools.campaign.cluster_study import ClusterStudyRun

    missing = next((path for path in options.sent if not path.exists()), None)
    if missing is not None:
        raise StudyProblem(f"--send {missing}: there is no such file or folder")
    with Cluster(options.scheduler, lambda text: print_note(f"robbdd: {text}")) as cluster:
        run = ClusterStudyRun(study, folder, policy, resumed=options.resumed, cluster=cluster, sent=options.sent)
        with run:
            yield run


def _continued(options: StudyOptions) -> str:
    return f"continue with `robbdd study resume {options.path}`"


def _expected(study: Study, policy: Policy) -> TimeEstimate:
    specs = chain.from_iterable(cell.plan.specs(repeat=study.repeat) for cell in study.cells)
    return estimate(specs, store_beside(study.path).database, policy.jobs)


def _announcement(study: Study, run: StudyRun, expected: TimeEstimate) -> str:
    cells = f" in {len(study.cells)} combinations of levels" if len(study.cells) > 1 else ""
    basis = UNMEASURED if expected.seconds is None else expected.basis
    count = len(run.batches)
    return f"{study.name}: {expected}{cells}, {count} {'batch' if count == 1 else 'batches'} ({basis})"


def _follow(run: StudyRun, display: StudyDisplay) -> int:
    """Execute the study and print its progress. Return the number of the signal that ended the study, or 0.

    After the first Ctrl-C, executions in progress finish. A second one, or any other signal, ends them.
    """
    ended_by = 0
    run.warned = display.warn

    def end(number: int) -> None:
        nonlocal ended_by
        is_first, ended_by = not ended_by, number
        if is_first and number == CTRL_C:
            run.drain(INTERRUPTED)
            display.note("finishing the executions in progress; Ctrl-C again ends them now")
        else:
            run.cancel(INTERRUPTED)

    with display, end_requests(end):
        for progress in run.progress():
            display.update(progress)
    return ended_by


def _print_results(store: StudyReader) -> None:
    counts = store.counts()
    if not counts:
        return
    (overall,), *factors = study_rates(counts)
    print_line(level_line(overall))
    for levels in factors:
        for line in level_lines(levels):
            print_line(line)
    print_line("")
    for clause in store.clauses():
        total = clause.holds + clause.violated + clause.unknown
        shown = margin(clause.least, clause.unit)
        least = f"; smallest margin {shown}" if shown else ""
        others = f"{clause.violated} violated, {clause.unknown} unknown"
        print_line(f"{clause_words(clause.name)}: {clause.holds} of {total} hold, {others}{least}")


def _print_status(folder: Path, goals: Mapping[str, float]) -> int:
    with open_results(folder) as store:
        tally = tally_so_far(folder, store)
        state = "in progress" if is_executed(folder) else "not in progress"
        name, total = store.fact("name"), int(store.fact("total") or 0)
        print_line(f"{name}: {tally.finished:,} of {total:,} executions, {state}")
        for line in standing(tally):
            print_line(line)
        traces, size = kept_sizes(folder)
        if traces:
            print_line(f"{_counted(traces, 'trace')}: {size / MEGABYTE:.1f} MB")
        return _print_coverage(store, goals) if goals else OK


def _print_rates(folder: Path, goals: Mapping[str, float]) -> int:
    with open_results(folder) as store:
        _print_results(store)
        print_line("")
        return _print_coverage(store, goals, most=MOST_MISSING)


def _print_coverage(store: StudyReader, goals: Mapping[str, float], most: int = 0) -> int:
    """Print the coverage and up to ``most`` of what each kind lacks; return the exit code of the goals."""
    found = study_coverage(store, goals)
    if not found and goals:
        print_line("coverage: unknown, as an earlier version began the study without recording what it could exercise")
        return FINDINGS
    for line in coverage_lines(found if most else (one for one in found if one.goal is not None), most=most):
        print_line(line)
    return OK if all(one.is_met for one in found) else FINDINGS


def _export_rows(folder: Path, output: Path) -> int:
    with open_results(folder) as store:
        write_table(store, output)
        number = sum(total for _, total, _ in store.outcomes())
    print_note(f"{number} executions in {output}")
    return OK
