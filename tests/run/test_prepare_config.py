"""The manifest contains the configurations of Given clauses, with each scenario's values."""

from __future__ import annotations

from pathlib import Path

from kit import MODEL, SCENE, fixture
from robbdd_tools.graph.read.acceptance import read_model
from robbdd_tools.graph.write.build import build_graph
from robbdd_tools.protocol.manifest_file import read_manifest
from robbdd_tools.protocol.specs import ConfigSpec, Manifest
from robbdd_tools.run.prepare import RunRequest, prepare

GIVEN = "holds(<part> is located at"


def manifest(folder: Path, given: str) -> Manifest:
    start = MODEL.index("    Given:\n") + len("    Given:\n")
    end = MODEL.index("    When:")
    text = f"{MODEL[:start]}        {given}\n{MODEL[end:]}"
    text = text.replace("    var goal\n", "    var goal\n    var value\n    set var some\n")
    text = text.replace(
        "<places.tray_ws> }\n",
        '<places.tray_ws> }\n                var <fetch.value>: { 0.5, "dense" }\n'
        "                set var <fetch.some>: { { <parts.bolt>, <parts.nut> } }\n",
    )
    case = fixture(f"//- main.bdd\n{text}\n//- lab.scene\n{SCENE}")
    return prepare(RunRequest(read_model(build_graph(case.snapshot, case.uri).graph), "main.bdd"), folder)


def test_each_scenario_carries_the_configuration_of_its_values(tmp_path: Path) -> None:
    written = manifest(tmp_path, "set-up: holds(<robot> has config ee_speed = <value>, before <start>)")
    assert read_manifest(tmp_path) == written
    assert [scenario.scene.config for scenario in written.scenarios[:2]] == [
        (ConfigSpec("env:panda", "ee_speed", "0.5"),),
        (ConfigSpec("env:panda", "ee_speed", "dense"),),
    ]


def test_clauses_joined_by_and_are_all_applied_alternatives_are_not(tmp_path: Path) -> None:
    mass, friction = (
        f"{name}: holds(<part> has config {name} = <value>, before <start>)" for name in ("mass", "friction")
    )
    both = manifest(tmp_path / "and", f"({mass} and {friction})").scenarios[0].scene.config
    assert [config.name for config in both] == ["mass", "friction"]
    assert manifest(tmp_path / "or", f"({mass} or {friction})").scenarios[0].scene.config == ()


def test_a_set_as_a_target_stands_for_its_elements(tmp_path: Path) -> None:
    written = manifest(tmp_path, "set-up: holds(<some> has config mass = <value>, before <start>)")
    assert [config.target for config in written.scenarios[0].scene.config] == ["env:bolt", "env:nut"]
