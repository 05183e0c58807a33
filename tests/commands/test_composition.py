"""A part is moved from a tray to the table: its location depends on the scene's composition."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import pytest

from fork_kit import ROBBDD

pytestmark = pytest.mark.physics
SCENE = """ns env = 'https://example.org/composition/'
obj set (ns=env) things { object cube }
obj set (ns=env) furniture { object table, object tray }
ws set (ns=env) places { workspace table_ws, workspace tray_ws }
agn set (ns=env) arms { agent panda }
comp (ns=env) on_tray of ws <places.tray_ws> { obj <furniture.tray> }
comp (ns=env) on_table of ws <places.table_ws> { obj <furniture.table> INNER }
scene (ns=env) room { obj set <things> ws comp <on_table> ws comp <on_tray> agn set <arms> }
"""
MODEL = """import "room.scene"
ns m = 'https://example.org/composition/model/'
Task (ns=m) carry
Event (ns=m) evt-start
Event (ns=m) evt-pick-start
Event (ns=m) evt-place-end
Event (ns=m) evt-end
Scenario Template (ns=m) move {
    duration: from <evt-start> until <evt-end>
    task: <carry>
    var part
    var arm
    var source
    var goal
    Given: there: holds(<part> is located at <source>, before <evt-pick-start>)
    When:
        Behaviour (ns=m) carry_it {
            duration: from <evt-pick-start> until <evt-place-end>
            <arm> picks <part> and places at <goal>
        }
    Then: arrived: holds(<part> is located at <goal>, after <evt-place-end>)
}
User Story (ns=m) clearing {
    As A "planner" I Want "an empty tray" So That "it can be taken away"
    Scenarios:
        Scenario clear {
            template: <move>
            scene: <room>
            variation:
                | <move.part>   | <move.arm>   | <move.source>    | <move.goal>       |
                |---|
                | <things.cube> | <arms.panda> | <places.tray_ws> | <places.table_ws> |
        }
}
"""


@pytest.mark.parametrize("composed", [False, True])
def test_a_tray_is_a_part_of_the_table_only_if_it_is_composed_into_it(tmp_path: Path, composed: bool) -> None:
    (tmp_path / "room.scene").write_text(SCENE.replace("INNER", "ws comp <on_tray>" * composed), encoding="utf-8")
    (tmp_path / "m.bdd").write_text(MODEL, encoding="utf-8")
    command = [*ROBBDD, "run", "m.bdd"]
    done = subprocess.run(command, capture_output=True, encoding="utf-8", cwd=tmp_path, env=dict(os.environ))
    assert done.returncode == 0, done.stdout + done.stderr
    results = json.loads((tmp_path / ".robbdd/runs/1/results.json").read_text(encoding="utf-8"))
    arrived = results["scenarios"][0]["clauses"][-1]
    assert arrived["verdict"] == "holds"
    assert ("already held" in arrived["vacuous"]) == composed
    assert ("arrived proves little" in done.stdout) == composed
