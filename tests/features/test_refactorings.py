"""Refactorings change the text but not the scenarios, nor the graph where they promise it."""

from __future__ import annotations

import re
from importlib import import_module
from typing import Any

import pytest

from gherkin_kit import feature, read_officially
from kit import EVENTS, EXAMPLES, MODEL, SCENE, TEMPLATE, Fixture, fixture
from robbdd_tools.base.diagnostic import Fix, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.features.refactor_clauses import extracted_clauses
from robbdd_tools.features.refactor_declarations import modernised, split_scene
from robbdd_tools.features.refactor_variations import variation_refactorings
from robbdd_tools.features.rename import rename
from robbdd_tools.graph.write.build import build_graph
from robbdd_tools.names.project import Project

TARGETS = "const set (ns=t) targets { <places.tray_ws>, <places.bench_ws> }\n"
ROWS = MODEL[MODEL.index("                var <fetch.part>") :].rpartition("        }")[0]


def applied(case: Fixture, fix: Fix) -> dict[str, str]:
    """The texts of a project after a change, which must leave it without errors."""
    texts = {uri: text for uri, (_, text) in case.project.texts().items()}
    for edit in sorted(fix.edits, key=lambda edit: edit.span, reverse=True):
        text = texts[edit.uri]
        texts[edit.uri] = text[: edit.span.start] + edit.text + text[edit.span.end :]
    return texts


def scenarios(text: str) -> list[tuple[object, ...]]:
    return [(found.name, found.steps, found.tables) for found in read_officially(feature(text))]


def isomorphic(one: Any, other: Any) -> bool:
    # rdflib's comparison is untyped.
    compare: Any = import_module("rdflib.compare")
    return bool(compare.isomorphic(one, other))


def offered(text: str) -> dict[str, str]:
    """The titles of the refactorings at the cursor, with the resulting texts."""
    case = fixture(text)
    span = Span(case.cursor, case.cursor)
    return {fix.title: applied(case, fix)[case.uri] for fix in variation_refactorings(case.snapshot, case.uri, span)}


def test_a_product_becomes_a_table_and_a_product_again() -> None:
    table = offered(MODEL.replace("variation:", "varia$0tion:"))["Write the product as a table"]
    assert table.count("\n                | <") == 5
    assert scenarios(table) == scenarios(MODEL)
    again = offered(table.replace("variation:", "varia$0tion:"))["Write the table as a product"]
    assert scenarios(again) == scenarios(MODEL)
    assert "var <fetch.robot>: { <arms.panda> }" in again


def test_a_table_that_is_no_product_stays_one() -> None:
    table = "                | <fetch.part> | <fetch.goal> |\n                |---|---|\n"
    rows = "                | <parts.bolt> | <places.tray_ws> |\n                | <parts.nut> | <places.bench_ws> |\n"
    found = offered(MODEL.replace(ROWS, table + rows).replace("variation:", "varia$0tion:"))
    assert "Write the table as a product" not in found


def test_the_values_of_a_constant_set_are_written_where_it_is_named() -> None:
    text = MODEL.replace("Scenario Template", TARGETS + "Scenario Template").replace(
        "{ <places.bench_ws>, <places.tray_ws> }", "set <targets>"
    )
    found = offered(text.replace("set <targets>", "set <tar$0gets>"))["Write the values of 'targets' here"]
    assert "var <fetch.goal>: { <places.tray_ws>, <places.bench_ws> }" in found
    assert scenarios(found) == scenarios(text)


def test_a_table_is_filled_with_what_the_scene_has() -> None:
    table = "                | <fetch.part> | <fetch.robot> | <fetch.goal> |\n                |---|---|---|\n"
    row = "                | <parts.bolt> | <arms.panda> | <places.tray_ws> |\n"
    found = offered(MODEL.replace(ROWS, table + row).replace("variation:", "varia$0tion:"))
    (title,) = [title for title in found if title.startswith("Fill the table")]
    assert title == "Fill the table from the scene (15 more rows)"
    filled = scenarios(found[title])
    assert len(filled) == 16
    (first,) = scenarios(MODEL.replace(ROWS, table + row))
    assert filled[0][1:] == first[1:]


