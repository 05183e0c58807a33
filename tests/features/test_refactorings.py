"""Refactorings change the text and leave the scenarios, and where they say so the graph, as they are."""

from __future__ import annotations

import re
from importlib import import_module
from typing import Any

import pytest

from gherkin_kit import feature, read_officially
from kit import EXAMPLES, MODEL, SCENE, Fixture, fixture
from robbdd_tools.base.diagnostic import Fix, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.features.refactor_declarations import extracted_clauses, modernised, split_scene
from robbdd_tools.features.refactor_variations import variation_refactorings
from robbdd_tools.features.rename import rename
from robbdd_tools.graph.build import build_graph
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
    # rdflib's comparison comes without types.
    compare: Any = import_module("rdflib.compare")
    return bool(compare.isomorphic(one, other))


def offered(text: str) -> dict[str, str]:
    """The titles of what is offered at the cursor, with the text that comes of each."""
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
    found = split_scene(case.snapshot, "file:///fixture/lab.scene", case.cursor)
    assert found is not None
    fix, new = found
    assert (fix.title, new.uri) == ("Move the scene to 'bench_scene.scene'", "file:///fixture/bench_scene.scene")
    project = Project()
    for uri, text in {**applied(case, fix), new.uri: new.text}.items():
        project.open(uri, 1, text)
    snapshot = project.snapshot()
    for uri in snapshot.sources:
        assert [found for found in fast_diagnostics(snapshot, uri) if found.severity is Severity.ERROR] == []
    assert isomorphic(build_graph(snapshot, case.uri).graph, before)


def test_the_clauses_of_a_lone_variant_move_to_its_template() -> None:
    clause = "            Then:\n                extra: holds(<fetch.part> is located at <fetch.goal>, before <end>)\n"
    text = MODEL.replace("            variation:", f"{clause}            variation:")
    case = fixture(text.replace("Scenario bench", "Scenario be$0nch"))
    fix = extracted_clauses(case.snapshot, case.uri, case.cursor)
    assert fix is not None
    after = applied(case, fix)[case.uri]
    assert after.index("extra") < after.index("User Story")
    assert after.count("Then:") == 1
    assert scenarios(after) == scenarios(text)


def test_the_clauses_of_one_variant_of_several_stay_where_they_are() -> None:
    clause = "            Then: extra: holds(<fetch.part> is located at <fetch.goal>, before <end>)\n"
    text = MODEL.replace("            variation:", f"{clause}            variation:")
    variant = text[text.index("        Scenario bench-to-tray") : text.rindex("}")]
    text = text.replace(variant, variant + variant.replace("bench-to-tray", "other").replace("extra", "extra2"))
    case = fixture(text.replace("Scenario bench", "Scenario be$0nch"))
    assert extracted_clauses(case.snapshot, case.uri, case.cursor) is None


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
    """Replace a local name wherever it stands in an IRI or a literal, by itself or in the name of a part."""
    before = r"(?<![\w\-])|(?<=var-)|(?<=when-bhv-)"
    return re.sub(rf"(?:{before}){old}(?=-scen(?:ario|e)|(?![\w\-]))", new, triples)
