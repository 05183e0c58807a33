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
        text = "execute the study on a cluster: the address of its Dask scheduler, such as tcp://host:8786"
        one.add_argument("--scheduler", metavar="ADDRESS", default="", help=text)
        text = "also send this file or folder, which users' code reads, to the workers; may be repeated"
        one.add_argument("--send", metavar="PATH", action="append", type=Path, default=[], help=text)
        text = "connect to endpoints on this host; may be repeated (always: endpoint-hosts in your settings)"
        one.add_argument("--allow-host", metavar="HOST", action="append", help=text)
        _allow_store(one)
        one.set_defaults(command=_run, resumed=one is resume)
    status = commands.add_parser("status", help="print the progress of a study, also while it is executed")
    show = commands.add_parser("show", help="print pass rates by factor and by clause, with intervals")
    export = commands.add_parser("export", help="write one row for each clause of each execution")
    text = "a CSV file; or .parquet or .duckdb (needs robbdd-tools[analysis])"
    export.add_argument("-o", "--output", metavar="FILE", type=Path, required=True, help=text)
    for one, command in ((status, _status), (show, _show), (export, _export)):
        one.add_argument("path", metavar="FILE.study", type=Path)
        _allow_store(one)
        one.set_defaults(command=command)
    _add_clean(commands.add_parser("clean", help="remove traces and replayed runs of a study, or all of its results"))
    replay = _add_replay(commands.add_parser("replay", help="execute executions of a study again, with traces"))
    outcomes = commands.add_parser("outcomes", help="count executions by factors and by their first violated clause")
    text = "factors or variables, such as robot,scale (default: all with several levels)"
    outcomes.add_argument("--by", metavar="NAME,…", type=_names, default=(), help=text)
    outcomes.set_defaults(command=_outcomes)
    margins = commands.add_parser("margins", help="print quantiles of the margins of a clause in executions that hold")
    margins.add_argument("--clause", metavar="NAME", required=True, help="name of the clause")
    margins.add_argument("--by", metavar="NAME", required=True, help="factor or variable")
    margins.set_defaults(command=_margins)
    for one in (outcomes, margins):
        one.add_argument("path", metavar="FILE.study", type=Path)
        text = "also draw it, as .svg, .png or .pdf (needs robbdd-tools[plots])"
        one.add_argument("--plot", metavar="FILE", type=Path, help=text)
        _allow_store(one)
    _add_plan(commands.add_parser("plan", help="print how many executions a wanted interval or comparison needs"))
    return run, resume, replay


def _add_clean(clean: argparse.ArgumentParser) -> None:
    clean.add_argument("path", metavar="FILE.study", type=Path)
    chosen = clean.add_mutually_exclusive_group()
    chosen.add_argument("--passed", action="store_true", help="only the traces of executions that hold")
    chosen.add_argument("--all", action="store_true", help="also the results, and the study can begin again")
    _allow_store(clean)
    clean.set_defaults(command=_clean)


def _add_replay(replay: argparse.ArgumentParser) -> argparse.ArgumentParser:
    replay.add_argument("path", metavar="FILE.study", type=Path)
    text = "numbers of executions, as in the export (default: all that the options choose)"
    replay.add_argument("numbers", metavar="NUMBER", type=positive, nargs="*", help=text)
    replay.add_argument("--failures", action="store_true", help="executions in which a clause does not hold")
    text = "executions in which the clause of this name does not hold"
    replay.add_argument("--clause", metavar="NAME", default="", help=text)
    replay.add_argument("--first", metavar="N", type=positive, help="at most N of them, in the order of the study")
    text = "agent processes at a time (default: as many as there are cores)"
    replay.add_argument("--jobs", metavar="N", type=positive, help=text)
    text = "execute with the current models and files, even if they have changed since the study"
    replay.add_argument("--force", action="store_true", help=text)
    text = "connect to endpoints on this host; may be repeated (always: endpoint-hosts in your settings)"
    replay.add_argument("--allow-host", metavar="HOST", action="append", help=text)
    _allow_store(replay)
    replay.set_defaults(command=_replay)
    return replay


def _add_plan(plan: argparse.ArgumentParser) -> None:
    plan.add_argument("--rate", metavar="P", type=float, default=0.9, help="the expected pass rate (default: 0.9)")
    plan.add_argument("--width", metavar="W", type=float, help="the wanted width of its interval, such as 0.05")
    text = "the change of the pass rate that a comparison is to show, such as -0.05"
    plan.add_argument("--difference", metavar="D", type=float, help=text)
    text = "the share of pairs with equal seeds in which the two verdicts differ (default: the size of the difference)"
    plan.add_argument("--discordance", metavar="P", type=float, help=text)
    plan.add_argument("--power", metavar="P", type=_between, default=0.8, help="probability to show it (default: 0.8)")
    plan.add_argument("--level", metavar="P", type=_between, default=0.95, help="confidence level (default: 0.95)")
    plan.set_defaults(command=_plan)


def _names(text: str) -> tuple[str, ...]:
    return tuple(name.strip() for name in text.split(",") if name.strip())


def _between(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = 0.0
    if not 0.5 <= number < 1:
        raise argparse.ArgumentTypeError(f"'{text}' must be a number from 0.5 to less than 1, for example 0.95")
    return number


def _allow_store(parser: TakesArguments) -> None:
    text = "where studies are kept (default: .robbdd/studies in the project's root)"
    parser.add_argument("--store", metavar="DIR", type=Path, help=text)


def _run(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.study import StudyOptions, run_study

    restart = getattr(options, "restart", False)
    with output_may_be_lost():
        chosen = (options.path, options.store, options.jobs, options.resumed, restart)
        return run_study(StudyOptions(*chosen, options.scheduler, options.send))


def _clean(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.study import clean_study

    return clean_study(options.path, options.store, failures_stay=options.passed, everything=options.all)


def _replay(options: argparse.Namespace) -> int:
    from robbdd_tools.campaign.study_replay import Chosen
    from robbdd_tools.commands.replay_executions import ReplayOptions, replay_study
    from robbdd_tools.commands.study import explained

    chosen = Chosen(options.numbers, options.failures, options.clause, options.first)
    wanted = ReplayOptions(options.path, chosen, options.store, options.jobs, options.force)
    with output_may_be_lost():
        return explained(lambda: replay_study(wanted))


def _status(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.study import print_status

    return print_status(options.path, options.store)


def _show(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.study import print_rates

    return print_rates(options.path, options.store)


def _export(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.study import export_rows

    return export_rows(options.path, options.output, options.store)


def _outcomes(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.study_results import print_outcomes

    return print_outcomes(options.path, options.store, options.by, options.plot)


def _margins(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.study_results import print_margins

    return print_margins(options.path, options.store, options.clause, options.by, options.plot)


def _plan(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.study_plan import PlanOptions, print_plan

    shares = (options.rate, options.width, options.difference, options.discordance, options.power, options.level)
    return print_plan(PlanOptions(*shares))
