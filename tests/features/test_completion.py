"""Completion offers what the grammar accepts at the cursor, by kind and scope of names."""

from pathlib import Path

import pytest

from kit import MODEL, fixture
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.features.completion import Completion, complete
from robbdd_tools.names.project import Project


def at(text: str) -> list[Completion]:
    case = fixture(text)
    return complete(case.snapshot, next(uri for uri in case.project.texts() if uri.endswith("main.bdd")), case.cursor)


def labels(text: str) -> list[str]:
    return [entry.label for entry in at(text)]


def edited(old: str, new: str) -> str:
    assert old in MODEL
    return MODEL.replace(old, new, 1)


def test_an_empty_file_offers_declarations() -> None:
    assert labels("$0") == [
        "Behaviour Tree",
        "Event",
        "Scenario Template",
        "Task",
        "User Story",
        "const set",
        "import",
        "ns",
    ]


def test_behind_a_declaration_another_one_may_begin() -> None:
    assert "Scenario Template" in labels(MODEL + "\nScen$0")
    assert labels(MODEL + "\nScenario $0") == ["Template"]


def test_after_before_only_events_are_offered() -> None:
    events = ["end", "pick-start", "place-end", "start"]
    assert labels(edited("before <pick-start>", "before <$0>")) == events
    assert labels(edited("before <pick-start>", "before <pi$0>")) == events


def test_a_reference_is_closed_when_it_was_not() -> None:
    inserted = [entry.text for entry in at(edited("before <pick-start>", "before <$0"))]
    assert inserted == ["end>", "pick-start>", "place-end>", "start>"]
    assert [entry.text for entry in at(edited("<start> until", "$0 until"))] == [
        "<end>",
        "<pick-start>",
        "<place-end>",
        "<start>",
    ]


def test_variables_of_the_enclosing_template_are_offered_by_their_short_names() -> None:
    assert labels(edited("<robot> picks", "<$0> picks")) == ["goal", "part", "robot"]


def test_variables_are_qualified_outside_their_template() -> None:
    assert labels(edited("var <fetch.part>", "var <$0>")) == ["fetch.goal", "fetch.part", "fetch.robot"]


def test_predicates_are_offered_as_whole_phrases() -> None:
    phrases = labels(edited("<part> is located at <goal>, before", "<part> $0, before"))
    assert phrases == [
        "are sorted into",
        "can reach",
        "does not collide",
        "does not drop",
        "has config",
        "is held by",
        "is located at",
        "moves safely",
    ]


def test_a_half_typed_keyword_is_replaced() -> None:
    (entry,) = at(edited("scene: <bench_scene>", "sce$0"))
    assert (entry.label, entry.text) == ("scene", "scene")
    assert entry.span.end - entry.span.start == 3


def test_a_template_is_completed_inside_a_variant() -> None:
    assert labels(edited("template: <fetch>", "template: <$0>")) == ["fetch"]
    assert labels(edited("scene: <bench_scene>", "scene: <$0>")) == ["bench_scene"]


def test_values_are_the_elements_of_imported_scenes() -> None:
    found = labels(edited("obj set <parts>", "{ <$0> }"))
    assert "parts.bolt" in found
    assert "washers.washer2" in found
    assert "parts" not in found


def test_an_import_offers_the_models_beside_it(tmp_path: Path) -> None:
    for name in ("b.scene", "a.bdd", "notes.txt", "main.bdd"):
        (tmp_path / name).touch()
    uri = path_to_uri(tmp_path / "main.bdd")
    project = Project()
    project.open(uri, 1, 'import "')
    assert [entry.label for entry in complete(project.snapshot(), uri, 8)] == ["a.bdd", "b.scene"]


@pytest.mark.parametrize("text", ["// befo$0", 'const set (ns=t) s { "be$0" }', "const set (ns=t) s { 'be$0"])
def test_nothing_is_offered_in_comments_and_strings(text: str) -> None:
    assert labels(text) == []


def test_completion_works_behind_a_broken_declaration() -> None:
    text = edited("task: <task>", "tusk: <task>") + "const set (ns=t) s { <$0> }"
    assert "parts.bolt" in labels(text)


def test_completion_uses_the_names_of_a_broken_declaration() -> None:
    broken = edited("task: <task>", "tusk: <task>")
    assert labels(broken.replace("var <fetch.part>", "var <$0>", 1)) == ["fetch.goal", "fetch.part", "fetch.robot"]
