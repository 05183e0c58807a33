"""``robbdd new``: every example is the beginning of a project."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit import EXAMPLES
from robbdd_tools.cli import main

TEMPLATES = sorted({path.parent.name for path in EXAMPLES.glob("*/*.bdd")})


def test_the_templates_are_listed_with_what_they_are_for(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new"]) == 0
    listed = [line.split(maxsplit=1) for line in capsys.readouterr().out.splitlines()]
    assert [name for name, _ in listed] == TEMPLATES


@pytest.mark.parametrize("template", TEMPLATES)
def test_a_new_project_is_sound_and_has_its_own_namespace(
    template: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "My Cell"
    assert main(["new", str(folder), "--template", template]) == 0
    assert f"Next: robbdd run '{folder}'" in capsys.readouterr().out
    assert main(["check", str(folder)]) == 0
    texts = [path.read_text(encoding="utf-8") for path in folder.glob("*.bdd")]
    assert all("https://example.org/my-cell/" in text and "example.org/robbdd/" not in text for text in texts)
    assert (folder / ".gitignore").is_file()


def test_a_folder_that_holds_something_is_left_alone(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "notes.txt").write_text("mine", encoding="utf-8")
    assert main(["new", str(tmp_path)]) == 2
    assert capsys.readouterr().err == f"robbdd: {tmp_path} exists already; name a new or an empty folder\n"
    assert [path.name for path in tmp_path.iterdir()] == ["notes.txt"]


def test_an_unknown_template_is_told_the_known_ones(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", str(tmp_path / "cell"), "--template", "nothing"]) == 2
    assert capsys.readouterr().err == f"robbdd: there is no template 'nothing'; there are {', '.join(TEMPLATES)}\n"
    assert not (tmp_path / "cell").exists()


@pytest.mark.physics
@pytest.mark.parametrize("template", ["pick-place", "ownrobot", "sorting", "conveyor", "shelf"])
def test_a_new_project_runs_and_every_clause_holds(
    template: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """That which is about failures (``tworobots``) is left out."""
    folder = tmp_path / "cell"
    assert main(["new", str(folder), "--template", template]) == 0
    for seed in ("1", "2"):
        capsys.readouterr()
        assert main(["run", str(folder), "--seed", seed]) == 0
        assert " 0 violated, 0 unknown" in capsys.readouterr().out