def test_a_scene_moves_to_a_file_of_its_own_and_the_graph_stays() -> None:
    case = fixture(f"//- main.bdd\n{MODEL}//- lab.scene\n{SCENE.replace('scene (ns=env)', 'sce$0ne (ns=env)')}")
    before = build_graph(case.snapshot, case.uri).graph
    fix = split_scene(case.snapshot, "file:///fixture/lab.scene", case.cursor)
    assert fix is not None
    new = fix.new_file
    assert new is not None
    assert (fix.title, new.uri) == ("Move the scene to 'bench_scene.scene'", "file:///fixture/bench_scene.scene")
    project = Project()
    for uri, text in {**applied(case, fix), new.uri: new.text}.items():
        project.open(uri, 1, text)
    snapshot = project.snapshot()
    for uri in snapshot.sources:
        assert [found for found in fast_diagnostics(snapshot, uri) if found.severity is Severity.ERROR] == []
    assert isomorphic(build_graph(snapshot, case.uri).graph, before)


def extracted(text: str) -> tuple[Fixture, dict[str, str], str]:
    """A project with ``$0`` in a variant of its first file, or ``$0`` and ``$1`` around clauses; its texts after, how.

    The change must leave no more findings than there were.
    """
    case = fixture(text.replace("$1", ""))
    first = re.split(r"^//- \S+\n", text, flags=re.MULTILINE)[1 if text.startswith("//-") else 0].replace("$0", "")
    end = first.index("$1") if "$1" in first else case.cursor
    fix = extracted_clauses(case.snapshot, case.uri, Span(case.cursor, end))
    assert fix is not None
    texts = applied(case, fix)
    project = Project()
    for uri, changed in texts.items():
        project.open(uri, 1, changed)
    for uri in texts:
        before = sorted(found.code for found in fast_diagnostics(case.snapshot, uri))
        assert sorted(found.code for found in fast_diagnostics(project.snapshot(), uri)) == before
    return case, texts, fix.title


EXTRA = "extra: holds(<fetch.part> is located at <fetch.goal>, before <end>)"
MORE = "more: holds(<fetch.robot> does not collide <fetch.goal>, from <start> until <end>)"
GIVEN = "free: holds(<fetch.robot> can reach <fetch.part>, before <start>)"


def with_clauses(then: str, given: str = "") -> str:
    """The model with clauses in its variant."""
    parts = f"            Given: {given}\n" if given else ""
    return MODEL.replace("            variation:", f"{parts}            Then: {then}\n            variation:")


def with_other_variant(text: str) -> str:
    """A model with a second variant of the same template, which has no content of its own."""
    variant = MODEL[MODEL.index("        Scenario bench-to-tray") : MODEL.rindex("}")].replace("bench-to-tray", "other")
    end = text.rindex("}")
    return text[:end] + variant + text[end:]


@pytest.mark.parametrize(
    ("then", "given"), [(EXTRA, ""), (f"({EXTRA} and {MORE})", ""), (f"( {EXTRA} and ( not {MORE} ) )", GIVEN)]
)
def test_the_clauses_of_a_lone_variant_move_to_its_template(then: str, given: str) -> None:
    text = with_clauses(then, given)
    case, texts, title = extracted(text.replace("Scenario bench", "Scenario be$0nch"))
    after = texts[case.uri]
    assert title == "Move the clauses to the template 'fetch'"
    assert after.index("extra") < after.index("User Story")
    assert (after.count("Then:"), after.count("Given:")) == (1, 1)
    assert scenarios(after) == scenarios(text)


def test_only_the_selected_clauses_move() -> None:
    text = with_clauses(f"({EXTRA}\n  and $0{MORE[:9]}$1{MORE[9:]} and {GIVEN})")
    case, texts, _ = extracted(text)
    template, story = texts[case.uri].split("User Story")
    assert ("more: " in template, "extra: " in template, "free: " in template) == (True, False, False)
    assert ("more: " in story, "extra: " in story, "free: " in story) == (False, True, True)


def test_a_template_without_that_part_gets_one() -> None:
    then = TEMPLATE[TEMPLATE.index("    Then:") : TEMPLATE.rindex("}")]
    text = with_clauses(f"({EXTRA} and {MORE})").replace(then, "")
    case, texts, _ = extracted(text.replace("Scenario bench", "Scenario be$0nch"))
    assert "    Then:\n        (\n            extra" in texts[case.uri].split("User Story")[0]
    assert scenarios(texts[case.uri]) == scenarios(text)


