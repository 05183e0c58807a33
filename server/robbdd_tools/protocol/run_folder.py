"""Constants that a run and its agents share: names of files in a run folder, environment variables and limits."""

from __future__ import annotations

from pathlib import Path

OWN_STEPS = "model_*steps.py"
"""Pattern of the step files in a run folder that are copies of users' files."""

CRASH = "ROBBDD_CRASH"
"""Environment variable: the path, without extension, of the files that record where an agent was when it crashed."""
LIMIT = "ROBBDD_LIMIT"
"""Environment variable: limit of an agent's wall time per scenario, s; 0: no limit."""
DEBUG_PORT = "ROBBDD_DEBUG_PORT"
"""Environment variable: the port on which an agent waits for a debugger."""
PAUSING = "ROBBDD_PAUSING"
"""Environment variable: if set, a debugger controls the pauses of an agent by its orders (``protocol.pauses``)."""
DEBUG_HOST = "127.0.0.1"
"""Address of the debugger's port. Its clients can execute code, so other machines must not reach it."""
STARTUP = 120.0
"""Limit of the wall time (s) from an agent's start, or from an order, to the start of the scenario."""
NOTE_SIZE = 4096
"""Size (bytes) of the file ``call_file``."""


def trace_file(folder: Path, index: int) -> Path:
    """Return the path of a scenario's trace."""
    return folder / "traces" / f"{index:06}.mcap"


def curves_file(folder: Path, index: int) -> Path:
    """Return the path of a scenario's margins over time."""
    return folder / "margins" / f"{index:06}.json"


def thumbnail_file(folder: Path, index: int, line: int) -> Path:
    """Return the path of the thumbnail of a violation.

    ``index`` is the number of the scenario, ``line`` the feature line.
    """
    return folder / f"{index:06}-{line}.png"


def dump_file(base: Path) -> Path:
    """Return the path of an agent's stack dump. ``base`` is the value of the environment variable ``CRASH``."""
    return base.with_name(f"{base.name}.stack")


def call_file(base: Path) -> Path:
    """Return the path of the file in which an agent records its calls of user code.

    The file contains the name, the file and the line of the call, each followed by a NUL.
    """
    return base.with_name(f"{base.name}.call")
