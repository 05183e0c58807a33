"""``robbdd-lsp``: starts the language server over standard input and output."""

from __future__ import annotations

import argparse
import logging
import sys
from collections.abc import Sequence
from pathlib import Path

from robbdd_tools import __version__


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the server until its client ends it; returns the exit code."""
    parser = argparse.ArgumentParser("robbdd-lsp", description="Language server for RobBDD models.")
    parser.add_argument("--version", action="version", version=f"robbdd-lsp {__version__}")
    parser.add_argument("--stdio", action="store_true", help="talk over standard input and output (the default)")
    parser.add_argument("--log-file", type=Path, metavar="FILE", help="write a log to this file")
    options = parser.parse_args(arguments)
    _log_to(options.log_file)

    from robbdd_tools.base.memory import collect_rarely
    from robbdd_tools.lsp.handlers import create_server

    collect_rarely()
    create_server().start_io()
    return 0


def _log_to(file: Path | None) -> None:
    """Log warnings to standard error, or everything of ours to a file; standard output belongs to the protocol."""
    handler = logging.StreamHandler(sys.stderr) if file is None else logging.FileHandler(file, encoding="utf-8")
    handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(name)s: %(message)s"))
    logging.getLogger().addHandler(handler)
    # pygls warns of every cancelled request that was answered already, which is what editors do all the time.
    logging.getLogger("pygls").setLevel(logging.ERROR)
    logging.getLogger("robbdd_tools").setLevel(logging.WARNING if file is None else logging.DEBUG)


if __name__ == "__main__":
    sys.exit(main())
