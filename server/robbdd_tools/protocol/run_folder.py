"""What a run and its agents share beside messages: names of files in a run folder, environment variables, limits."""

from __future__ import annotations

from pathlib import Path

OWN_STEPS = "model_*steps.py"
"""Pattern of the step files in a run folder that are copies of users' own."""

CRASH = "ROBBDD_CRASH"
"""Environment variable: the path, without ending, of the files that tell where an agent was when it ended."""
LIMIT = "ROBBDD_LIMIT"
"""Environment variable: seconds of wall time that an agent has for each scenario, 0 for any time."""
STARTUP = 120.0
"""Seconds of wall time that an agent has from its start, or from an order, until it starts with the scenario."""
NOTE_SIZE = 4096
"""Bytes of the file ``call_file``."""


def trace_file(folder: Path, index: int) -> Path:
    """Return the path of a scenario's trace."""
    return folder / "traces" / f"{index:06}.mcap"


def curves_file(folder: Path, index: int) -> Path:
    """Return the path of a scenario's margins over time."""
    return folder / "margins" / f"{index:06}.json"


def thumbnail_file(folder: Path, index: int, line: int) -> Path:
    """Return the path of the thumbnail of a violation: scenario, feature line of the clause."""
    return folder / f"{index:06}-{line}.png"


def dump_file(base: Path) -> Path:
    """Return where an agent dumps its stack; ``base`` is what ``CRASH`` names."""
    return base.with_name(f"{base.name}.stack")


def call_file(base: Path) -> Path:
    """Return where an agent notes which code of the user it calls: name, file and line, each with a NUL behind it."""
    return base.with_name(f"{base.name}.call")
