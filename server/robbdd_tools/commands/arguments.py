"""Arguments that several commands share. Heavy modules are imported only when an argument is used."""

from __future__ import annotations

import argparse
from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.gherkin.select import Wanted


def allow_selection(parser: argparse.ArgumentParser) -> None:
    """Add the arguments that select scenarios to a parser that already has ``--seed``."""
    selection = parser.add_argument_group("selection of scenarios")
    text = "only scenarios with these values: 'robot=panda and target=~cube.*'"
    selection.add_argument("--where", metavar="EXPRESSION", help=text)
    amount = selection.add_mutually_exclusive_group()
    amount.add_argument("--first", metavar="N", type=positive, help="only the first N")
    amount.add_argument("--sample", metavar="N", type=positive, help="N drawn at random with the seed")
    text = "a small set that covers all value combinations of any 2 (default) or 3 variables"
    amount.add_argument("--pairwise", metavar="2|3", type=int, nargs="?", const=2, choices=(2, 3), help=text)


def wanted(options: argparse.Namespace) -> Wanted:
    """Return the selection of the parsed arguments."""
    from robbdd_tools.gherkin.select import Wanted

    found = Wanted(options.where, options.first, options.sample, options.pairwise)
    return found if options.seed is None else replace(found, seed=options.seed)


def seed(text: str) -> int:
    """Parse a seed that the database of results can store; raises ``ArgumentTypeError``."""
    from robbdd_tools.syntax.study_content import MOST_SEED

    try:
        number = int(text)
    except ValueError:
        number = MOST_SEED + 1
    if abs(number) > MOST_SEED:
        raise argparse.ArgumentTypeError(f"'{text[:40]}' is not a whole number from -{MOST_SEED} to {MOST_SEED}")
    return number


def positive(text: str) -> int:
    """Parse a number above 0; raises ``ArgumentTypeError``."""
    number = int(text) if text.isdecimal() else 0
    if number < 1:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number above 0")
    return number
