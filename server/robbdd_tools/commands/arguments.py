"""Arguments that several commands share. Loads nothing until they are used."""

from __future__ import annotations

import argparse
from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.gherkin.select import Wanted
    from robbdd_tools.run.scheduler import Policy


def allow_selection(parser: argparse.ArgumentParser) -> None:
    """Add the arguments that select scenarios; the parser has ``--seed``."""
    selection = parser.add_argument_group("selection of scenarios")
    text = "only scenarios with such values: 'robot=panda and target=~cube.*'"
    selection.add_argument("--where", metavar="EXPRESSION", help=text)
    amount = selection.add_mutually_exclusive_group()
    amount.add_argument("--first", metavar="N", type=_positive, help="only the first N")
    amount.add_argument("--sample", metavar="N", type=_positive, help="N drawn at random by the seed")
    text = "few that cover all combinations of 2 (default) or 3 variables"
    amount.add_argument("--pairwise", metavar="2|3", type=int, nargs="?", const=2, choices=(2, 3), help=text)


def wanted(options: argparse.Namespace) -> Wanted:
    """Return the selection that the parsed arguments describe."""
    from robbdd_tools.gherkin.select import Wanted

    found = Wanted(options.where, options.first, options.sample, options.pairwise)
    return found if options.seed is None else replace(found, seed=options.seed)


def allow_policy(parser: argparse.ArgumentParser) -> None:
    """Add the arguments that say how a run goes."""
    text = "agent processes at a time (default: as many as there are cores)"
    parser.add_argument("--jobs", metavar="N", type=_positive, help=text)
    text = "wall time that a scenario may take (default: 300; 0: any)"
    parser.add_argument("--timeout", metavar="SECONDS", type=_seconds, help=text)
    parser.add_argument("--stop-on-failure", action="store_true", help="leave out what comes after the first failure")


def policy(options: argparse.Namespace) -> Policy:
    """Return how the parsed arguments want a run to go."""
    from robbdd_tools.run.scheduler import Policy

    found = Policy(stop_on_failure=options.stop_on_failure)
    found = found if options.jobs is None else replace(found, jobs=options.jobs)
    return found if options.timeout is None else replace(found, timeout=options.timeout)


def _seconds(text: str) -> float:
    try:
        seconds = float(text)
    except ValueError:
        seconds = -1.0
    if not 0 <= seconds < float("inf"):
        raise argparse.ArgumentTypeError(f"'{text}' is not a number of seconds")
    return seconds


def _positive(text: str) -> int:
    number = int(text) if text.isdecimal() else 0
    if number < 1:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number above 0")
    return number
