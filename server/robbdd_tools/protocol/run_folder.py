"""Names of files in a run folder that the agent writes and its parent reads."""

from __future__ import annotations

from pathlib import Path

OWN_STEPS = "model_*steps.py"
"""Pattern of the step files in a run folder that are copies of users' own."""


def trace_file(folder: Path, index: int) -> Path:
    """Return the path of a scenario's trace."""
    return folder / "traces" / f"{index:06}.mcap"


def curves_file(folder: Path, index: int) -> Path:
    """Return the path of a scenario's margins over time."""
    return folder / "margins" / f"{index:06}.json"


def thumbnail_file(folder: Path, index: int, line: int) -> Path:
    """Return the path of the thumbnail of a violation: scenario, feature line of the clause."""
    return folder / f"{index:06}-{line}.png"
