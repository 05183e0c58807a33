"""Drives: logs of a cell that carries a cube from a table into a bin, and how the command line judges them."""

from __future__ import annotations

import json
import math
import os
import shutil
import subprocess
from pathlib import Path
from typing import Any

from fork_kit import ROBBDD
from kit import schema_errors
from logs.bags import Message, text, transform, write

ONE = ("--where", "thing=cube0 and goal=left_ws")
"""The arguments that choose the scenario of a drive among those of the example."""
IN_BIN = (0.55, 0.3, 0.86)


def robbdd(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    done = subprocess.run([*ROBBDD, *arguments], capture_output=True, encoding="utf-8", cwd=folder, env=os.environ)
    assert "Traceback" not in done.stderr, done.stderr
    return done


def clauses(path: Path) -> list[dict[str, Any]]:
    document = json.loads(path.read_text(encoding="utf-8"))
    assert schema_errors("run.schema.json", document) == []
    (scenario,) = document["scenarios"]
    return scenario["clauses"]


def drive(
    lost: tuple[float, float] | None = None, end: tuple[float, float, float] = IN_BIN, cube: str = "cube0"
) -> list[Message]:
    """Write what a real cell would record, at 50 Hz for 10 s: a cube is carried from the table to a place.

    The cell observes the cube, the tool and the left bin; the table and the right bin are stated to be where they are.

    From the first to the second time of ``lost``, the cube is not seen; ``cube`` is its frame.
    """
    found = [
        transform("table", (0.5, 0.0, 0.8), stamp=0.0, topic="/tf_static"),
        transform("bin_right", (0.55, -0.3, 0.8), stamp=0.0, topic="/tf_static"),
        text("pick-start", 1.0),
        text("pick-end", 3.0),
        text("place-start", 6.0),
        text("place-end", 8.0),
        text("", 0.0, "/panda/holds"),
        text("cube0", 2.9, "/panda/holds"),
        text("", 7.9, "/panda/holds"),
    ]
    begin = (0.45, 0.0, 0.825)
    for tick in range(501):
        time = tick / 50
        share = min(max((time - 3.0) / 4.0, 0.0), 1.0)
        lift = 0.2 * math.sin(math.pi * share)
        place = [one + share * (other - one) for one, other in zip(begin, end, strict=True)]
        if lost is None or not lost[0] < time < lost[1]:
            found.append(transform(cube, (place[0], place[1], place[2] + lift), stamp=time))
        found.append(transform("bin_left", (0.55, 0.3, 0.8), stamp=time))
        found.append(transform("panda", (place[0], place[1], place[2] + lift), stamp=time))
    return found


def judged(models: Path, folder: Path, messages: list[Message], *more: str) -> tuple[list[dict[str, Any]], str]:
    shutil.rmtree(folder / "drive", ignore_errors=True)
    bag = write(folder / "drive", messages)
    out = folder / "log.json"
    done = robbdd(models, "judge", str(bag), "pickplace.bdd", "--no-store", "--json", str(out), *ONE, *more)
    assert done.returncode in (0, 1), done.stderr
    return clauses(out), done.stderr


def verdicts(found: list[dict[str, Any]]) -> dict[str, str]:
    return {one["name"].rpartition(".")[2]: one["verdict"] for one in found}
