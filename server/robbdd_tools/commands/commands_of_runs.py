"""The arguments of the commands about stored runs: runs, replay, judge, compare, report and export."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Protocol

from robbdd_tools.base.graph_formats import graph_format
from robbdd_tools.commands.arguments import positive
from robbdd_tools.commands.log_arguments import allow_log, judge_options
from robbdd_tools.commands.lost_output import output_may_be_lost
from robbdd_tools.commands.run_arguments import allow_policy, allow_store, policy


class AddsCommands(Protocol):
    """The result of ``ArgumentParser.add_subparsers``."""

    def add_parser(self, name: str, *, help: str) -> argparse.ArgumentParser:
        """Add a command."""
        ...


RUN = "number of a stored run, latest, or a run's folder"


def add_commands_of_runs(commands: AddsCommands) -> tuple[argparse.ArgumentParser, ...]:
    """Add the commands, and return those that may execute users' code."""
    _add_runs(commands)
    _add_requirements(commands)
    others = _add_compare(commands), _add_report(commands)
    return _add_replay(commands), _add_judge(commands), *others, _add_export(commands)


def _add_runs(commands: AddsCommands) -> None:
    runs = commands.add_parser("runs", help="list the stored runs of a project")
    runs.add_argument("path", metavar="FILE|DIR", type=Path, nargs="?", default=Path())
    allow_store(runs)
    runs.set_defaults(command=_runs)


def _add_requirements(commands: AddsCommands) -> None:
    listed = commands.add_parser(
        "requirements", help="coverage of requirements by scenarios and stored runs; CSV, ReqIF and graphs"
    )
    listed.add_argument("path", metavar="FILE|DIR|TABLE.csv|SPEC.reqif", type=Path, help="models, or a file to import")
    listed.add_argument("more", metavar="FILE|DIR", type=Path, nargs="*")
    listed.add_argument(
        "-o",
        "--output",
        metavar="OUT",
        type=Path,
        help="write a .csv, a .reqif, a graph (.ttl, .jsonld) or a page (.html); of a table, the model or a graph",
    )
    listed.add_argument("--links-only", action="store_true", help="only whether a scenario verifies each; no results")
    listed.add_argument(
        "--namespace", metavar="IRI", help="import a table or a graph: the namespace of its requirements"
    )
    listed.add_argument("--force", action="store_true", help="replace an existing model")
    allow_store(listed)
    listed.set_defaults(command=_requirements)


