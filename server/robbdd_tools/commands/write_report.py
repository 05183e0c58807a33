"""``robbdd report``: write the report of a stored run as one HTML page."""

from __future__ import annotations

from pathlib import Path

from robbdd_tools.base.writing import replace_file
from robbdd_tools.campaign.report_page import report_page
from robbdd_tools.commands import OK
from robbdd_tools.commands.output import print_note
from robbdd_tools.commands.run import Outputs, report_problems
from robbdd_tools.commands.runs import print_unfinished
from robbdd_tools.workbench.stored import find_run


def write_report(word: str, path: Path, output: Path, store: Path | None) -> int:
    """Write the report of the run that ``word`` names; return the exit code."""

    def work() -> int:
        run = find_run(word, path, store=store)
        replace_file(output, report_page(run))
        print_unfinished(run.place, run.status)
        print_note(f"the report is in {output}")
        return OK

    return report_problems(Outputs(report=output), viewer=False, work=work)
