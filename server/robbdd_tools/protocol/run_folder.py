"""The names of files in a run folder that the agent writes and its parent reads."""

from __future__ import annotations

from pathlib import Path

OWN_STEPS = "model_*steps.py"
"""Pattern of the files in a run's folder of steps that are copies of users' own."""


def trace_file(folder: Path, index: int) -> Path:
    """Return where the trace of a scenario of a run is."""
    return folder / "traces" / f"{index:06}.mcap"


def curves_file(folder: Path, index: int) -> Path:
    """Return where the margins over time of a scenario of a run are."""
    return folder / "margins" / f"{index:06}.json"


def thumbnail_file(folder: Path, index: int, line: int) -> Path:
    """Return where the small picture of a violation is: scenario, feature line of the clause."""
    return folder / f"{index:06}-{line}.png"
