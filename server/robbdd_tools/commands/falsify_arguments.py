"""The arguments of ``robbdd falsify``. Heavy modules are imported only when the command is used."""

from __future__ import annotations

import argparse
from math import isfinite
from pathlib import Path

from robbdd_tools.commands.arguments import positive, seed
from robbdd_tools.commands.lost_output import output_may_be_lost

METHODS = ("boundary", "cma-es", "sobol", "uniform")


def add_falsify(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``robbdd falsify``."""
    parser.add_argument("path", metavar="FILE.study", type=Path)
    text = "search at most N points (default: 200); reducing a failure takes some points beyond these"
    parser.add_argument("--budget", metavar="N", type=positive, default=200, help=text)
    text = "how points are chosen (default: boundary, which needs robbdd-tools[search], as cma-es does)"
    parser.add_argument("--method", choices=METHODS, default=METHODS[0], help=text)
    text = "value from which the search begins (default: the middle of its range); repeats"
    parser.add_argument("--nominal", metavar="VARIABLE=VALUE", type=_value, action="append", help=text)
    parser.add_argument(
        "--seed", type=seed, default=None, help="seed of the search and of executions (default: the study's)"
    )
    text = "agent processes at a time (default: as many as there are cores)"
    parser.add_argument("--jobs", metavar="N", type=positive, help=text)
    parser.add_argument("--json", metavar="OUT", type=Path, help="write the failure to this file")
    parser.set_defaults(command=_falsify)


def _value(text: str) -> tuple[str, float]:
    name, _, written = text.partition("=")
    try:
        value = float(written)
    except ValueError:
        value = float("nan")
    if not name or not isfinite(value):
        raise argparse.ArgumentTypeError(f"'{text}' is not VARIABLE=VALUE, for example speed=0.5")
    return name, value


def _falsify(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.falsify import FalsifyOptions, falsify

    stated: list[tuple[str, float]] = options.nominal or []
    nominal = dict(stated)
    with output_may_be_lost():
        return falsify(
            FalsifyOptions(
                options.path, options.budget, options.method, options.seed, nominal, options.jobs, options.json
            )
        )
