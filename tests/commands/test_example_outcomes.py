"""Examples of requirements from practice: some scenarios pass, and the others fail for the stated reason.

The handover, deadlines and limits have tests of their own.
"""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from kit import EXAMPLES
from robbdd_tools.cli import main

pytestmark = pytest.mark.physics

OUTCOMES: dict[str, tuple[str, list[list[str]], str]] = {
    "nearperson": (
        "nearperson.bddx",
        [[], ["slow-near-person"]],
        'Then "env:panda" moves slower than "0.25 m/s" whenever "env:panda" is nearer than "0.6 m" to "env:person"',
    ),
    "level": (
        "level.bddx",
        [[], ["level"]],
        'Then "env:hammer" is tilted less than "5 deg" whenever "env:hammer" is held by "env:panda"',
    ),
    "rim": ("rim.bddx", [[], ["rim-untouched"]], 'Then "env:box" does not touch "env:rim"'),
    "rightbin": (
        "rightbin.bdd",
        [[], [], ["right-bin"]],
        'Then "env:red_ws" is correct for "env:cube_2" after event "rb:evt-place-end"',
    ),
    "basicmanipulation": (
        "basicmanipulation.bdd",
        [[], [], ["right-container"], ["container-stays", "in-container"]],
        'Then "env:box_profile" does not collide with "env:blue" from "bmt:evt-place-start" until "bmt:evt-end"',
    ),
    "transportation": (
        "transportation.bddx",
        [[], ["barrier-stays"]],
        'Then "env:mobile_panda" does not collide "env:barrier_bin" from "btt:evt-start" until "btt:evt-end"',
    ),
    "namedpredicates": (
        "namedpredicates.bdd",
        [[], ["stored", "handed-over"]],
        'Then "env:cube" is-stored in "env:belt_ws" for 0.5 seconds after event "np:evt-place-end"',
    ),
}
"""Example → its file to run, the clauses of each scenario that are violated, and a sentence of its features."""


@pytest.mark.parametrize("example", OUTCOMES)
def test_an_example_passes_and_fails_for_the_reason_that_it_names(
    example: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(shutil.copytree(EXAMPLES / example, tmp_path / example))
    file, violated, sentence = OUTCOMES[example]
    assert main(["run", file, "--seed", "1", "--json", "run.json"]) == 1
    document: Any = json.loads(Path("run.json").read_text(encoding="utf-8"))
    found = [
        {verdict: sorted(one["name"] for one in scenario["clauses"] if one["verdict"] == verdict) for verdict in OTHERS}
        for scenario in document["scenarios"]
    ]
    assert found == [{"violated": sorted(names), "unknown": []} for names in violated]
    assert main(["gherkin", file, "-o", "out"]) == 0
    features = "".join(path.read_text(encoding="utf-8") for path in Path("out", "features").rglob("*.feature"))
    assert sentence in features


OTHERS = ("violated", "unknown")
"""Verdicts of clauses that do not hold."""


def test_a_billet_is_put_into_the_vise_and_lost_if_the_jaws_press_too_little(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(shutil.copytree(EXAMPLES / "tending", tmp_path / "tending"))
    assert main(["run", "tending.bddx", "--json", "run.json"]) == 1
    document: Any = json.loads(Path("run.json").read_text(encoding="utf-8"))
    loaded, other, lost = ({one["name"]: one for one in scenario["clauses"]} for scenario in document["scenarios"])
    assert {one["verdict"] for one in (*loaded.values(), *other.values())} == {"holds"}
    behaviour = lost["when-bhv-load-vise.when"]
    assert behaviour["verdict"] == "violated"
    assert "its weight is 3.18 N, and its friction in the fingers bears 2.4 N" in behaviour["reason"]
    assert {name for name, one in lost.items() if one["verdict"] == "unknown"} == {"in-vise", "level", "in-time"}
