"""Text → graph → text → graph is the identity; further triples of a foreign graph are reported one by one."""

from __future__ import annotations

from pathlib import Path

import pytest
from rdflib import Graph
from rdflib.compare import isomorphic

from graph.models import EVERYTHING
from graph.statements import built
from graph.test_foreign import FOREIGN
from kit import EXAMPLES, MODEL, SCENE, corpus
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.graph.acceptance_model import AcceptanceModel
from robbdd_tools.graph.rdf.serialize import parse, serialize
from robbdd_tools.graph.read.acceptance import read_model
from robbdd_tools.graph.text.losses import Losses, compare
from robbdd_tools.graph.text.model_text import ModelText, write_model
from robbdd_tools.graph.write.build import build_graph
from robbdd_tools.names.project import Project


def graph_of(text: ModelText) -> Graph:
    project = Project()
    project.open("file:///again/model.bdd", 1, text.criteria)
    project.open("file:///again/model.scene", 1, text.scene)
    snapshot = project.snapshot()
    for name in ("model.bdd", "model.scene"):
        file = snapshot.file(f"file:///again/{name}")
        assert file is not None
        assert file.diagnostics == ()
    return build_graph(snapshot, "file:///again/model.bdd").graph


def there_and_back(graph: Graph) -> tuple[Graph, Losses]:
    text = write_model(graph, "model.scene")
    assert text.left_out == {}
    again = graph_of(text)
    return again, compare(graph, again, text.renamed)


def assert_identity(graph: Graph) -> None:
    again, losses = there_and_back(graph)
    assert serialize(again, "nt") == serialize(graph, "nt")
    assert losses == Losses((), (), ())


def of_file(path: Path) -> Graph:
    project = Project()
    project.load(path_to_uri(path))
    return build_graph(project.snapshot(), path_to_uri(path)).graph


CORRECT = f"//- main.bdd\n{MODEL}//- lab.scene\n" + SCENE.replace(
    "workspace tray_ws }", "workspace tray_ws { correct for: obj <parts.bolt>, obj set <washers> } }"
)


@pytest.mark.parametrize("text", [MODEL, EVERYTHING, CORRECT], ids=["small", "every construct", "correct places"])
def test_text_is_found_again(text: str) -> None:
    graph = built(text).graph
    assert_identity(graph)
    assert isomorphic(there_and_back(graph)[0], graph)


def test_the_examples_are_found_again() -> None:
    paths = sorted(EXAMPLES.rglob("*.bdd"))
    assert paths
    for path in paths:
        assert_identity(of_file(path))


def test_foreign_text_is_found_again() -> None:
    for path in corpus(".bdd"):
        assert_identity(of_file(path))


def test_foreign_graphs_keep_their_scenarios() -> None:
    for path in corpus(".bdd"):
        graph = parse((path.parent.parent / "graphs" / f"{path.name}.ttl").read_text(encoding="utf-8"), "ttl")
        again, losses = there_and_back(graph)
        assert scenarios(read_model(again)) == scenarios(read_model(graph)), path.name
        assert (losses.lost, losses.renamed) == ((), ()), path.name
        assert all("-scene-has-obj env:has-object" in line for line in losses.added), path.name


def scenarios(model: AcceptanceModel) -> list[tuple[str, str, int]]:
    return [
        (variant.iri, repr(variant.variation), len(variant.template.clauses))
        for story in model.stories
        for variant in story.variants
    ]


def test_what_the_language_cannot_say_is_told_by_triple() -> None:
    _, losses = there_and_back(parse(FOREIGN, "ttl"))
    assert losses.lost == (
        "ex:arm a ex:Robot",
        "ex:begin a ex:Tick",
        "ex:begin a owl-time:Instant",
        "ex:cup a ex:Cup",
        "ex:done a owl-time:Instant",
        "ex:job a ex:Job",
    )
    assert losses.renamed == (("ex:place", "ex:var-place"), ("ex:thing", "ex:var-thing"), ("ex:who", "ex:var-who"))


def test_a_part_that_cannot_be_written_is_left_out_with_the_reason() -> None:
    text = write_model(parse(FOREIGN.replace("ex:act ex:there", "ex:there"), "ttl"), "model.scene")
    assert {node.rpartition("#")[2]: reason for node, reason in text.left_out.items()} == {
        "moving": "it has neither a When with a behaviour nor a 'for all'",
        "variant": "its template https://example.org/cell#moving is not written",
        "story": "it has no scenario that can be written",
    }


def test_names_that_collide_or_cannot_be_written_get_others() -> None:
    extra = """@prefix other: <https://example.org/other/> .
other:done a rtime:Event . <https://example.org/cell#2nd.end> a rtime:Event .
"""
    text = write_model(parse(FOREIGN + extra, "ttl"), "model.scene")
    assert "Event (ns=ex) done\n" in text.criteria
    assert "Event (ns=other) done-2\n" in text.criteria
    _, losses = there_and_back(parse(FOREIGN + extra, "ttl"))
    assert ("other:done", "other:done-2") in losses.renamed


def test_strings_come_back_whatever_is_in_them() -> None:
    hostile = 'quote " backslash \\\\ brace { line \\n // no comment'
    text = MODEL.replace('"operator"', f'"{hostile}"'.replace('quote "', 'quote \\"'))
    assert_identity(built(text).graph)
