"""Exports of studies, to compare their bytes."""

from __future__ import annotations

from pathlib import Path

from robbdd_tools.cli import main


def exported(path: Path) -> bytes:
    """Return the results of a study as CSV."""
    target = path.with_suffix(".csv")
    assert main(["study", "export", str(path), "-o", str(target)]) == 0
    return target.read_bytes()
