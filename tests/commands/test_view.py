"""``robbdd view`` and ``robbdd run --record``: pictures, or a sentence about what to install."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit import EXAMPLES
from robbdd_tools.cli import main

MODEL = str(EXAMPLES / "pickplace" / "pickplace.bdd")


@pytest.mark.physics
def test_it_writes_a_picture_or_tells_what_to_install(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = tmp_path / "scene.png"
    code = main(["view", MODEL, "--scenario", "part-to-bin", "-o", str(target)])
    said = capsys.readouterr()
    if code == 0:
        assert target.read_bytes().startswith(b"\x89PNG")
        assert said.out == f"{target}: crit:part-to-bin -- 1\n"
    else:
        assert code == 2
        assert "install EGL (libegl1 and libgl1) or OSMesa (libosmesa6)" in said.err


def test_without_graphics_it_tells_what_to_install(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MUJOCO_GL", "nonsense")
    assert main(["view", MODEL, "-o", str(tmp_path / "scene.png")]) == 2
    said = capsys.readouterr()
    assert said.err.startswith("robbdd: nothing here can render without a display: install EGL")
    assert "Traceback" not in said.err
    assert not said.out


def test_a_scenario_that_is_not_there_is_told_the_known_ones(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["view", MODEL, "--scenario", "nothing"]) == 2
    assert capsys.readouterr().err == "robbdd: there is no scenario 'nothing'; the model has part-to-bin\n"


@pytest.mark.physics
def test_verdicts_stand_without_pictures(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MUJOCO_GL", "nonsense")
    assert main(["run", MODEL, "--no-store", "--record", str(tmp_path / "pictures")]) == 0
    said = capsys.readouterr()
    assert "4 hold" in said.out
    assert said.err.startswith("robbdd: no pictures: nothing here can render without a display")


def test_a_window_needs_a_display(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    for variable in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(variable, raising=False)
    monkeypatch.setattr("sys.platform", "linux")
    assert main(["run", MODEL, "--viewer"]) == 2
    assert "robbdd: --viewer needs a display, and there is none" in capsys.readouterr().err
