"""Quick fixes: applying one removes its finding and adds no error; those of names do what their titles say."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from pathlib import Path

import pytest

from checks.models import apply, fixed, fixes_of, found
from features.broken import BROKEN
from kit import DOCS, EVENTS, MODEL, SCENE, TEMPLATE, Fixture, fixture
from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.features.diagnostics import all_diagnostics, fast_diagnostics
from robbdd_tools.features.fixes_on_demand import fixes_on_demand
from robbdd_tools.names.project import Project


def titles(text: str) -> list[str]:
    case = fixture(text)
    found = fast_diagnostics(case.snapshot, case.uri)
    return [fix.title for entry in found for fix in fixes_of(case, entry)]


TRIED = {
    *BROKEN,
    *("model-file", "model-name", "clause-undefined", "python-source", "unknown-namespace", "imported-statement"),
    *("log-name", "pose"),
}
"""Codes with a fix; those of files that are not models, of logs, imported graphs and built scenes have their own tests.

The fix of a clause without a step is a command, which writes such a file.
"""
LAYOUTS: dict[str, Callable[[str], str]] = {
    "as written": lambda text: text,
    "crlf": lambda text: text.replace("\n", "\r\n"),
    "tabs": lambda text: text.replace("    ", "\t"),
    "comments": lambda text: text.replace("\n", "  // größer als <nichts> {\n"),
}
CASES = [(code, number) for code, models in BROKEN.items() for number in range(len(models))]


def everything(case: Fixture) -> list[Diagnostic]:
    """The fast diagnostics of all files."""
    return [entry for uri in case.project.texts() for entry in fast_diagnostics(case.snapshot, uri)]


def counted(findings: list[Diagnostic]) -> Counter[tuple[str, str]]:
    """How many findings of each code there are in each file."""
    return Counter((entry.uri, entry.code) for entry in findings)


def laid_out(text: str, layout: Callable[[str], str]) -> str:
    """A fixture whose files have another layout; the lines that name them stay."""
    return "".join(line if line.startswith("//- ") else layout(line) for line in text.splitlines(keepends=True))


@pytest.mark.parametrize("layout", LAYOUTS.values(), ids=LAYOUTS.keys())
@pytest.mark.parametrize(("code", "number"), CASES)
def test_each_fix_mends_its_finding_and_adds_no_error(code: str, number: int, layout: Callable[[str], str]) -> None:
    text = laid_out(BROKEN[code][number], layout)
    planted = fixture(text)
    before = everything(planted)
    offered = [
        (at, nth)
        for at, entry in enumerate(before)
        if entry.code == code
        for nth in range(len(fixes_of(planted, entry)))
    ]
    assert offered, before
    for at, nth in offered:
        case = fixture(text)
        finding = everything(case)[at]
        fix = fixes_of(case, finding)[nth]
        apply(case, fix)
        after = everything(case)
        assert (finding.uri, finding.code) in counted(before) - counted(after), (fix, after)
        added = counted([entry for entry in after if entry.severity is Severity.ERROR]) - counted(before)
        assert not added, (fix, after)


def test_every_finding_has_a_tried_quick_fix_or_its_page_says_why_there_is_none() -> None:
    pages = {page.stem: page.read_text(encoding="utf-8") for page in (DOCS / "diagnostics").glob("*.md")}
    del pages["README"]
    without = {code for code, page in pages.items() if "\nThere is no quick fix: " in page}
    assert {code for code, page in pages.items() if "quick fix" in page.lower()} == set(pages)
    assert without.isdisjoint(TRIED)
    assert without | TRIED == set(pages)


def test_a_model_file_is_changed_to_one_of_a_like_name_or_made(tmp_path: Path) -> None:
    (tmp_path / "models").mkdir()
    for name in ("models/bench2.xml", "models/bench.usda", "arm.xml"):
        (tmp_path / name).write_text("<mujoco/>", encoding="utf-8")
    uri = path_to_uri(tmp_path / "main.scenex")
    text = "ns x = 'http://x/'\nscene inst (ns=x) s { scene: <s> model world as mjcf { sys path = 'bench.xml' } }\n"
    project = Project()
    project.open(uri, 1, text)
    snapshot = project.snapshot()
    finding = next(entry for entry in fast_diagnostics(snapshot, uri) if entry.code == "model-file")
    renamed, made = fixes_on_demand(snapshot, uri, finding)
    assert (renamed.title, made.title) == ("Change to 'models/bench2.xml'", "Create 'bench.xml' with an empty model")
    (edit,) = renamed.edits
    changed = text[: edit.span.start] + edit.text + text[edit.span.end :]
    assert changed == text.replace("bench.xml", "models/bench2.xml")
    assert made.new_file is not None
    gripper = text.replace("'bench.xml'", "'models/bench2.xml' gripper { sys path = 'am.xml' on: 'x' }")
    project.open(uri, 2, gripper)
    missing = next(entry for entry in fast_diagnostics(project.snapshot(), uri) if "am.xml" in entry.message)
    (alike,) = fixes_on_demand(project.snapshot(), uri, missing)
    assert alike.title == "Change to 'arm.xml'"
    (tmp_path / "bench.xml").write_text(made.new_file.text, encoding="utf-8")
    assert made.new_file.uri == path_to_uri(tmp_path / "bench.xml")
    for after in (changed, text):
        project.open(uri, 2, after)
        assert not [entry for entry in fast_diagnostics(project.snapshot(), uri) if entry.code == "model-file"]


def scene_after(text: str) -> str:
    case = fixture(text)
    (finding,) = (entry for entry in everything(case) if entry.code == "not-in-scene")
    (fix,) = fixes_of(case, finding)
    apply(case, fix)
    assert not [
        entry
        for uri in case.project.texts()
        for entry in all_diagnostics(case.snapshot, uri)
        if entry.code in ("not-in-scene", "shacl") or entry.severity is Severity.ERROR
    ]
    return case.project.texts()["file:///fixture/lab.scene"][1]


def test_the_set_of_an_element_is_added_to_the_scene_as_its_entries_are_laid_out() -> None:
    inline, lines, imported = (scene_after(text) for text in BROKEN["not-in-scene"])
    assert "agn set <arms> ws set <places> }\n" in inline
    assert "    ws set <places>\n    obj set <furniture>  // all of them\n" in lines
    assert imported.startswith('import "more.scene"\n')
    assert "agn set <arms> obj set <tools> }\n" in imported


def test_what_has_the_iri_of_something_else_is_renamed_with_its_uses() -> None:
    other = "//- m.bdd\nns m = 'https://example.org/t/'\nEvent (ns=m) end\n"
    text = "//- main.bdd\nimport 'm.bdd'\n" + MODEL + other
    fresh = fixed(text, "duplicate-iri", "Rename to 'end-2'")
    assert fresh == "import 'm.bdd'\n" + MODEL.replace("<end>", "<end-2>").replace("t) end\n", "t) end-2\n")


def test_an_import_of_a_circle_is_removed_where_nothing_needs_it() -> None:
    both = "//- main.bdd\nimport 'm.bdd'\n" + MODEL.replace("task: <task>", "task: <idle>").replace(
        "t) task", "t) busy"
    )
    other = "//- m.bdd\nimport 'main.bdd'\nns m = 'https://example.org/m/'\nTask (ns=m) idle\n"
    assert titles(both + other)[:1] == ["Remove the import of 'main.bdd' from 'm.bdd', which does not need it"]
    needing = other + "Scenario Template (ns=m) x { task: <busy> var a var b When: <a> picks <b> }\n"
    assert not [title for title in titles(both + needing) if "import of" in title]


def test_a_name_of_a_file_beside_is_imported() -> None:
    text = "//- main.bdd\n" + MODEL.replace('import "lab.scene"\n', "")
    assert fixed(text, "unknown-name", "Import 'lab.scene'") == MODEL.replace('import "lab.scene"\n', "").replace(
        "ns t", 'import "lab.scene"\nns t', 1
    )


def test_an_import_comes_below_the_others() -> None:
    other = "//- more.scene\nns x = 'https://example.org/x/'\nagn set (ns=x) robots { agent r2 }\n"
    text = "//- main.bdd\n" + MODEL.replace("<arms.panda>", "<robots.r2>")
    assert fixed(text + other, "unknown-name", "Import").startswith('import "lab.scene"\nimport "more.scene"\n')


def test_an_import_is_offered_for_the_right_kind_only() -> None:
    other = "//- more.scene\nns x = 'https://example.org/x/'\nobj set (ns=x) robots { object r2 }\n"
    text = "//- main.bdd\n" + MODEL.replace("<arms.panda>", "<robots.r2>")
    assert "Import 'more.scene'" in titles(text + other)
    assert titles("//- main.bdd\n" + MODEL.replace("before <pick-start>", "before <robots>") + other) == [
        "Declare the event 'robots'"
    ]


def test_a_file_that_nobody_opened_is_found_on_disk(tmp_path: Path) -> None:
    (tmp_path / "lab.scene").write_text(SCENE, encoding="utf-8")
    (tmp_path / "broken.scene").write_bytes(b"\xff\xfe")
    uri = path_to_uri(tmp_path / "main.bdd")
    project = Project()
    project.open(uri, 1, MODEL.replace('import "lab.scene"\n', ""))
    snapshot = project.snapshot()
    unknown = next(entry for entry in fast_diagnostics(snapshot, uri) if entry.code == "unknown-name")
    assert [fix.title for fix in fixes_on_demand(snapshot, uri, unknown)] == ["Import 'lab.scene'"]


def test_the_path_of_an_import_is_changed_to_one_that_leads_to_a_file(tmp_path: Path) -> None:
    (tmp_path / "cells").mkdir()
    for name in ("labs.scene", "cells/lab.scene", "other.scene", "lab.bddx"):
        (tmp_path / name).write_text("", encoding="utf-8")
    uri, project = path_to_uri(tmp_path / "main.bdd"), Project()
    project.open(uri, 1, MODEL)
    snapshot = project.snapshot()
    missing = next(entry for entry in fast_diagnostics(snapshot, uri) if entry.code == "import")
    found = fixes_on_demand(snapshot, uri, missing)
    titles = ["Change to 'cells/lab.scene'", "Change to 'labs.scene'", "Create 'lab.scene'"]
    assert [fix.title for fix in found] == titles
    ((edit,), *_) = (fix.edits for fix in found)
    assert MODEL[: edit.span.start] + edit.text + MODEL[edit.span.end :] == MODEL.replace("lab.scene", edit.text, 1)


@pytest.mark.parametrize(
    ("old", "new", "title", "declared"),
    [
        ("before <pick-start>", "before <lift>", "Declare the event 'lift'", "Event (ns=t) end\nEvent (ns=t) lift\n"),
        ("task: <task>", "task: <other>", "Declare the task 'other'", "Event (ns=t) end\nTask (ns=t) other\n"),
        ("<robot> picks", "<crane> picks", "Declare 'var crane'", "    var goal\n    var crane\n"),
        ("var <fetch.robot>:", "var <fetch.arm>:", "Declare 'var arm' in 'fetch'", "    var goal\n    var arm\n"),
    ],
)
def test_a_missing_declaration_is_written(old: str, new: str, title: str, declared: str) -> None:
    assert MODEL.count(old) == 1
    text = MODEL.replace(old, new)
    case = [fix for entry in found(text, "unknown-name") for fix in entry.fixes if fix.title.startswith(title)]
    assert len(case) == 1
    (edit,) = case[0].edits
    assert declared in text[: edit.span.start] + edit.text + text[edit.span.end :]


def test_a_declared_event_stands_behind_a_comment() -> None:
    text = MODEL.replace("Event (ns=t) end\n", "Event (ns=t) end // the last\n").replace(
        "before <pick-start>", "before <lift>"
    )
    assert "// the last\nEvent (ns=t) lift\n" in fixed(text, "unknown-name", "Declare the event")


def test_a_set_variable_is_declared_for_a_quantifier() -> None:
    template = TEMPLATE.replace(
        "in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)",
        "( var y exists in <goals> ) such that { in-tray: holds(<part> is located at <y>, after <end>) }",
    )
    text = EVENTS + template
    assert "    var goal\n    set var goals\n" in fixed(text, "unknown-name", "Declare 'set var goals'")


def test_a_link_gets_the_keyword_of_what_it_names() -> None:
    text = MODEL.replace("obj set <parts>", "ws set <parts>")
    assert fixed(text, "wrong-kind") == MODEL
    scene = "//- lab.scene\n" + SCENE.replace("agn set <arms> }", "obj set <arms> }")
    assert fixed(scene, "wrong-kind") == SCENE
    comp = "//- lab.scene\n" + SCENE.replace("ws comp <tray_comp> }\nscene", "ws <tray_comp> }\nscene")
    assert fixed(comp, "wrong-kind") == SCENE


def test_a_wrong_kind_elsewhere_has_no_certain_fix() -> None:
    assert titles(MODEL.replace("before <pick-start>", "before <task>")) == []
