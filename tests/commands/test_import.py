"""Graphs back to text on the command line."""

from __future__ import annotations

from pathlib import Path

import pytest

from commands.test_graph_models import PICKPLACE, robbdd
from graph.test_foreign import FOREIGN


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "m.ttl").write_text(robbdd("graph", PICKPLACE).stdout, encoding="utf-8")
    (tmp_path / "foreign.ttl").write_text(FOREIGN, encoding="utf-8")
    return tmp_path


def test_imported_text_is_sound_and_gives_the_same_graph(folder: Path) -> None:
    done = robbdd("import", "m.ttl", "-o", "model.bdd", folder=folder)
    assert (done.returncode, done.stdout, done.stderr) == (0, "model.bdd\nmodel.scene\n", "")
    assert robbdd("check", "model.bdd", folder=folder).returncode == 0
    assert robbdd("graph", "model.bdd", folder=folder).stdout == (folder / "m.ttl").read_text(encoding="utf-8")


def test_losses_are_warnings_by_triple(folder: Path) -> None:
    done = robbdd("import", "foreign.ttl", "-o", "model.bdd", folder=folder)
    assert done.returncode == 0
    assert "foreign.ttl: warning: the language cannot express: ex:cup a ex:Cup [lost]\n" in done.stderr
    assert "ex:thing becomes ex:var-thing" in done.stderr
    assert robbdd("gherkin", "model.bdd", "-o", "f", folder=folder).returncode == 0


def test_nothing_is_overwritten_unasked(folder: Path) -> None:
    (folder / "model.scene").write_text("mine", encoding="utf-8")
    done = robbdd("import", "m.ttl", "-o", "model.bdd", folder=folder)
    assert done.returncode == 2
    assert "model.scene exists already; --force replaces it" in done.stderr
    assert (folder / "model.scene").read_text(encoding="utf-8") == "mine"
    assert robbdd("import", "m.ttl", "-o", "model.bdd", "--force", folder=folder).returncode == 0


def test_a_broken_graph_and_a_wrong_name_are_refused(folder: Path) -> None:
    assert "must end in .bdd" in robbdd("import", "m.ttl", "-o", "model.txt", folder=folder).stderr
    (folder / "broken.ttl").write_text("<a> <b>", encoding="utf-8")
    done = robbdd("import", "broken.ttl", "-o", "model.bdd", folder=folder)
    assert done.returncode == 2
    assert "broken.ttl:1:" in done.stderr
    assert not (folder / "model.bdd").exists()


def test_what_no_scenario_uses_is_not_called_lost_where_the_scene_says_it(tmp_path: Path) -> None:
    statements = [
        "@prefix env: <https://secorolab.github.io/metamodels/environment#> .",
        "@prefix rbw: <https://robbdd.org/metamodels/workbench#> .",
        "@prefix ex: <https://example.org/m/> .",
        "ex:cube a env:Object, ex:RigidBody . ex:table a env:Workspace . ex:tree a rbw:BehaviourTree .",
    ]
    (tmp_path / "m.ttl").write_text("\n".join(statements), encoding="utf-8")
    done = robbdd("import", "m.ttl", "-o", "n.bdd", folder=tmp_path)
    assert done.returncode == 0
    assert sorted(line.partition("cannot express: ")[2] for line in done.stderr.splitlines()) == [
        "ex:cube a ex:RigidBody [lost]",
        "ex:tree a rbw:BehaviourTree [lost]",
    ]
    assert "object cube" in (tmp_path / "n.scene").read_text(encoding="utf-8")
