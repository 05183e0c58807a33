"""Several graph files that a command names are one model."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import robbdd_tools as robbdd
from graph.test_foreign import FOREIGN
from robbdd_tools.cli import main
from robbdd_tools.graph.rdf.serialize import parse, serialize
from robbdd_tools.graph.write.build import build_graph

TABLE = """ex:table a env:Object .
ex:table_comp a env:WorkspaceHasObject ; env:of-workspace ex:table_ws ; env:has-object ex:table .
"""
CELL = (
    FOREIGN.replace("ex:cup", "ex:cube")
    .replace("ex:desk", "ex:table_ws")
    .replace("ex:arm", "ex:panda")
    .replace("has-object ex:cube ]", "has-object ex:cube, ex:table ]")
    .replace("ex:begin a", TABLE + "ex:begin a")
)
PARTS = ("template.ttl", "story.jsonld")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a model's template as Turtle and its story as JSON-LD, each with its own blank nodes."""
    monkeypatch.chdir(tmp_path)
    head, rest = CELL[: CELL.index("ex:table a")], CELL[CELL.index("ex:table a") :]
    template, _, story = rest.partition("ex:story a")
    Path("template.ttl").write_text(head + template, encoding="utf-8")
    story_graph = parse(f"{head}ex:story a{story}", "ttl")
    Path("story.jsonld").write_text(serialize(story_graph, "json-ld"), encoding="utf-8")
    Path("whole.ttl").write_text(CELL, encoding="utf-8")
    return tmp_path


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize("order", [PARTS, PARTS[::-1]])
def test_parts_are_sound_together_in_any_order(order: tuple[str, str]) -> None:
    assert main(["check", "story.jsonld"]) == 1
    assert main(["check", *order]) == 0
    assert main(["graph", *order]) == 0


def test_the_graph_of_the_parts_is_that_of_the_whole(folder: Path) -> None:
    from rdflib.compare import isomorphic

    whole, parts = robbdd.load("whole.ttl"), robbdd.load(*(folder / name for name in PARTS))
    assert isomorphic(parse(whole.graph(), "ttl"), parse(parts.graph(), "ttl"))
    assert whole.digest == parts.digest


@pytest.mark.usefixtures("folder")
def test_the_parts_are_imported_as_the_whole(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["import", "story.jsonld", "-o", "part.bdd"]) == 2
    assert not Path("part.bdd").exists()
    for name, files in (("whole", ["whole.ttl"]), ("parts", list(PARTS))):
        Path(name).mkdir()
        assert main(["import", *files, "-o", f"{name}/m.bdd"]) == 0
    capsys.readouterr()
    for name in ("m.bdd", "m.scene"):
        assert Path("parts", name).read_bytes() == Path("whole", name).read_bytes()


@pytest.mark.usefixtures("folder")
def test_blank_nodes_with_one_label_in_several_files_stay_apart() -> None:
    for name, thing in (("a.json", "cube"), ("b.json", "ball")):
        node = {"@id": "_:b0", "@type": "https://example.org/T", "https://example.org/of": {"@id": f"x:{thing}"}}
        Path(name).write_text(json.dumps(node), encoding="utf-8")
    (file,) = robbdd.load("a.json", "b.json").files
    assert len(set(build_graph(file.snapshot, file.uri).graph.subjects())) == 2


def test_a_fault_is_reported_in_the_part_that_has_it(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Path("broken.ttl").write_text("@prefix ex: <https://example.org/> .\nex:a ex:b\n", encoding="utf-8")
    assert main(["check", *PARTS, "broken.ttl"]) == 1
    assert "broken.ttl:" in capsys.readouterr().out
    assert main(["check", *PARTS, "missing.ttl"]) == 2
    assert "missing.ttl:1:1: error: there is no file 'missing.ttl'" in capsys.readouterr().out
    assert main(["graph", "template.ttl", str(folder / "cell.bdd")]) == 2
    assert "several files are one model only if they are graphs" in capsys.readouterr().err


@pytest.mark.physics
def test_a_run_of_the_parts_is_replayed_and_judged(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", *PARTS, "--json", "parts.json"]) == main(["run", "whole.ttl", "--json", "whole.json"]) == 0
    parts, whole = (json.loads((folder / name).read_text()) for name in ("parts.json", "whole.json"))
    assert parts["scenarios"][0]["clauses"] == whole["scenarios"][0]["clauses"]
    assert main(["replay", "1"]) == 0
    assert main(["judge", "1", *PARTS]) == 0
    assert main(["gherkin", *PARTS, "-o", "features"]) == 0
    assert "story.feature" in capsys.readouterr().out