def _requirements(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.list_requirements import import_requirements, list_requirements

    is_table = options.path.suffix.lower() in (".csv", ".reqif")
    if is_table or (options.namespace is not None and graph_format(options.path.name)):
        return import_requirements(options.path, options.output, options.namespace, overwrite=options.force)
    paths = (options.path, *options.more)
    return list_requirements(paths, options.store, options.output, links_only=options.links_only)


def _add_replay(commands: AddsCommands) -> argparse.ArgumentParser:
    replay = commands.add_parser("replay", help="simulate a stored run again and check that its traces are identical")
    replay.add_argument("run", metavar="RUN", help=RUN)
    replay.add_argument("--scenario", metavar="NAME", action="append", help="only this scenario; may be repeated")
    replay.add_argument("--force", action="store_true", help="continue even if files have changed since the run")
    allow_policy(replay)
    allow_store(replay)
    replay.set_defaults(command=_replay)
    return replay


def _add_judge(commands: AddsCommands) -> argparse.ArgumentParser:
    judge = commands.add_parser("judge", help="judge a stored run, or the log of a real robot, without simulating")
    text = f"{RUN}; or a log: a ROS bag, an MCAP file, a CSV table; without one, the logs that the executions name"
    judge.add_argument("run", metavar="RUN|LOG", help=text)
    judge.add_argument("path", metavar="FILE|DIR", type=Path, nargs="?")
    judge.add_argument("more", metavar="FILE|DIR", type=Path, nargs="*", help="as for run")
    judge.add_argument("--json", metavar="OUT", type=Path, help="write the results to this file")
    allow_log(judge)
    allow_store(judge)
    judge.set_defaults(command=_judge)
    return judge


def _add_compare(commands: AddsCommands) -> argparse.ArgumentParser:
    compare = commands.add_parser("compare", help="decide whether a run or a study is worse than another one")
    text = f"{RUN}; the results file of `robbdd run --json`; or a study with results, FILE.study[:FACTOR=LEVEL,…]"
    text += "; or a folder of logs of real robots"
    compare.add_argument("before", metavar="BEFORE", help=text)
    compare.add_argument("after", metavar="AFTER", help="as BEFORE")
    compare.add_argument(
        "path",
        metavar="FILE|DIR",
        type=Path,
        nargs="?",
        default=Path(),
        help="a model or folder of the project in whose store the runs are",
    )
    text = "the change that is accepted: 'no clause worse than 2 points', 'at-goal not worse than 5 mm'; repeats"
    compare.add_argument("--gate", metavar="TEXT", action="append", help=text)
    compare.add_argument("--by-margin", action="store_true", help="margins decide, too, not only pass rates")
    text = "confidence level of the intervals and of the decision (default: 0.95)"
    compare.add_argument("--level", metavar="P", type=_level, default=0.95, help=text)
    compare.add_argument("--json", metavar="OUT", type=Path, help="write the comparison to this file")
    text = "write the comparison to this file, for the summary of continuous integration"
    compare.add_argument("--markdown", metavar="OUT", type=Path, help=text)
    text = "write the comparison as one page, with replays of executions that flipped side by side"
    compare.add_argument("--html", metavar="OUT", type=Path, help=text)
    text = "with --html: execute the first N flipped executions of a study again, to show their replays"
    compare.add_argument("--again", metavar="N", type=positive, default=0, help=text)
    text = "agent processes at a time for --again (default: as many as there are cores)"
    compare.add_argument("--jobs", metavar="N", type=positive, help=text)
    allow_store(compare)
    compare.set_defaults(command=_compare)
    return compare


def _add_report(commands: AddsCommands) -> argparse.ArgumentParser:
    report = commands.add_parser("report", help="write the report of a stored run or a study: a page, or a summary")
    report.add_argument("run", metavar="RUN|FILE.study", help=f"{RUN}; or a study")
    report.add_argument("path", metavar="FILE|DIR", type=Path, nargs="?", default=Path(), help="in the run's project")
    text = "a page that needs no network or, for continuous integration, a Markdown summary"
    report.add_argument("-o", "--output", metavar="FILE.html|FILE.md", type=Path, required=True, help=text)
    text = "neither pictures nor replays of the worst executions"
    report.add_argument("--no-pictures", action="store_true", help=text)
    text = "execute the N worst executions of a study again, for their pictures and replays"
    report.add_argument("--again", metavar="N", type=positive, default=0, help=text)
    text = "agent processes at a time for --again (default: as many as there are cores)"
    report.add_argument("--jobs", metavar="N", type=positive, help=text)
    allow_store(report)
    report.set_defaults(command=_report)
    return report


def _add_export(commands: AddsCommands) -> argparse.ArgumentParser:
    export = commands.add_parser("export", help="write a stored run for other programs: ROS 2, Allure Report, Cucumber")
    export.add_argument("run", metavar="RUN", help=RUN)
    form = export.add_mutually_exclusive_group(required=True)
    form.add_argument("--ros2", action="store_true", help="as a rosbag2: transforms, joints, events")
    form.add_argument("--allure", action="store_true", help="results for Allure Report: clauses, margins, pictures")
    text = "Cucumber Messages (NDJSON): features, verdicts, margins, pictures"
    form.add_argument("--messages", action="store_true", help=text)
    text = "a new folder; for --messages, a file"
    export.add_argument("-o", "--output", metavar="DIR|FILE.ndjson", type=Path, required=True, help=text)
    export.add_argument("--mcap", action="store_true", help="store messages as MCAP instead of SQLite")
    export.add_argument("--scenario", metavar="NAME", action="append", help="only this scenario; may be repeated")
    allow_store(export)
    export.set_defaults(command=_export)
    return export


def _level(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = 0.0
    if not 0.5 <= number < 1:
        raise argparse.ArgumentTypeError(f"'{text}' must be a number from 0.5 to less than 1, for example 0.95")
    return number


def _runs(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.runs import list_runs

    return list_runs(options.path, options.store)


def _replay(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.replay import ReplayOptions, replay

    with output_may_be_lost():
        return replay(ReplayOptions(options.run, policy(options), options.scenario or (), options.store, options.force))


def _judge(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.judge import judge

    with output_may_be_lost():
        return judge(judge_options(options))


def _compare(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.compare import CompareOptions, compare
    from robbdd_tools.run.run_policy import Policy

    gates = tuple(options.gate or ())
    return compare(
        CompareOptions(
            options.before,
            options.after,
            options.path,
            options.store,
            gates,
            options.level,
            options.by_margin,
            options.json,
            options.markdown,
            options.html,
            options.again,
            Policy.of(jobs=options.jobs),
        )
    )


def _report(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.write_report import ReportOptions, write_report
    from robbdd_tools.run.run_policy import Policy

    pictures, chosen = not options.no_pictures, Policy.of(jobs=options.jobs)
    return write_report(
        ReportOptions(options.run, options.path, options.output, options.store, pictures, options.again, chosen)
    )


def _export(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.export_run import ExportOptions, export_allure, export_messages, export_run

    chosen = options.scenario or ()
    wanted = ExportOptions(options.run, options.output, chosen, options.store, options.mcap)
    if options.messages:
        return export_messages(wanted)
    return export_allure(wanted) if options.allure else export_run(wanted)
