"""Models that cannot be used and given poses that overlap are reported without a run, and while editing."""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path

import pytest

from kit import EXAMPLES
from robbdd_tools.base.diagnostic import Diagnostic
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.base.limits import MIB, SCENE_MEMORY, SCENE_SECONDS
from robbdd_tools.graph.shapes.project_shapes import EditorShapes
from robbdd_tools.lsp.framing import Answer, Forget, Request
from robbdd_tools.lsp.worker import Inbox, Worker
from robbdd_tools.names.project import Project
from robbdd_tools.workbench import scene_findings
from robbdd_tools.workbench.model import load
from robbdd_tools.workbench.scene_findings import SceneChecker

ON_THE_TABLE, IN_THE_TABLE = "xyz: (-100, 500, 0) mm", "xyz: (-100, 500, -20) mm"
MADE = "model five_model as mjcf { py { module: making, attr: five }"


@pytest.fixture
def cell(tmp_path: Path) -> Path:
    """Return the scene instance of a copy of the example with an own robot."""
    shutil.copytree(EXAMPLES / "ownrobot", tmp_path / "cell")
    return tmp_path / "cell" / "cell.scenex"


def rewrite(path: Path, *changes: tuple[str, str]) -> None:
    text = path.read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    path.write_text(text, encoding="utf-8")


def found(path: Path) -> list[str]:
    return [str(finding).partition(":")[2] for finding in load(path).scene_findings]


def test_overlaps_and_unusable_models_are_reported_with_their_places(cell: Path) -> None:
    rewrite(cell, (ON_THE_TABLE, IN_THE_TABLE), ("home: (0,", "home: (9,"))
    unusable, overlap = found(cell.with_name("tidy.bddx"))
    assert unusable == (
        "78:20: warning: the home position 9 of the joint 'yaw' is outside its limits, -3 to 3 in five.xml"
        " [unusable-model]"
    )
    assert overlap == "65:10: warning: 'bin' and 'table' overlap by 20 mm: nothing may overlap at the start [overlap]"


def test_data_about_an_arm_of_the_catalog_are_refused_instead_of_ignored(cell: Path) -> None:
    rewrite(cell, ("sys path = 'five.xml'", 'catalog "franka-panda"'))
    assert found(cell.with_name("tidy.bddx")) == [
        "67:15: warning: 'franka-panda' of the catalog has its own tool, gripper, home and speeds: remove yours, or"
        " name a file [unusable-model]"
    ]


def test_a_fixed_object_from_a_file_without_a_pose_is_reported(cell: Path) -> None:
    shape = '<geom type="box" size="0.1 0.1 0.02"/>'
    for name, joint in (("fixed", ""), ("loose", "<freejoint/>")):
        text = f'<mujoco><worldbody><body name="{name}">{joint}{shape}</body></worldbody></mujoco>'
        (cell.parent / f"{name}.xml").write_text(text, encoding="utf-8")
    rewrite(cell, ('catalog "bin" map body <poses.bin> to "bin"', "sys path = 'loose.xml'"))
    assert found(cell.with_name("tidy.bddx")) == []
    rewrite(cell, ("loose.xml", "fixed.xml"))
    assert found(cell.with_name("tidy.bddx")) == [
        "65:10: warning: 'bin' has no pose: place it in the .scenex; its model (from fixed.xml) has no standard place"
        " [pose]"
    ]
    rewrite(cell, ("sys path = 'fixed.xml'", 'catalog "bin"'), (' map body <poses.top> to "table"', ""))
    assert found(cell.with_name("tidy.bddx")) == []


@pytest.mark.parametrize(
    ("old", "new", "place", "words"),
    [
        (
            "0.2, 1.6",
            "0.2, 99",
            "78:28",
            "the home position 99 of the joint 'elbow' is outside its limits, -2.8 to 2.8",
        ),
        ("0.2, 1.6, ", "", "78:19", "the arm has 5 joints (yaw, shoulder, elbow, pitch, roll), 'home' has 3 numbers"),
        (
            "(1.5, 1.5, ",
            "(1.5, ",
            "79:23",
            "the arm has 5 joints (yaw, shoulder, elbow, pitch, roll), 'velocity' has 4",
        ),
        ("open: 0.04", "open: 40", "73:23", "an actuator 'grip' that takes values from -0.002 to 0.04: 'open' cannot"),
        ("close: -0.002", "close: -2", "74:24", "'close' cannot be -2"),
        ("open: 0.04", "open: -0.002", "74:24", "is open and closed at the same value, -0.002"),
        ("stroke: 80 mm", "stroke: 80 cm", "76:25", "opens 0.080 m, not the stated stroke of 0.800 m"),
    ],
)
def test_a_number_that_contradicts_the_file_is_reported_at_its_place(
    cell: Path, old: str, new: str, place: str, words: str
) -> None:
    rewrite(cell, (old, new))
    (only,) = found(cell)
    assert only.startswith(f"{place}: warning: ")
    assert words in only
    assert only.endswith(" [unusable-model]")


