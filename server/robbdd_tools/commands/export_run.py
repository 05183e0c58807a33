"""``robbdd export``: write a stored run as ROS 2 bags, as results for Allure Report, or as Cucumber Messages."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from robbdd_tools.base.writing import replace_file
from robbdd_tools.campaign.allure_results import write_allure
from robbdd_tools.campaign.message_export import write_messages
from robbdd_tools.commands import OK
from robbdd_tools.commands.output import fail, print_line, print_note
from robbdd_tools.commands.run import Outputs, report_problems
from robbdd_tools.workbench.bag_export import export_bags
from robbdd_tools.workbench.stored import find_run, kept_store


@dataclass(frozen=True, slots=True)
class ExportOptions:
    """The options of ``robbdd export``: the run, the folder or file to write, and how bags are stored."""

    run: str
    output: Path
    names: Sequence[str] = ()
    store: Path | None = None
    mcap: bool = False


def export_run(options: ExportOptions) -> int:
    """Write the bags and print their folders. Return the exit code."""
    return report_problems(Outputs(), viewer=False, work=lambda: _export(options))


def export_allure(options: ExportOptions) -> int:
    """Write the results for Allure Report and print their number. Return the exit code."""
    if options.mcap:
        return fail("--mcap is a format of bags: leave it out, or write --ros2 instead of --allure")

    def work() -> int:
        count, problem = write_allure(find_run(options.run, store=options.store), options.output, options.names)
        if problem:
            print_note(f"there are no pictures: {problem}")
        print_line(f"{count} result{'s' * (count != 1)} in {options.output}")
        return OK

    return report_problems(Outputs(), viewer=False, work=work)


def export_messages(options: ExportOptions) -> int:
    """Write Cucumber Messages into a file and print the number of executions. Return the exit code."""
    if options.mcap or options.names:
        return fail("--mcap and --scenario are for other formats: leave them out, as messages are of a whole run")

    def work() -> int:
        text, count, problem = write_messages(find_run(options.run, store=options.store))
        replace_file(options.output, text)
        if problem:
            print_note(f"there are no pictures: {problem}")
        print_line(f"{count} execution{'s' * (count != 1)} in {options.output}")
        return OK

    return report_problems(Outputs(report=options.output), viewer=False, work=work)


def _export(options: ExportOptions) -> int:
    place = kept_store(Path(), options.store).find(options.run)
    for folder in export_bags(place, options.output, options.names, mcap=options.mcap):
        print_line(str(folder))
    return OK
