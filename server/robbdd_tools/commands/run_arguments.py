"""Arguments of ``robbdd run`` and related commands. Heavy modules are imported only when an argument is used."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from robbdd_tools.commands.arguments import allow_selection, positive, seed
from robbdd_tools.monitor.without_physics import KINEMATIC

if TYPE_CHECKING:
    from robbdd_tools.commands.resume import ResumeOptions
    from robbdd_tools.commands.run import Outputs, RunOptions
    from robbdd_tools.run.run_policy import Policy


CHOOSING = (
    "scenario", "seed", "repeat", "bhv", "scenex", "rerun_failed", "where", "first", "sample", "pairwise", "no_store",
    "world",
)  # fmt: skip
"""Arguments that define what a new run executes and whether it is kept."""


def allow_run(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of a run."""
    parser.add_argument("--scenario", metavar="NAME", action="append", help="only this scenario or execution; repeats")
    parser.add_argument("--seed", type=seed, default=None, help="seed of all random choices (default: 1)")
    text = "execute each scenario N times, each with a different random seed"
    parser.add_argument("--repeat", metavar="N", type=positive, help=text)
    parser.add_argument("--rerun-failed", action="store_true", help="only what did not hold in the last stored run")
    text = "resume an interrupted run: its number or folder (default: the latest)"
    parser.add_argument("--resume", metavar="RUN", nargs="?", const="latest", help=text)
    text = "execute a catalog behaviour instead of this implementation of a .bddx, such as a ROS action; repeats"
    parser.add_argument("--bhv", metavar="NAME=BEHAVIOUR", type=_substitution, action="append", help=text)
    allow_scenex(parser)
    text = "the simulator; in the kinematic one things move as commanded, and clauses about contacts are unknown"
    parser.add_argument("--world", choices=("physics", KINEMATIC), help=text)
    allow_policy(parser)
    text = "wait for a debugger of Python code on this port of 127.0.0.1; one process, no time limit (default: 5678)"
    parser.add_argument("--debug", metavar="PORT", type=port, nargs="?", const=DEBUGPY_PORT, help=text)
    allow_selection(parser)
    outputs = parser.add_argument_group("outputs")
    outputs.add_argument("--json", metavar="OUT", type=Path, help="write the results to this file")
    outputs.add_argument("--junit", metavar="OUT.xml", type=Path, help="write the results as JUnit XML")
    text = "print every clause of every scenario; of more than 50 scenarios, failures and pass rates are printed"
    outputs.add_argument("--every-clause", action="store_true", help=text)
    text = "write a video of each scenario and a picture of each violation to this folder"
    outputs.add_argument("--record", metavar="DIR", type=Path, help=text)
    outputs.add_argument("--viewer", action="store_true", help="follow each scenario in a window, in real time")
    text = "keep features, manifest, logs and results in this folder instead of the store"
    outputs.add_argument("-o", "--output", metavar="DIR", type=Path, help=text)
    outputs.add_argument("--no-store", action="store_true", help="do not store the run")
    allow_store(outputs)


def argument_problem(options: argparse.Namespace) -> str:
    """Return a message about conflicting arguments; empty if there is none."""
    if options.resume is None:
        return "" if options.path is not None else "name a model or a folder to run, or --resume a run"
    given = [f"--{name.replace('_', '-')}" for name in CHOOSING if getattr(options, name) not in (None, False)]
    given += [] if options.output is None else ["--output"]
    if given:
        return f"--resume executes the run's open scenarios, with its own seed: omit {', '.join(given)}"
    return ""


class TakesArguments(Protocol):
    """Common interface of an argument parser and an argument group."""

    def add_argument(self, *names: str, **options: Any) -> argparse.Action:
        """Add an argument, as ``argparse`` does."""
        ...


def allow_scenex(parser: TakesArguments) -> None:
    """Add the argument that names executable scenes."""
    text = "run scenarios without an execution in the scene instance of this .scenex for their scene; repeats"
    parser.add_argument("--scenex", metavar="FILE", type=Path, action="append", help=text)


