"""Pictures: files that viewers can read, of scenes with their workspaces, and a clear message if nothing can render."""

from __future__ import annotations

import os
import struct
import subprocess
import sys
import zlib
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from robbdd_tools.agent.execution import Execution
from robbdd_tools.agent.shared_executions import calls_of
from robbdd_tools.agent.video import NoVideo, write_video
from robbdd_tools.agent.violation_states import ViolationStates
from robbdd_tools.base.graphics import CHOICE, KEPT, advice, back_ends, without_graphics
from robbdd_tools.protocol.messages import Execute, encode
from robbdd_tools.world.png import SIGNATURE, write_png
from robbdd_tools.world.viewer import NoViewer, Viewer
from world.worlds import BIN, BIN_WS, CUBE, OTHER_WS, PANDA, SCENE, Steps, write_run
from world.worlds import execution as build_execution


def read_png(path: Path) -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
    data = path.read_bytes()
    assert data.startswith(SIGNATURE)
    chunks: dict[bytes, bytes] = {}
    at = len(SIGNATURE)
    while at < len(data):
        (length,) = struct.unpack_from(">I", data, at)
        kind, body = data[at + 4 : at + 8], data[at + 8 : at + 8 + length]
        assert struct.unpack_from(">I", data, at + 8 + length) == (zlib.crc32(kind + body),)
        chunks[kind] = body
        at += length + 12
    assert list(chunks) == [b"IHDR", b"IDAT", b"IEND"]
    width, height = struct.unpack_from(">II", chunks[b"IHDR"])
    rows = np.frombuffer(zlib.decompress(chunks[b"IDAT"]), np.uint8).reshape(height, 1 + 3 * width)
    assert not rows[:, 0].any()
    return rows[:, 1:].reshape(height, width, 3)


def render(folder: Path, output: Path, index: str = "0", **environment: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "robbdd_tools.agent.render_run", str(folder), index, str(output)]
    merged: Mapping[str, str] = {**os.environ, **environment}
    return subprocess.run(command, capture_output=True, text=True, check=False, env=merged)


def test_a_picture_reads_back_as_it_was_written(tmp_path: Path) -> None:
    pixels = np.arange(5 * 7 * 3, dtype=np.uint8).reshape(5, 7, 3)
    write_png(tmp_path / "a.png", pixels)
    assert (read_png(tmp_path / "a.png") == pixels).all()


@pytest.mark.physics
def test_a_scene_is_rendered_or_the_reason_is_given(tmp_path: Path) -> None:
    """Where no graphics library is installed, there is a sentence instead of a picture."""
    write_run(tmp_path / "run", [Steps(())])
    done = render(tmp_path / "run", tmp_path / "a.png", MUJOCO_GL="egl")
    assert "Traceback" not in done.stderr
    if done.returncode == 3:
        assert done.stderr.strip()
        assert not (tmp_path / "a.png").exists()
        return
    assert done.returncode == 0, done.stderr
    nowhere = tmp_path / "nowhere" / "a.png"
    assert render(tmp_path / "run", nowhere, MUJOCO_GL="egl").stderr == f"{nowhere.parent}: No such file or directory\n"
    pixels = read_png(tmp_path / "a.png").astype(int)
    assert pixels.shape == (800, 1280, 3)
    reddish = (pixels[..., 0] > 90) & (pixels[..., 1:].max(axis=2) < 80)
    greenish = pixels[..., 1] > pixels[..., [0, 2]].max(axis=2) + 30
    assert reddish.sum() > 50, "the cube"
    assert greenish.sum() > 1000, "a workspace"


def test_a_back_end_that_does_not_work_is_a_sentence(tmp_path: Path) -> None:
    write_run(tmp_path / "run", [Steps(())])
    done = render(tmp_path / "run", tmp_path / "a.png", MUJOCO_GL="nonsense")
    assert done.returncode == 3
    assert done.stderr.strip()
    assert "Traceback" not in done.stderr


def test_a_scene_that_cannot_be_set_up_is_explained(tmp_path: Path) -> None:
    write_run(tmp_path / "run", [Steps((), replace(SCENE, objects=(*SCENE.objects, "env:gizmo")))])
    done = render(tmp_path / "run", tmp_path / "a.png", MUJOCO_GL="egl")
    assert done.returncode in (2, 3)
    assert "Traceback" not in done.stderr
    assert done.returncode == 3 or "there is no model for object 'env:gizmo'" in done.stderr
    assert render(tmp_path / "run", tmp_path / "a.png", "first").stderr.startswith("usage: ")


def execute(run: Path) -> None:
    command = [sys.executable, "-m", "robbdd_tools.agent", str(run)]
    environment = {**os.environ, "MUJOCO_GL": "nonsense"}
    subprocess.run(command, check=True, capture_output=True, env=environment, input=encode(Execute(0)).encode() + b"\n")


