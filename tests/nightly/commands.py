"""Runs commands of ``robbdd`` inside this process: thousands of cases do not each start an interpreter."""

from __future__ import annotations

import contextlib
import io
import os
from collections.abc import Generator
from dataclasses import dataclass
from pathlib import Path

from robbdd_tools import cli

EXIT_CODES = frozenset({0, 1, 2})


@dataclass(frozen=True, slots=True)
class Done:
    """Exit code and output of a command."""

    code: int
    output: str
    errors: str


def robbdd(folder: Path, *arguments: str) -> Done:
    """Run a command in a folder. Whatever it raises is raised; an exit code of no meaning raises ``AssertionError``."""
    output, errors = io.StringIO(), io.StringIO()
    with _inside(folder), contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
        try:
            code = cli.main(arguments)
        except SystemExit as end:
            code = end.code if isinstance(end.code, int) else 2
    done = Done(code, output.getvalue(), errors.getvalue())
    assert code in EXIT_CODES, f"robbdd {' '.join(arguments)} ends with {code}"
    assert "Traceback" not in done.errors, done.errors
    assert code != 2 or done.errors.strip() or done.output.strip(), f"robbdd {' '.join(arguments)} fails in silence"
    return done


@contextlib.contextmanager
def _inside(folder: Path) -> Generator[None]:
    before = Path.cwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)