def test_a_fault_that_no_stated_entry_causes_is_reported_at_the_model(cell: Path) -> None:
    rewrite(cell, ("                open: 0.04\n", ""), ("                close: -0.002\n", ""))
    rewrite(cell.with_name("five.xml"), (' ctrlrange="-0.002 0.04"', ""))
    (only,) = found(cell)
    assert only.startswith("67:15: warning: the gripper of five.xml has an actuator 'grip' without a 'ctrlrange'")


def test_a_name_that_the_text_of_the_file_lacks_is_reported_once(cell: Path) -> None:
    rewrite(cell, ('tool: "tcp"', 'tool: "tip"'))
    assert found(cell.with_name("tidy.bddx")) == []
    (finding,) = (one for one in load(cell).diagnostics if one.code in ("model-name", "unusable-model"))
    assert (finding.code, finding.message) == (
        "model-name",
        "the model's file has no site or body 'tip'; did you mean 'tcp'?",
    )


def test_a_name_that_the_file_lacks_does_not_hide_another_fault(cell: Path) -> None:
    rewrite(cell, ('map body <poses.foot> to "foot"', "map body <poses.foot>"), ("home: (0,", "home: (9,"))
    rewrite(cell.with_name("five.xml"), ('<body name="foot">', '<body name="stand">'))
    (unmapped,) = (one for one in load(cell).diagnostics if one.code == "model-name")
    assert "no body 'foot'" in unmapped.message
    (unusable,) = found(cell)
    assert unusable.endswith("'yaw' is outside its limits, -3 to 3 in five.xml [unusable-model]")


def test_code_that_makes_a_model_is_not_executed(cell: Path) -> None:
    rewrite(cell, ("model five_model as mjcf {\n            sys path = 'five.xml'", MADE))
    cell.with_name("making.py").write_text("from pathlib import Path\nPath(__file__).with_suffix('.ran').touch()\n")
    assert found(cell) == []
    assert not cell.with_name("making.ran").exists()


@pytest.mark.skipif(sys.platform != "linux", reason="other systems cannot limit the memory of a process")
def test_a_model_that_demands_more_memory_than_the_limit_is_refused(
    cell: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    texture = '<asset><texture name="t" type="2d" builtin="flat" width="20000" height="20000"/></asset><worldbody>'
    rewrite(cell.with_name("five.xml"), ("<worldbody>", texture))
    monkeypatch.setenv(SCENE_MEMORY.variable, str(600 * MIB))
    (only,) = found(cell)
    assert "unusable-model" in only or "scene-unchecked" in only


@pytest.mark.skipif(os.name == "nt", reason="Windows cannot limit the time of a process")
def test_a_model_that_compiles_without_end_is_given_up(cell: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    endless = '<worldbody><replicate count="100000000" offset="1 0 0"><geom type="sphere" size=".01"/></replicate>'
    rewrite(cell.with_name("five.xml"), ("<worldbody>", endless))
    monkeypatch.setenv(SCENE_SECONDS.variable, "1")
    (only,) = found(cell)
    assert only.endswith("(the limit scene-seconds) [scene-unchecked]")


def test_a_failed_examination_is_reported(cell: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(scene_findings, "FIND", "robbdd_tools.agent.no_such_module")
    (only,) = found(cell)
    assert only.startswith("1:1: warning: the models and poses of this scene were not checked: ")
    assert only.endswith("[scene-unchecked]")


def test_an_edit_in_an_editor_is_examined_and_the_same_scene_only_once(
    cell: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    uri, text = path_to_uri(cell), cell.read_text(encoding="utf-8").replace(ON_THE_TABLE, IN_THE_TABLE)
    reading, writing = os.pipe()
    with os.fdopen(reading, "rb") as stream, os.fdopen(writing, "wb"):
        worker = Worker(Inbox[Request | Forget](stream))
        worker.project.load(uri)

        def answer(revision: int, edited: str) -> list[str]:
            given = worker.answer(Request(revision, uri, {uri: (revision, edited)}, EditorShapes()))
            assert isinstance(given, Answer)
            assert given.error == ""
            return [entry.code for entry in given.diagnostics]

        assert answer(1, text) == ["overlap"]
        monkeypatch.setattr(scene_findings, "FIND", "robbdd_tools.agent.no_such_module")
        assert answer(2, f"{text}// The end.\n") == ["overlap"]
        assert answer(3, f"// The beginning.\n{text}") == ["scene-unchecked"]


def test_a_scene_with_errors_is_not_examined(cell: Path) -> None:
    rewrite(cell, (ON_THE_TABLE, IN_THE_TABLE), ("wrt: <top.edge>", "wrt: <top.rim>"))
    project = Project()
    project.load(path_to_uri(cell))
    assert SceneChecker().findings(project.snapshot(), path_to_uri(cell)) == list[Diagnostic]()