def test_a_comment_among_the_clauses_keeps_them_where_they_are() -> None:
    case = fixture(with_clauses(f"// why\n$0{EXTRA}"))
    assert extracted_clauses(case.snapshot, case.uri, Span(case.cursor, case.cursor)) is None


def test_policies_for_a_clause_follow_it_to_the_template() -> None:
    policy = """import "main.bdd"
ns x = 'https://example.org/x/'
obs policy (ns=x) seen for <bench-to-tray.extra> { trinary topic: "/seen" }
"""
    main = with_clauses(EXTRA).replace("Scenario bench", "Scenario be$0nch")
    _, texts, _ = extracted(f"//- main.bdd\n{main}//- exec.bddx\n{policy}")
    assert "for <fetch.extra>" in texts["file:///fixture/exec.bddx"]


@pytest.mark.parametrize("given", ["", GIVEN])
def test_the_clauses_of_one_variant_of_several_move_to_a_copy_of_the_template(given: str) -> None:
    text = with_other_variant(with_clauses(f"({EXTRA} and {MORE})", given))
    case, texts, title = extracted(text.replace("Scenario bench", "Scenario be$0nch"))
    after = texts[case.uri]
    assert title == "Extract the clauses to a new template 'fetch-2'"
    assert scenarios(after) == scenarios(text)
    assert TEMPLATE in after
    # The other variant's parts have not changed.
    old, new = template_of(after, "fetch"), template_of(after, "fetch-2")
    others = without(after.replace(new, ""), "bench-to-tray")
    assert isomorphic(graph_of(others), graph_of(without(text, "bench-to-tray")))
    # With the names of the copy taken back, only the owner of the variant's clauses has changed.
    alone = without(after.replace(old, ""), "other").replace("-2", "")
    before = graph_of(without(text, "other"))
    clauses = ["on-bench", *(["free"] if given else []), "when-bhv-fetch.when", "in-tray", "extra", "more"]
    expected = with_clauses_of(with_clauses_of(before, "bench-to-tray", []), "fetch", clauses)
    assert isomorphic(graph_of(alone), expected)
    assert not isomorphic(graph_of(alone), before)


def test_some_clauses_move_to_a_copy_and_the_rest_names_its_variables() -> None:
    text = with_other_variant(with_clauses(f"($0{EXTRA}$1 and {MORE})"))
    case, texts, _ = extracted(text)
    story = texts[case.uri].split("User Story")[1]
    assert "more: holds(<fetch-2.robot> does not collide <fetch-2.goal>" in story
    assert "var <fetch-2.part>: obj set <parts>" in story
    assert "var <fetch.part>: obj set <parts>" in story
    assert "extra" not in story


def test_a_template_of_another_file_is_copied_into_that_of_the_story() -> None:
    story = with_clauses(EXTRA)[len(EVENTS + TEMPLATE) :].replace("Scenario bench", "Scenario be$0nch")
    head = "import \"library.bdd\"\nns own = 'https://example.org/own/'\n"
    main = head + story.replace("(ns=t)", "(ns=own)")
    _, texts, title = extracted(f"//- main.bdd\n{main}//- library.bdd\n{EVENTS}{TEMPLATE}")
    assert title == "Extract the clauses to a new template 'fetch-2'"
    assert texts["file:///fixture/library.bdd"] == EVENTS + TEMPLATE
    assert "Scenario Template (ns=own) fetch-2 {" in texts["file:///fixture/main.bdd"]


def test_a_variant_that_is_observed_by_policies_keeps_its_template() -> None:
    execution = """import "main.bdd"
ns x = 'https://example.org/x/'
obs policy (ns=x) seen for <fetch.in-tray> { trinary topic: "/seen" }
Scenario Exec (ns=x) run { variant: <fetching.NAME> scene inst: <bench> bhv: <built-in> policies: { <seen> } }
"""
    main = with_other_variant(with_clauses(EXTRA)).replace("Scenario bench", "Scenario be$0nch")
    for name, is_offered in (("bench-to-tray", False), ("other", True)):
        case = fixture(f"//- main.bdd\n{main}//- exec.bddx\n{execution.replace('NAME', name)}")
        fix = extracted_clauses(case.snapshot, case.uri, Span(case.cursor, case.cursor))
        assert (fix is not None) == is_offered


