"""``robbdd import`` of graphs that are changed at random: text with the same graph, its losses listed, or an error."""

from __future__ import annotations

import random
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest
from rdflib import RDF, Graph, Literal, URIRef
from rdflib.term import Node

from graph.models import EVERYTHING
from graph.statements import built
from kit import MODEL
from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.cli import main
from robbdd_tools.features.diagnostics import all_diagnostics
from robbdd_tools.graph.rdf.serialize import serialize
from robbdd_tools.graph.write.build import build_graph
from robbdd_tools.names.project import Project

T = "https://example.org/t/"
TIME = "https://secorolab.github.io/metamodels/time#"
TASK = "https://secorolab.github.io/metamodels/task#"


@cache
def graphs() -> tuple[Graph, ...]:
    return tuple(built(text).graph for text in (MODEL, EVERYTHING))


def copy_of(graph: Graph) -> Graph:
    found = Graph(bind_namespaces="none")
    for prefix, namespace in graph.namespaces():
        found.bind(prefix, namespace)
    found += graph
    return found


def mutated(seed: int) -> Graph:
    """Return a graph with one to three changes: a type, a property or a text more, a triple less."""
    chance = random.Random(seed)
    original = chance.choice(graphs())
    graph = copy_of(original)
    named = sorted({node for node in graph.subjects() if isinstance(node, URIRef)})
    types = sorted({str(kind) for kind in graph.objects(None, RDF.type)})
    for _ in range(chance.randint(1, 3)):
        triples: list[tuple[Node, Node, Node]] = sorted(graph)
        subject, predicate, _ = chance.choice(triples)
        match chance.choice(("type", "type", "type", "less", "more", "text")):
            case "type":
                graph.add((chance.choice(named), RDF.type, URIRef(chance.choice(types))))
            case "less":
                graph.remove(chance.choice(triples))
            case "more":
                graph.add((subject, predicate, chance.choice(named)))
            case _:
                texts = [triple for triple in triples if isinstance(triple[2], Literal)]
                first, term, old = chance.choice(texts)
                graph.remove((first, term, old))
                graph.add((first, term, Literal(chance.choice(["", "a b", "<x>", '"', "\n", "{x}", 3]))))
    return graph


def named_triples(graph: Graph) -> set[tuple[str, str, str]]:
    """The triples between named nodes, which must be found again under their names or be listed."""
    return {
        (str(s), str(p), str(o))
        for s, p, o in graph
        if isinstance(s, URIRef) and isinstance(o, URIRef) and o != RDF.nil
    }


def errors_of(path: Path) -> Iterator[str]:
    uri, project = path_to_uri(path), Project()
    project.load(uri)
    found = all_diagnostics(project.snapshot(), uri)
    yield from (f"{one.code}: {one.message}" for one in found if one.severity is Severity.ERROR)


def imported(graph: Graph, folder: Path, capsys: pytest.CaptureFixture[str]) -> tuple[int, str]:
    """Import a graph as ``m.bdd`` in a folder; return the exit code and the output."""
    source = folder / "m.ttl"
    source.write_text(serialize(graph, "ttl"), encoding="utf-8")
    code = main(["import", str(source), "-o", str(folder / "m.bdd")])
    return code, capsys.readouterr().err


def assert_truthful(graph: Graph, folder: Path, capsys: pytest.CaptureFixture[str]) -> int:
    code, reported = imported(graph, folder, capsys)
    written = [name for name in ("m.bdd", "m.scene") if (folder / name).exists()]
    if code:
        assert written == []
        assert reported
        return code
    listed = any(f"[{code}]" in reported for code in ("lost", "left-out", "renamed"))
    errors = [error for name in written for error in errors_of(folder / name)]
    # What is lost may have been needed.
    assert errors == [] or (listed and all(error.startswith("shacl-") for error in errors))
    project = Project()
    after: set[tuple[str, str, str]] = set()
    for name in written:
        uri = path_to_uri(folder / name)
        project.load(uri)
        after |= named_triples(build_graph(project.snapshot(), uri).graph)
    assert listed or named_triples(graph) <= after
    return code


@pytest.mark.parametrize("seed", range(40))
def test_a_graph_is_written_as_text_with_the_same_graph_or_refused(
    seed: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert_truthful(mutated(seed), tmp_path, capsys)


@pytest.mark.parametrize(
    ("node", "kind"),
    [
        ("on-bench", f"{TIME}Event"),
        ("in-tray", f"{TASK}Task"),
        ("var-part", f"{TIME}Event"),
        ("carry", f"{TASK}Task"),
        ("fetching", f"{TIME}Event"),
        ("bench-to-tray", f"{TIME}Event"),
        ("fetch", f"{TASK}Task"),
        ("start", "https://example.org/other/Kind"),
    ],
)
def test_a_second_type_is_lost_and_the_text_is_sound(
    node: str, kind: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    graph = copy_of(graphs()[0])
    assert (URIRef(T + node), RDF.type, None) in graph
    graph.add((URIRef(T + node), RDF.type, URIRef(kind)))
    assert assert_truthful(graph, tmp_path, capsys) == 0
    assert f"{node}: holds" in (tmp_path / "m.bdd").read_text(encoding="utf-8") or node not in ("on-bench", "in-tray")


def test_an_event_that_is_a_clause_as_well_is_refused_or_listed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    graph = copy_of(graphs()[0])
    clause = URIRef(f"{T}on-bench")
    graph.add((clause, RDF.type, URIRef(f"{TIME}Event")))
    graph.set((URIRef(f"{T}in-tray"), URIRef(f"{TIME}after-event"), clause))
    assert_truthful(graph, tmp_path, capsys)
