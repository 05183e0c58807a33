"""The arguments of ``robbdd study``. Heavy modules are imported only when a command is used."""

from __future__ import annotations

import argparse
from pathlib import Path

from robbdd_tools.commands.arguments import positive
from robbdd_tools.commands.lost_output import output_may_be_lost
from robbdd_tools.commands.run_arguments import TakesArguments


def add_study(parser: argparse.ArgumentParser) -> tuple[argparse.ArgumentParser, ...]:
    """Add the commands about studies, and return those that execute users' code."""
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    run = commands.add_parser("run", help="execute a study from its beginning")
    text = "remove the results of the study, and execute it from its beginning"
    run.add_argument("--restart", action="store_true", help=text)
    resume = commands.add_parser("resume", help="execute the open executions of a study that ended early")
    for one in (run, resume):
        one.add_argument("path", metavar="FILE.study", type=Path)
        text = "agent processes at a time (default: as many as there are cores)"
        one.add_argument("--jobs", metavar="N", type=positive, help=text)
        _allow_store(one)
        one.set_defaults(command=_run, resumed=one is resume)
    status = commands.add_parser("status", help="print the progress of a study, also while it is executed")
    show = commands.add_parser("show", help="print pass rates by factor and by clause, with intervals")
    export = commands.add_parser("export", help="write one row for each clause of each execution")
    export.add_argument("-o", "--output", metavar="FILE.csv", type=Path, required=True)
    for one, command in ((status, _status), (show, _show), (export, _export)):
        one.add_argument("path", metavar="FILE.study", type=Path)
        _allow_store(one)
        one.set_defaults(command=command)
    return run, resume


def _allow_store(parser: TakesArguments) -> None:
    text = "where studies are kept (default: .robbdd/studies in the project's root)"
    parser.add_argument("--store", metavar="DIR", type=Path, help=text)


def _run(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.study import StudyOptions, run_study

    restart = getattr(options, "restart", False)
    with output_may_be_lost():
        return run_study(StudyOptions(options.path, options.store, options.jobs, options.resumed, restart))


def _status(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.study import print_status

    return print_status(options.path, options.store)


def _show(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.study import print_rates

    return print_rates(options.path, options.store)


def _export(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.study import export_rows

    return export_rows(options.path, options.output, options.store)