def graph_of(text: str) -> Any:
    case = fixture(text)
    return build_graph(case.snapshot, case.uri).graph


def template_of(text: str, name: str) -> str:
    """The text of a template."""
    start = text.index(f"Scenario Template (ns=t) {name} {{")
    return text[start : text.index("\n}\n", start) + 3]


def without(text: str, variant: str) -> str:
    """A model without one of its variants."""
    start = text.index(f"        Scenario {variant} {{")
    end = text.index("\n        }\n", start) + len("\n        }\n")
    return text[:start] + text[end:]


def with_clauses_of(graph: Any, owner: str, clauses: list[str]) -> Any:
    """A graph in which a template or variant has just these clauses."""
    rdflib: Any = import_module("rdflib")
    collection: Any = import_module("rdflib.collection")
    names = rdflib.Namespace("https://example.org/t/")
    has_clause = rdflib.URIRef("https://secorolab.github.io/metamodels/acceptance-criteria/bdd#has-clause")
    changed = rdflib.Graph() + graph
    old = changed.value(names[owner], has_clause)
    collection.Collection(changed, old).clear()
    changed.remove((names[owner], has_clause, old))
    start = rdflib.BNode() if clauses else rdflib.RDF.nil
    collection.Collection(changed, start, [names[clause] for clause in clauses])
    changed.add((names[owner], has_clause, start))
    return changed


def test_the_published_form_becomes_the_current_one_and_the_graph_stays() -> None:
    text = MODEL.replace("Event (ns=t) start", "Event start").replace("Task (ns=t)", "Task")
    case = fixture(text)
    fix = modernised(case.snapshot, case.uri)
    assert fix is not None
    after = fixture(applied(case, fix)[case.uri])
    assert modernised(after.snapshot, after.uri) is None
    assert isomorphic(build_graph(after.snapshot, after.uri).graph, build_graph(case.snapshot, case.uri).graph)


@pytest.mark.parametrize(
    ("file", "word", "name"),
    [
        ("pickplace/pickplace.bdd", "Event (ns=crit) evt-pick-end", "evt-grasped"),
        ("pickplace/pickplace.bdd", "var thing", "item"),
        ("pickplace/pickplace.bdd", "Template (ns=crit) pick-place", "carry-over"),
        ("pickplace/pickplace.bdd", "at-goal", "arrived"),
        ("pickplace/bench.scene", "workspace left_ws", "near_ws"),
        ("pickplace/bench.scene", "set (ns=env) places", "spots"),
        ("tworobots/cell.scene", "agent ur10", "ur10e"),
    ],
)
def test_a_rename_changes_one_iri_of_the_graph_and_nothing_else(file: str, word: str, name: str) -> None:
    path = EXAMPLES / file
    project = Project()
    opened = sorted(entry for entry in path.parent.iterdir() if entry.suffix in (".bdd", ".scene"))
    for entry in opened:
        project.open(path_to_uri(entry), 1, entry.read_text(encoding="utf-8"))
    uri = path_to_uri(path)
    main = next(path_to_uri(entry) for entry in opened if entry.suffix == ".bdd")
    offset = path.read_text(encoding="utf-8").index(word) + len(word)
    snapshot = project.snapshot()
    old = word.replace("(ns=crit) ", "").replace("(ns=env) ", "").rsplit(" ", 1)[-1]
    before = build_graph(snapshot, main).graph.serialize(format="nt")
    case = Fixture(project, uri, offset, ())
    texts = applied(case, Fix("", tuple(rename(snapshot, uri, offset, name))))
    for changed, text in texts.items():
        project.open(changed, 2, text)
    after = build_graph(project.snapshot(), main).graph
    rdflib: Any = import_module("rdflib")
    renamed = rdflib.Graph().parse(data=_renamed(before, old, name), format="nt")
    assert isomorphic(renamed, after)
    assert not isomorphic(rdflib.Graph().parse(data=before, format="nt"), after)


def _renamed(triples: str, old: str, new: str) -> str:
    """Replace a local name everywhere in an IRI or a literal, alone or in the name of a part."""
    before = r"(?<![\w\-])|(?<=var-)|(?<=when-bhv-)"
    return re.sub(rf"(?:{before}){old}(?=-scen(?:ario|e)|(?![\w\-]))", new, triples)