MEBIBYTE = 1024 * 1024
DEBUGPY_PORT = 5678
"""The port that debuggers of Python use by default."""


def allow_store(parser: TakesArguments) -> None:
    """Add the argument that names another store."""
    text = "where runs are kept (default: .robbdd/runs in the project's root)"
    parser.add_argument("--store", metavar="DIR", type=Path, help=text)


def allow_policy(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the run policy."""
    text = "agent processes at a time (default: as many as there are cores)"
    parser.add_argument("--jobs", metavar="N", type=positive, help=text)
    text = "wall time limit of each scenario in seconds (default: 300; 0: no limit)"
    parser.add_argument("--timeout", metavar="SECONDS", type=_seconds, help=text)
    text = "MiB kept of each agent process's output, half from its beginning and half from its end (default: 4)"
    parser.add_argument("--log-limit", metavar="MIB", type=positive, help=text)
    parser.add_argument("--stop-on-failure", action="store_true", help="skip all scenarios after the first failure")


def run_options(options: argparse.Namespace) -> RunOptions:
    """Return the run options of the parsed arguments."""
    from robbdd_tools.commands.run import RunOptions
    from robbdd_tools.workbench.plan import Selection

    names = options.scenario or ()
    selection = Selection(
        names,
        options.where,
        options.first,
        options.sample,
        options.pairwise,
        options.seed,
        substitutions=dict(options.bhv or ()),
        world=options.world or "",
    )
    outputs = _outputs(options, keep=not options.no_store)
    return RunOptions(
        (options.path, *options.more),
        selection,
        policy(options),
        outputs,
        options.repeat,
        options.rerun_failed,
        options.viewer,
        tuple(options.scenex or ()),
    )


def resume_options(options: argparse.Namespace) -> ResumeOptions:
    """Return the resume options of the parsed arguments."""
    from robbdd_tools.commands.resume import ResumeOptions

    run, path = options.resume, options.path
    if path is None and Path(run).suffix and Path(run).is_file():
        # argparse takes a model directly after --resume for its value.
        run, path = "latest", Path(run)
    return ResumeOptions(
        run,
        path,
        _outputs(options),
        options.jobs,
        options.timeout,
        options.stop_on_failure,
        viewer=options.viewer,
    )


def _outputs(options: argparse.Namespace, *, keep: bool = True) -> Outputs:
    from robbdd_tools.commands.run import Outputs
    from robbdd_tools.workbench.folder import Keeping

    keeping = Keeping(options.output, options.store, keep)
    return Outputs(options.json, options.junit, options.record, keeping, options.every_clause)


def policy(options: argparse.Namespace) -> Policy:
    """Return the run policy of the parsed arguments."""
    from robbdd_tools.run.debugging import debugged
    from robbdd_tools.run.run_policy import Policy

    found = Policy(stop_on_failure=options.stop_on_failure)
    found = found if options.jobs is None else replace(found, jobs=options.jobs)
    if getattr(options, "debug", None) is not None:
        found = debugged(found, options.debug)
    found = found if options.log_limit is None else replace(found, log_limit=options.log_limit * MEBIBYTE)
    return found if options.timeout is None else replace(found, timeout=options.timeout)


def port(text: str) -> int:
    """Return the number of a port. Raises ``ArgumentTypeError``."""
    if not text.isdecimal() or not 0 < int(text) < 65536:
        raise argparse.ArgumentTypeError(f"'{text}' is not a port: a number from 1 to 65535")
    return int(text)


def _substitution(text: str) -> tuple[str, str]:
    from robbdd_tools.gherkin.select import SelectionError
    from robbdd_tools.workbench.substitution import parse_substitution

    try:
        return parse_substitution(text)
    except SelectionError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def _seconds(text: str) -> float:
    try:
        seconds = float(text)
    except ValueError:
        seconds = -1.0
    if not 0 <= seconds < float("inf"):
        raise argparse.ArgumentTypeError(f"'{text}' is not a number of seconds")
    return seconds
