"""The clauses of a text are those of its graph, each with all of its words."""

from __future__ import annotations

from gherkin_kit import edited
from kit import EXAMPLES, MODEL, fixture
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.graph.write.build import build_graph
from robbdd_tools.names.clause_places import clauses_in
from robbdd_tools.names.project import Project, Snapshot

EVERYTHING = edited(
    "in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)",
    """(
            ((in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)))
            and (not held: holds(<part> is held by <robot>, after <end>))
            and (a: holds(<part> is held by <robot>, after <end>) or ('lamp' after <end> and 'bell' after <end>))
            and (var y exists in <spots>) such that { (b: holds(<part> is located at <y>, after <end>)
                and (not c: holds(<part> is located at <y>, before <end>))) }
        )""",
    edited(
        "Scenario Template",
        "const set (ns=t) spots { <places.tray_ws>, <places.bench_ws> }\nScenario Template",
        edited(
            "When:",
            "When:\n        event <start> occurs",
            edited(
                "scene: <bench_scene>",
                """scene: <bench_scene>
            Given: 'clean' before <start>
            When: event <end> occurs
            Then: (own: holds(<fetch.part> is held by <fetch.robot>, before <end>) and (not 'dark' after <end>))""",
            ),
        ),
    ),
)
NESTED = """for all ( var x in <goal> ) {
        Given: g: holds(<part> is located at <x>, before <pick-start>)
        for all ( var y in <goal> ) {
            When: Behaviour (ns=t) carry { duration: from <pick-start> until <place-end> <robot> picks <part> }
            Then: 'so' after <end>
        }
    }
}
"""


def in_graph(snapshot: Snapshot, uri: str) -> set[str]:
    """The IRIs of all clauses of a file's graph that are written in that file."""
    built = build_graph(snapshot, uri)
    of = "https://secorolab.github.io/metamodels/acceptance-criteria/bdd#clause-of"
    nodes = {str(node) for node, term, _ in built.graph if str(term) == of}
    return {node for node in nodes if (place := built.sources.node(node)) is not None and place.uri == uri}


def test_every_kind_of_clause_has_the_iri_of_the_graph() -> None:
    case = fixture(EVERYTHING)
    found = {clause.iri for clause in clauses_in(case.snapshot, case.uri)}
    assert found == in_graph(case.snapshot, case.uri)
    assert len(found) == 20


def test_clauses_within_for_all_are_found() -> None:
    head = MODEL[: MODEL.index("    Given:")]
    case = fixture(head + NESTED)
    found = {clause.iri for clause in clauses_in(case.snapshot, case.uri)}
    assert found == in_graph(case.snapshot, case.uri)
    assert len(found) == 5


def test_the_examples_have_the_same_clauses_as_their_graphs() -> None:
    for path in sorted(EXAMPLES.rglob("*.bdd")):
        project, uri = Project(), path_to_uri(path)
        project.load(uri)
        snapshot = project.snapshot()
        found = {clause.iri for clause in clauses_in(snapshot, uri)}
        assert found == in_graph(snapshot, uri), path
        assert found


def test_a_clause_is_all_of_its_text() -> None:
    case = fixture(EVERYTHING)
    texts = {
        clause.name: EVERYTHING[clause.span.start : clause.span.end] for clause in clauses_in(case.snapshot, case.uri)
    }
    assert texts["in-tray"] == "in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)"
    assert texts["lamp"] == "'lamp' after <end>"
    assert texts["carry"].startswith("Behaviour (ns=t) carry {")
    assert texts["carry"].endswith("}")
    assert texts["own"].startswith("own: holds(")
