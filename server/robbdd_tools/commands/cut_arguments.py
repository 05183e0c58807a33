"""The arguments of ``robbdd cut``. Heavy modules are imported only when the command is used."""

from __future__ import annotations

import argparse
from pathlib import Path

THRESHOLD = 0.05
LEAST, MOST = 0.01, 1.0
"""The range that CoACD accepts."""


def add_cut(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``robbdd cut``."""
    parser.add_argument("path", metavar="FILE", type=Path, help="a mesh, or an MJCF or URDF file with hollow meshes")
    text = f"largest concavity of a piece, {LEAST} to {MOST:g} (default: {THRESHOLD}); a smaller one gives more pieces"
    parser.add_argument("--threshold", metavar="X", type=_threshold, default=THRESHOLD, help=text)
    parser.add_argument("--force", action="store_true", help="cut meshes again that have been cut")
    parser.set_defaults(command=_cut)


def _threshold(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not LEAST <= value <= MOST:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number from {LEAST} to {MOST:g}")
    return value


def _cut(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.cut import cut

    return cut(options.path, options.threshold, again=options.force)
