"""``robbdd compare RUN FOLDER``: a folder of logs against a simulated run of the same execution."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from logs.bags import write
from logs.drives import IN_BIN, drive, robbdd
from logs.named_drive import cell, named

pytestmark = pytest.mark.physics
BESIDE = (0.55, 0.0, 0.86)
"""A place on the table, 0.2 m beside the bin."""
RUN = ("run", "real.bddx", "--bhv", "server=pick-place", "--where", "thing=cube0 and goal=left_ws")


def models(folder: Path, *ends: tuple[float, float, float]) -> Path:
    """Write a cell with a folder of logs in which the cube ends at some places; return the folder of its models."""
    path = cell(folder, named())
    for number, end in enumerate(ends):
        write(path.parent / "week" / f"drive{number}", drive(end=end))
    return path.parent


def compared(folder: Path, *more: str) -> tuple[dict[str, Any], str, int]:
    done = robbdd(folder, "compare", "latest", "week", "real.bddx", "--json", "out.json", *more)
    assert (folder / "out.json").is_file(), done.stderr
    document = json.loads((folder / "out.json").read_text(encoding="utf-8"))
    return {one["name"].rpartition(".")[2]: one for one in document["clauses"]}, done.stdout, done.returncode


def test_clauses_that_disagree_are_listed_with_the_change_of_their_margins(tmp_path: Path) -> None:
    folder = models(tmp_path, BESIDE, BESIDE, IN_BIN)
    robbdd(folder, *RUN, "--repeat", "3")
    clauses, text, code = compared(folder)
    assert code == 3, text
    assert "week (3 logs)" in text
    assert "3 shared executions" in text
    assert "compared in pairs" not in text
    goal = clauses["at-goal"]
    assert (goal["before"]["holding"], goal["after"]["holding"]) == (3, 1)
    assert "2 executions with other verdicts" in text
    # The cube ends 55 mm inside the bin or 0.205 m beside it; the simulated one 16 mm inside.
    assert goal["margins"]["difference"] == pytest.approx((2 * -0.205 + 0.055) / 3 - 0.016, abs=0.002)


def test_logs_whose_names_have_no_meaning_are_refused(tmp_path: Path) -> None:
    folder = models(tmp_path, IN_BIN)
    robbdd(folder, *RUN)
    done = robbdd(folder, "compare", "latest", "week", "pickplace.bdd")
    assert done.returncode == 2
    assert "it is not known what its names mean, because no execution names a log in pickplace.bdd" in done.stderr


def test_a_log_that_cannot_be_read_is_refused_by_its_name(tmp_path: Path) -> None:
    folder = models(tmp_path, IN_BIN)
    robbdd(folder, *RUN)
    (folder / "week" / "broken.mcap").write_bytes(b"no mcap")
    done = robbdd(folder, "compare", "latest", "week", "real.bddx")
    assert done.returncode == 2
    assert "broken.mcap" in done.stderr
