"""The arguments of ``robbdd mutate``. Heavy modules are imported only when the command is used."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.commands.arguments import allow_selection, positive, seed
from robbdd_tools.commands.lost_output import output_may_be_lost
from robbdd_tools.commands.output import fail

if TYPE_CHECKING:
    from robbdd_tools.catalog.robot_faults import RobotFault


def add_mutate(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``robbdd mutate``."""
    parser.add_argument("path", metavar="FILE|DIR", type=Path, nargs="?", help="a model, or a folder of models")
    parser.add_argument("more", metavar="FILE|DIR", type=Path, nargs="*", help="more models")
    parser.add_argument("--list", action="store_true", help="print the known faults, and nothing else")
    text = "only this fault, with another size in its unit; repeats (default: all faults)"
    parser.add_argument("--fault", metavar="NAME[=SIZE]", type=_fault, action="append", help=text)
    text = "only this scenario or execution; repeats"
    parser.add_argument("--scenario", metavar="NAME", action="append", help=text)
    parser.add_argument("--seed", type=seed, default=None, help="seed of all random choices (default: 1)")
    parser.add_argument("--repeat", metavar="N", type=positive, help="execute each scenario N times with each fault")
    text = "agent processes at a time (default: as many as there are cores)"
    parser.add_argument("--jobs", metavar="N", type=positive, help=text)
    allow_selection(parser)
    parser.add_argument("--json", metavar="OUT", type=Path, help="write the matrix to this file")
    parser.add_argument("--markdown", metavar="OUT.md", type=Path, help="write the matrix as Markdown tables")
    parser.set_defaults(command=_mutate)


def _fault(text: str) -> RobotFault:
    from robbdd_tools.catalog.robot_faults import RobotFaultError, robot_fault

    try:
        return robot_fault(text)
    except RobotFaultError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def _mutate(options: argparse.Namespace) -> int:
    from robbdd_tools.catalog.robot_faults import ROBOT_FAULTS
    from robbdd_tools.commands.mutate import MutateOptions, list_faults, mutate
    from robbdd_tools.run.run_policy import Policy
    from robbdd_tools.workbench.plan import Selection

    if options.list:
        return list_faults()
    if options.path is None:
        return fail("name a model or a folder, or --list the known faults")
    selection = Selection(
        options.scenario or (), options.where, options.first, options.sample, options.pairwise, options.seed
    )
    faults = options.fault or tuple(ROBOT_FAULTS.values())
    paths, policy = (options.path, *options.more), Policy.of(jobs=options.jobs)
    with output_may_be_lost():
        return mutate(MutateOptions(paths, selection, faults, policy, options.repeat, options.json, options.markdown))
