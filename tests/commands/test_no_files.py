"""Files that are none, and disks that are full, as users of the command line meet them."""

from __future__ import annotations

import errno
import json
import os
from collections.abc import Callable
from pathlib import Path

import pytest

from kit import EVENTS, MODEL, SCENE, make_fifo
from robbdd_tools.cli import main

Make = Callable[[Path], object]


def link_to(target: str) -> Make:
    return lambda path: path.symlink_to(target)


def full(*_: object) -> None:
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "main.bdd").write_text(MODEL, encoding="utf-8")
    (tmp_path / "lab.scene").write_text(SCENE, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (make_fifo, "'other.scene' is a named pipe; only regular files are read"),
        (link_to("/dev/zero"), "'other.scene' is a device (through a link); only regular files are read"),
        (link_to("other.scene"), "'other.scene' cannot be read: its symbolic links form a loop"),
        (link_to("gone.scene"), "it is a symbolic link to gone.scene, which does not exist"),
        (Path.mkdir, "'other.scene' is a folder; name a file in it"),
    ],
)
def test_an_import_that_is_no_file_is_reported_where_it_is_written(
    folder: Path, capsys: pytest.CaptureFixture[str], make: Make, words: str
) -> None:
    make(folder / "other.scene")
    (folder / "main.bdd").write_text(f'import "other.scene"\n{EVENTS}', encoding="utf-8")
    assert main(["check", "main.bdd"]) == 1
    (error,) = [line for line in capsys.readouterr().out.splitlines() if "other.scene" in line]
    assert error.startswith("main.bdd:1:9: error: ")
    assert words in error


@pytest.mark.parametrize(
    "address",
    ["http://example.org/a.scene", "file:///etc/a.scene", "file:a.scene", "//host/a.scene", "\\\\host\\a.scene"],
)
def test_an_import_is_a_path_and_never_an_address(
    folder: Path, capsys: pytest.CaptureFixture[str], address: str
) -> None:
    (folder / "main.bdd").write_text(f"import {json.dumps(address)}\n{EVENTS}", encoding="utf-8")
    assert main(["check", "main.bdd"]) == 1
    assert f"main.bdd:1:9: error: '{address}' is an address: import a file of this machine by its path" in (
        capsys.readouterr().out
    )


@pytest.mark.parametrize("above", ["..", "/no/such/folder", "../../../../../../../../../.."])
def test_an_import_from_elsewhere_that_is_missing_is_reported(
    folder: Path, capsys: pytest.CaptureFixture[str], above: str
) -> None:
    (folder / "main.bdd").write_text(f'import "{above}/gone.scene"\n{EVENTS}', encoding="utf-8")
    assert main(["check", "main.bdd"]) == 1
    assert "main.bdd:1:9: error: there is no file 'gone.scene' in /" in capsys.readouterr().out


def test_models_above_the_folder_and_at_absolute_paths_are_imported(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "inner").mkdir()
    for path in ("..", str(folder)):
        (folder / "inner" / "main.bdd").write_text(MODEL.replace('"lab.scene"', f'"{path}/lab.scene"'), "utf-8")
        assert main(["check", "inner/main.bdd"]) == 0, capsys.readouterr().out


def test_a_pipe_among_the_models_of_a_folder_is_reported_and_the_others_are_checked(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    make_fifo(folder / "pipe.bdd")
    (folder / "folder.bdd").mkdir()
    assert main(["check", "."]) == 2
    said = capsys.readouterr().out
    assert "pipe.bdd:1:1: error: 'pipe.bdd' is a named pipe; only regular files are read [file-not-regular]" in said
    assert "3 files: 1 error" in said


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("robbdd.toml", ["check", "main.bdd"]),
        ("own.feature.jinja", ["gherkin", "main.bdd", "-o", "out", "--template", "own.feature.jinja"]),
        ("own.rq", ["query", "main.bdd", "-f", "own.rq"]),
        ("model.jsonld", ["check", "model.jsonld"]),
        ("model.ttl", ["check", "model.ttl"]),
        ("results.json", ["query", "main.bdd", "scenarios", "--results", "results.json"]),
        ("main.bdd", ["format", "main.bdd"]),
        ("steps/main_steps.py", ["gherkin", "main.bdd", "-o", "out"]),
        ("steps/main_steps.py", ["steps", "main.bdd", "-o", "steps/main_steps.py"]),
    ],
)
def test_every_command_refuses_a_pipe(
    folder: Path, capsys: pytest.CaptureFixture[str], name: str, arguments: list[str]
) -> None:
    (folder / "steps").mkdir()
    (folder / name).unlink(missing_ok=True)
    make_fifo(folder / name)
    assert main(arguments) != 0
    captured = capsys.readouterr()
    assert f"'{Path(name).name}' is a named pipe; only regular files are read" in captured.out + captured.err


def test_a_full_disk_does_not_cut_a_model_short(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    untidy = MODEL.replace("    ", "  ")
    (folder / "main.bdd").write_text(untidy, encoding="utf-8")
    monkeypatch.setattr(os, "fsync", full)
    assert main(["format", "main.bdd"]) == 2
    assert "robbdd: main.bdd: No space left on device" in capsys.readouterr().err
    assert (folder / "main.bdd").read_text(encoding="utf-8") == untidy
    assert sorted(entry.name for entry in folder.iterdir()) == ["lab.scene", "main.bdd"]


def test_a_template_that_fails_halfway_leaves_no_feature(folder: Path) -> None:
    failing = "{% block scenario %}{{ 1 / (scenario.number - 2) }}{% endblock %}"
    (folder / "own.feature.jinja").write_text(failing, encoding="utf-8")
    assert main(["gherkin", "main.bdd", "-o", "out", "--template", "own.feature.jinja"]) == 2
    assert list((folder / "out").rglob("*.feature*")) == []
    assert main(["gherkin", "main.bdd", "-o", "out"]) == 0
    before = (folder / "out" / "features" / "fetching.feature").read_bytes()
    assert main(["gherkin", "main.bdd", "-o", "out", "--template", "own.feature.jinja"]) == 2
    assert (folder / "out" / "features" / "fetching.feature").read_bytes() == before
