"""``robbdd report``: write the report of a stored run or of a study as one HTML page, or as a Markdown summary."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.writing import replace_file
from robbdd_tools.campaign.coverage import goals_of, study_coverage
from robbdd_tools.campaign.report_data import worst
from robbdd_tools.campaign.report_markdown import report_markdown
from robbdd_tools.campaign.report_moments import Moments
from robbdd_tools.campaign.report_page import report_page
from robbdd_tools.campaign.report_source import run_report, study_report, with_traces
from robbdd_tools.campaign.study_again import execute_again
from robbdd_tools.campaign.study_file import SUFFIX
from robbdd_tools.campaign.study_source import names_study, stored_study
from robbdd_tools.commands import OK
from robbdd_tools.commands.output import fail, print_note
from robbdd_tools.commands.run import Outputs, report_problems
from robbdd_tools.commands.runs import print_unfinished
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.workbench.stored import find_run

if TYPE_CHECKING:
    from robbdd_tools.campaign.report_source import ReportSource

MARKDOWN = (".md", ".markdown")


@dataclass(frozen=True, slots=True)
class ReportOptions:
    """The options of ``robbdd report``.

    - ``word``: names a run, a ``.study`` file or a folder with its results; ``path`` is in the run's project.
    - ``output``: a Markdown summary if its suffix is one of ``MARKDOWN``, else an HTML page.
    - ``again``: how many of a study's worst executions are executed again, under ``policy``, for pictures and replays.
    """

    word: str
    path: Path
    output: Path
    store: Path | None = None
    pictures: bool = True
    again: int = 0
    policy: Policy = field(default_factory=Policy)


def write_report(options: ReportOptions) -> int:
    """Write the report; return the exit code."""
    is_study = names_study(options.word)
    if options.again and not (options.word.endswith(SUFFIX) and Path(options.word).is_file()):
        return fail("--again executes a study: name its file (FILE.study)")
    write = _study if is_study else _run
    is_summary = options.output.suffix.lower() in MARKDOWN
    options = replace(options, pictures=options.pictures and not is_summary)

    def work() -> int:
        moments = Moments()
        source = write(options, moments)
        page = report_markdown(source) if is_summary else report_page(source, moments.document(), moments.problem)
        replace_file(options.output, page)
        if moments.problem:
            print_note(f"there are no pictures: {moments.problem}")
        print_note(f"the report is in {options.output}")
        return OK

    return report_problems(Outputs(report=options.output), viewer=False, work=work)


def _run(options: ReportOptions, moments: Moments) -> ReportSource:
    run = find_run(options.word, options.path, store=options.store)
    source = run_report(run)
    print_unfinished(run.place, run.status)
    return replace(source, moments=moments.add(run.place, worst(source.results))) if options.pictures else source


def _study(options: ReportOptions, moments: Moments) -> ReportSource:
    with (
        stored_study(options.word, options.store) as store,
        tempfile.TemporaryDirectory(prefix="robbdd-") as folder,
    ):
        found = study_report(Path(options.word).name, store)
        source = replace(found, coverage=tuple(study_coverage(store, goals_of(Path(options.word)))))
        chosen = [one.index for one in worst(source.results)[: options.again]]
        for again in execute_again(Path(options.word), store, chosen, Path(folder), options.policy) if chosen else ():
            source = with_traces(source, again, moments if options.pictures else None)
    return source
