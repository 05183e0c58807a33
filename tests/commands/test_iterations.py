"""``for all``: each iteration is judged by its own events, by ``run``, ``replay`` and ``judge`` alike."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from fork_kit import ROBBDD
from kit import EXAMPLES

pytestmark = pytest.mark.physics
IN_BIN = "in-its-bin: holds(<part> is located at <bin>, after <evt-end>)"
DURING = "from <evt-pick-start> until <evt-pick-end>)"
EACH = f"""(
                in-its-bin: holds(<part> is located at <bin>, after <evt-place-end>)
                and
                kept: holds(<robot> does not drop <part>, {DURING}
            )"""
BALLS = "| obj set <balls>"
CARELESS = """
from carrying import Carry

class Careless(Carry):
    def reset(self, world, behaviour, arguments):
        super().reset(world, behaviour, arguments)
        self.loses = arguments["object"].endswith("cube1")

    def step(self):
        if self.loses and self._world.holds("env:cube1") and self._world.tool[0][2] > 0.3:
            self._opening = 1.0
        return super().step()
"""
EXECUTION = """import "sorting.bdd"
import "sorter.scenex"
ns run = 'https://example.org/run/'
bhv impl (ns=run) careless { py { module: careless, attr: Careless } }
Scenario Exec (ns=run) careless-run { variant: <sort-bench.kinds-apart> scene inst: <bench> bhv: <careless> }
"""
SCENE = """import "sorter.scene"
ns run = 'https://example.org/run/'
scene inst (ns=run) bench { scene: <sorter_scene> }
"""


def robbdd(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [*ROBBDD, *arguments]
    done = subprocess.run(command, capture_output=True, encoding="utf-8", cwd=folder, env=dict(os.environ))
    assert "Traceback" not in done.stderr
    return done


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Holds the example that sorts two cubes, with clauses on the events of each iteration."""
    shutil.copytree(EXAMPLES / "sorting", tmp_path, dirs_exist_ok=True)
    model = tmp_path / "sorting.bdd"
    text = model.read_text(encoding="utf-8")
    assert IN_BIN in text
    text = text.replace("Event (ns=crit) evt-end", "Event (ns=crit) evt-pick-end\nEvent (ns=crit) evt-end")
    lines = [line for line in text.replace(IN_BIN, EACH).splitlines() if BALLS not in line]
    model.write_text("\n".join(lines), encoding="utf-8")
    return tmp_path


def clauses(folder: Path, name: str) -> list[dict[str, Any]]:
    (scenario,) = json.loads((folder / ".robbdd/runs/1/results.json").read_text(encoding="utf-8"))["scenarios"]
    return [clause for clause in scenario["clauses"] if clause["name"] == name]


def test_each_part_is_judged_when_it_has_been_placed_itself(folder: Path) -> None:
    done = robbdd(folder, "run", "sorting.bdd")
    assert done.returncode == 0, done.stdout
    first, second = clauses(folder, "in-its-bin")
    assert (first["verdict"], second["verdict"]) == ("holds", "holds")
    # The second round lasts seconds.
    assert second["at"] > first["at"] + 2.0
    assert robbdd(folder, "replay", "1").returncode == 0
    judged = robbdd(folder, "judge", "1", "sorting.bdd")
    assert judged.returncode == 0, judged.stdout + judged.stderr


def test_a_part_that_is_lost_in_the_second_round_is_not_saved_by_the_window_of_the_first(folder: Path) -> None:
    shutil.copy(EXAMPLES / "ownrobot" / "carrying.py", folder)
    for name, text in (("careless.py", CARELESS), ("run.bddx", EXECUTION), ("sorter.scenex", SCENE)):
        (folder / name).write_text(text, encoding="utf-8")
    done = robbdd(folder, "run", "run.bddx")
    assert done.returncode == 1, done.stdout + done.stderr
    assert [clause["verdict"] for clause in clauses(folder, "kept")] == ["holds", "violated"]
    (_, lost) = clauses(folder, "kept")
    (_, missed) = clauses(folder, "in-its-bin")
    assert missed["verdict"] == "violated"
    assert missed["at"] > lost["at"] > clauses(folder, "in-its-bin")[0]["at"]
    judged = robbdd(folder, "judge", "1", "run.bddx")
    assert judged.returncode == 1
