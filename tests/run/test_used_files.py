"""Files, apart from the graph, that a run used."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from kit import EXAMPLES
from robbdd_tools.cli import main
from robbdd_tools.run.store import store_beside
from robbdd_tools.run.used_files import changed
from world.arms import URDF
from world.test_mounted_gripper import BARE, GRIPPER


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The example with its own arm and behaviour, which use further files."""
    folder = shutil.copytree(EXAMPLES / "ownrobot", tmp_path / "cell")
    monkeypatch.chdir(folder)
    (folder / "helper.py").write_text("SPEED = 1.0\n", encoding="utf-8")
    code = folder / "carrying.py"
    future = "from __future__ import annotations\n"
    code.write_text(code.read_text(encoding="utf-8").replace(future, f"{future}\nimport helper\n", 1), encoding="utf-8")
    (folder / "parts").mkdir()
    (folder / "parts" / "extra.xml").write_text(
        '<mujoco><visual><map znear="0.01"/></visual></mujoco>\n', encoding="utf-8"
    )
    arm = folder / "five.xml"
    text = arm.read_text(encoding="utf-8")
    arm.write_text(text.replace("</mujoco>", '<include file="parts/extra.xml"/></mujoco>'), encoding="utf-8")
    return folder


@pytest.mark.physics
def test_a_replay_names_the_files_that_were_changed(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "tidy.bddx", "--scenario", "by-our-code", "--first", "1"]) == 0
    (run,) = store_beside(project / "tidy.bddx").runs()
    known = run.record().files
    names = {Path(name).name for name in known}
    assert names == {"five.xml", "extra.xml", "carrying.py", "helper.py"}
    assert changed(known, run.folder) == []
    for name in ("helper.py", "parts/extra.xml"):
        with (project / name).open("a", encoding="utf-8") as file:
            file.write("\n")
    assert main(["replay", "1"]) == 2
    said = capsys.readouterr().err
    assert "helper.py, parts/extra.xml were changed since the run" in said
    assert "carrying.py" not in said
    assert main(["replay", "1", "--force"]) == 0
    assert "1 of 1 traces are the same" in capsys.readouterr().out
    (project / "five.xml").unlink()
    assert [path.name for path in changed(known, run.folder)] == ["five.xml", "helper.py", "extra.xml"]


@pytest.mark.physics
def test_the_file_of_a_mounted_gripper_counts(project: Path) -> None:
    (project / "five.xml").write_text(BARE, encoding="utf-8")
    (project / "fingers.xml").write_text(GRIPPER, encoding="utf-8")
    (scene,) = project.glob("*.scenex")
    text = scene.read_text(encoding="utf-8")
    start = text.index("            tool:")
    end = text.index("}", text.index("stroke:")) + 1
    mounted = "gripper { sys path = 'fingers.xml' on: \"flange\" }"
    scene.write_text(text[:start] + mounted + text[end:], encoding="utf-8")
    assert main(["run", "tidy.bddx", "--scenario", "by-our-code", "--first", "1"]) == 0
    (run,) = store_beside(project / "tidy.bddx").runs()
    assert {"five.xml", "fingers.xml"} <= {Path(name).name for name in run.record().files}


@pytest.mark.physics
def test_an_srdf_file_counts_also_if_it_came_after_the_run(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (project / "five.urdf").write_text(URDF, encoding="utf-8")
    (scene,) = project.glob("*.scenex")
    text = scene.read_text(encoding="utf-8").replace("five_model as mjcf", "five_model as urdf")
    text = text.replace("'five.xml'", "'five.urdf'").replace('"grip"', '"left_slide"')
    scene.write_text(text.replace('"left_pad", "right_pad"', '"left", "right"'), encoding="utf-8")
    assert main(["run", "tidy.bddx", "--scenario", "by-our-code", "--first", "1"]) in (0, 1)
    (project / "five.srdf").write_text('<robot name="five"/>', encoding="utf-8")
    assert main(["replay", "1"]) == 2
    assert "five.srdf was added since the run" in capsys.readouterr().err