@pytest.mark.physics
def test_the_moment_of_every_violated_clause_is_kept_with_the_run(tmp_path: Path) -> None:
    """What is placed in one bin is violated to be in the other, from the moment on at which it is judged."""
    right, wrong = (f'"{CUBE}" is located at "{ws}" after event "t:place-end"' for ws in (BIN_WS, OTHER_WS))
    doing = f'"{PANDA}" picks "{CUBE}" and places it at "{BIN_WS}"'
    (spec,) = write_run(tmp_path / "run", [Steps((("when", doing), ("then", right), ("then", wrong)))])
    left = tmp_path / "run" / "moments" / "000000.jsonl"
    left.parent.mkdir()
    left.write_text("left by an earlier run\n")
    execute(tmp_path / "run")
    (moment,) = ViolationStates(tmp_path / "run")
    assert (moment.index, moment.line) == (0, spec.clauses[2].line)
    simulation = Execution(spec, calls_of(spec)).simulation
    address = int(simulation.model.jnt_qposadr[simulation.model.body(CUBE).jntadr[0]])
    placed, goal = np.array(moment.state[address : address + 2]), simulation.data.body(BIN).xpos[:2]
    assert np.abs(placed - goal).max() < 0.1
    done = render(tmp_path / "run", tmp_path / "pictures", "moments", MUJOCO_GL="egl")
    assert done.returncode in (0, 3), done.stderr
    assert "Traceback" not in done.stderr
    written = [path.name for path in (tmp_path / "pictures").glob("*")]
    assert done.returncode == 3 or written == [f"fetch-1-{spec.clauses[2].name}.png"]


@pytest.mark.physics
def test_the_end_of_a_failed_behaviour_is_kept_with_the_run(tmp_path: Path) -> None:
    """A bin cannot be gripped."""
    doing = f'"{PANDA}" picks "{BIN}" and places it at "{OTHER_WS}"'
    (spec,) = write_run(tmp_path / "run", [Steps((("when", doing),))])
    execute(tmp_path / "run")
    (moment,) = ViolationStates(tmp_path / "run")
    assert (moment.index, moment.line) == (0, spec.clauses[0].line)
    done = render(tmp_path / "run", tmp_path / "pictures", "moments", MUJOCO_GL="egl")
    written = [path.name for path in (tmp_path / "pictures").glob("*")]
    assert done.returncode == 3 or written == ["fetch-1-behaviour.png"]


def test_moments_that_are_none_are_explained(tmp_path: Path) -> None:
    write_run(tmp_path / "run", [Steps(())])
    (tmp_path / "run" / "moments").mkdir()
    (tmp_path / "run" / "moments" / "000000.jsonl").write_text("[1]\n")
    done = render(tmp_path / "run", tmp_path / "pictures", "moments", MUJOCO_GL="egl")
    assert done.returncode in (2, 3)
    assert "Traceback" not in done.stderr
    assert done.returncode == 3 or "does not contain moments" in done.stderr


@pytest.mark.physics
def test_a_scenario_is_filmed_with_captions_or_the_reason_is_given(tmp_path: Path) -> None:
    """The strip at the bottom changes with time and events; a violated clause is written above."""
    wrong = f'"{CUBE}" is located at "{OTHER_WS}" after event "t:place-end"'
    doing = f'"{PANDA}" picks "{CUBE}" and places it at "{BIN_WS}"'
    (spec,) = write_run(tmp_path / "run", [Steps((("when", doing), ("then", wrong)))])
    execution = Execution(spec, calls_of(spec))
    end = execution.advance_until(lambda _: False).end
    ViolationStates(tmp_path / "run").keep(0, spec.clauses[1].line, end - 0.2, execution.state_at(end))
    done = render(tmp_path / "run", tmp_path / "videos", "videos", MUJOCO_GL="egl")
    assert "Traceback" not in done.stderr
    if done.returncode == 3:
        assert done.stderr.strip()
        return
    assert done.stdout.splitlines() == [str(tmp_path / "videos" / "fetch-1.webp")]
    with Image.open(tmp_path / "videos" / "fetch-1.webp") as film:
        count = int(getattr(film, "n_frames"))  # noqa: B009  # a property that only moving pictures have
        assert count == pytest.approx(end / 0.08, abs=2)
        frames: list[np.ndarray[tuple[int, ...], np.dtype[np.uint8]]] = []
        for index in (0, count // 2, count - 1):
            film.seek(index)
            frames.append(np.asarray(film.convert("RGB")))
    strips = [frame[-20:] for frame in frames]
    assert all(strip.max() > 200 for strip in strips)
    assert (strips[0] != strips[1]).any()
    first, _, last = (int(np.median(frame[:20])) for frame in frames)
    assert last < 40 < first


def test_without_pillow_there_are_no_moving_pictures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "PIL.Image", None)
    with pytest.raises(NoVideo, match=r"pip install 'robbdd-tools\[video\]'"):
        write_video(tmp_path / "a.webp", build_execution(), "a", ())


def test_a_window_that_cannot_be_opened_leaves_the_simulation_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.setitem(sys.modules, "mujoco.viewer", None)
    simulation = build_execution().simulation
    with pytest.raises(NoViewer, match="no window can be opened"):
        Viewer(simulation)
    assert not simulation.watchers


@pytest.mark.parametrize(
    ("platform", "names", "word"),
    [("linux", ("egl", "osmesa"), "libegl1"), ("win32", ("wgl",), "driver"), ("darwin", ("cgl", "glfw"), "driver")],
)
def test_each_system_has_back_ends_of_its_own(
    monkeypatch: pytest.MonkeyPatch, platform: str, names: tuple[str, ...], word: str
) -> None:
    # What the function sets would stay in this process: monkeypatch restores only what it has set itself.
    others = {name: value for name, value in os.environ.items() if name not in (CHOICE, KEPT)}
    monkeypatch.setattr(os, "environ", others)
    monkeypatch.setattr(sys, "platform", platform)
    assert back_ends() == names
    assert word in advice()
    os.environ[CHOICE] = "glfw"
    assert back_ends() == ("glfw",)
    without_graphics()
    assert os.environ[CHOICE] == "disable"
    assert back_ends() == ("glfw",)
