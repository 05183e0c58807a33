"""Completion offers the tokens that the grammar accepts at the cursor, by kind and scope of names."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from kit import MODEL, MODELS, ROOT, SCENE, fixture
from robbdd_tools.base.document import Span
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.features.completion import complete
from robbdd_tools.features.describe_entry import describe_entry
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.features.fixes_on_demand import fixes_on_demand
from robbdd_tools.features.layout import lay_out
from robbdd_tools.features.name_completion import Completion
from robbdd_tools.features.snippets import declaration_snippets
from robbdd_tools.features.unimported import Elsewhere
from robbdd_tools.names.project import Project
from robbdd_tools.syntax.parse import parse_declaration


def at(text: str) -> list[Completion]:
    case = fixture(text)
    return complete(case.snapshot, next(uri for uri in case.project.texts() if uri.endswith("main.bdd")), case.cursor)


def labels(text: str) -> list[str]:
    return [entry.label for entry in at(text) if entry.kind != "snippet"]


def edited(old: str, new: str) -> str:
    assert old in MODEL
    return MODEL.replace(old, new, 1)


def test_an_empty_file_offers_declarations() -> None:
    assert labels("$0") == [
        "Behaviour Tree",
        "Event",
        "Predicate",
        "Requirement",
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
    found = labels(edited("<robot> picks", "<$0> picks"))
    assert found[:3] == ["goal", "part", "robot"]
    assert {"arms.panda", "parts.bolt", "places.tray_ws"} <= set(found[3:])


def test_variables_are_qualified_outside_their_template() -> None:
    assert labels(edited("var <fetch.part>", "var <$0>")) == ["fetch.goal", "fetch.part", "fetch.robot"]


def test_predicates_are_offered_as_whole_phrases() -> None:
    phrases = labels(edited("<part> is located at <goal>, before", "<part> $0, before"))
    catalog = load_catalog().predicates.values()
    begun = [one for one in catalog if one.phrase.startswith("<")]
    assert phrases == sorted(re.sub(r"^<\w+>|<.*|[$#].*", "", one.phrase).strip() for one in begun)
    assert "is located at" in phrases


def test_a_duration_is_offered_where_a_clause_begins_but_not_as_a_condition() -> None:
    clause = "<part> is located at <goal>, before"
    assert "it takes less than" in labels(edited(clause, "$0, before"))
    assert "it takes less than" not in labels(edited(clause, "<part> is located at <goal> whenever $0, before"))


def test_conditions_and_windows_are_offered_after_a_predicate() -> None:
    assert "whenever" in labels(edited("<goal>, before", "<goal> $0, before"))
    assert {"after", "at some time from", "before", "from", "within"} <= set(
        labels(edited("before <pick-start>", "$0"))
    )
    assert {"every", "the"} <= {
        label.split()[0] for label in labels(edited("before <pick-start>", "before $0 <pick-start>"))
    }
    assert "is held by" in labels(edited("<goal>, before", "<goal> whenever <part> $0, before"))


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
    assert "parts" not in found


def test_values_are_those_of_their_type_in_the_scene_of_their_variant() -> None:
    assert labels(edited("obj set <parts>", "{ <$0> }")) == [
        "furniture.bench",
        "furniture.tray",
        "parts.bolt",
        "parts.nut",
    ]
    assert labels(edited("obj set <parts>", "obj set <$0")) == ["furniture", "parts"]
    assert labels(edited("scene: <bench_scene>", "scene: <gone>").replace("obj set <parts>", "obj set <$0")) == [
        "furniture",
        "parts",
        "washers",
    ]


def test_cells_of_a_table_take_values_of_their_column() -> None:
    rows = MODEL[MODEL.index("                var <fetch.part>") :].rpartition("        }")[0]
    table = "| <fetch.robot> | <fetch.goal> |\n|---|---|\n| <arms.panda> | <places.bench_ws> |\n"
    text = MODEL.replace(rows, table + "| <$0> |\n")
    assert labels(text) == ["arms.panda", "arms.ur10"]
    text = MODEL.replace(rows, table + "| <arms.panda> | <pl$0")
    assert labels(text) == ["places.bench_ws", "places.tray_ws"]


def test_an_import_offers_what_it_may_import_beside_it_and_in_folders(tmp_path: Path) -> None:
    for name in ("b.scene", "a.bdd", "notes.txt", "main.bdd", "c.bddx"):
        (tmp_path / name).touch()
    (tmp_path / "cells").mkdir()
    (tmp_path / "cells" / "c.scene").touch()
    uri = path_to_uri(tmp_path / "main.bdd")
    project = Project()
    project.open(uri, 1, 'import "')
    assert [entry.label for entry in complete(project.snapshot(), uri, 8)] == ["a.bdd", "b.scene", "cells/"]
    project.open(uri, 2, 'import "cells/c.sc"')
    (found,) = complete(project.snapshot(), uri, len('import "cells/c'))
    assert (found.label, found.text) == ("c.scene", "c.scene")
    assert (found.span, found.whole) == (Span(14, 15), Span(14, 18))


def test_a_model_offers_the_files_that_it_may_be_in_and_what_the_catalog_has(tmp_path: Path) -> None:
    for name in ("arm.xml", "arm.urdf", "notes.txt", "other.scenex"):
        (tmp_path / name).touch()
    uri, project = path_to_uri(tmp_path / "main.scenex"), Project()
    begun = "scene inst (ns=x) s { scene: <s> agn <arms.panda> { model m as mjcf { "
    found: list[list[str]] = []
    for ending in ("sys path = '", 'catalog "'):
        project.open(uri, 1, begun + ending)
        found.append([entry.label for entry in complete(project.snapshot(), uri, len(begun + ending))])
    assert found[0] == ["arm.urdf", "arm.xml"]
    assert {"franka-panda", "cube"} <= set(found[1])
    assert "pick-place" not in found[1]


def test_an_execution_offers_the_behaviours_of_the_catalog() -> None:
    case = fixture('//- main.bddx\nbhv impl (ns=x) b { catalog "pi$0ck-p" }')
    found = {entry.label: entry for entry in complete(case.snapshot, case.uri, case.cursor)}
    assert (found["pick-place"].span.end - found["pick-place"].span.start, found["pick-place"].text) == (
        2,
        "pick-place",
    )
    assert "franka-panda" not in found


def test_parts_of_a_tree_are_offered_as_they_are_named_where_they_stand() -> None:
    poses = "kgraph (ns=x) g { body a { frame one { } frame two { } } body b { frame three { pose p { wrt: <"
    start = "//- main.scenex\nns x = 'http://x/'\nscene inst (ns=x) s { scene: <none> "

    def found(text: str) -> list[str]:
        case = fixture(start + text)
        return [entry.label for entry in complete(case.snapshot, case.uri, case.cursor)]

    assert found(f"{poses}$0") == ["a.one", "a.two", "three"]
    assert found(f"{poses}b.$0") == ["a.one", "a.two", "b.three"]
    closed = poses.removesuffix("pose p { wrt: <") + "} } } obj <o> { camera c { frame: <$0"
    assert found(closed) == ["g.a.one", "g.a.two", "g.b.three"]


@pytest.mark.parametrize("language", ["bdd", "scene", "scenex", "ktree", "bddx"])
def test_every_declaration_has_a_snippet_that_parses(language: str) -> None:
    case = fixture(f"//- main.{language}\n$0")
    found = [entry for entry in complete(case.snapshot, case.uri, 0) if entry.kind == "snippet"]
    keywords = {entry.label for entry in complete(case.snapshot, case.uri, 0) if entry.kind == "keyword"}
    assert {entry.label.removesuffix(" …").split()[0] for entry in found} == {word.split()[0] for word in keywords}
    for snippet in declaration_snippets(language):
        assert parse_declaration(language, snippet.plain).faults == ()
        assert lay_out(snippet.plain) == snippet.plain + "\n"


def test_the_snippets_whose_colours_the_extension_tests_are_the_servers(tmp_path: Path) -> None:
    script = ROOT / "client-vscode" / "scripts" / "snippets.py"
    subprocess.run([sys.executable, str(script), str(tmp_path)], check=True)
    written = {path.name: path.read_text(encoding="utf-8") for path in tmp_path.iterdir()}
    folder = ROOT / "client-vscode" / "test" / "snippets"
    shipped = {path.name: path.read_text(encoding="utf-8") for path in folder.iterdir()}
    assert shipped == written, f"the grammar has changed: run {script.relative_to(ROOT)}"


def test_a_name_of_a_file_that_is_not_imported_brings_its_import() -> None:
    other = "//- cells/more.scene\nns x = 'https://example.org/x/'\nscene (ns=x) other_scene { }\n"
    text = "//- main.bdd\n" + edited("scene: <bench_scene>", "scene: <oth$0") + other
    case = fixture(text)
    (found,) = [entry for entry in complete(case.snapshot, case.uri, case.cursor) if entry.label == "other_scene"]
    assert (found.text, found.detail) == ("other_scene>", "scene, imports 'cells/more.scene'")
    (edit,) = found.edits
    assert edit.text == '\nimport "cells/more.scene"'


def test_values_of_a_file_that_is_not_imported_are_those_of_their_type() -> None:
    other = "//- more.scene\nns x = 'https://example.org/x/'\nobj set (ns=x) tools { object saw }\n"
    other += "agn set (ns=x) robots { agent r2 }\n"
    text = edited("{ <arms.panda> }", "{ <$0").replace("scene: <bench_scene>", "scene: <gone>")
    case = fixture("//- main.bdd\n" + text + other)
    found = [entry for entry in complete(case.snapshot, case.uri, case.cursor) if entry.edits]
    assert [(entry.label, entry.edits[0].text) for entry in found] == [("robots.r2", '\nimport "more.scene"')]


def test_a_name_on_disk_that_nobody_has_loaded_brings_its_import(tmp_path: Path) -> None:
    (tmp_path / "lab.scene").write_text(SCENE, encoding="utf-8")
    uri = path_to_uri(tmp_path / "main.bdd")
    text = MODEL.replace('import "lab.scene"\n', "")
    project = Project()
    project.open(uri, 1, text)
    at_scene = text.index("<bench_scene>") + 1
    assert [entry.edits[0].text for entry in complete(project.snapshot(), uri, at_scene)] == ['import "lab.scene"\n']


def test_a_name_of_a_file_elsewhere_in_the_workspace_brings_its_import(tmp_path: Path) -> None:
    (tmp_path / "cells").mkdir()
    lab = tmp_path / "cells" / "lab.scene"
    lab.write_text(SCENE, encoding="utf-8")
    uri, elsewhere, project = path_to_uri(tmp_path / "story" / "main.bdd"), Elsewhere(), Project()
    elsewhere.update([path_to_uri(lab), path_to_uri(tmp_path / "gone.scene")])
    text = MODEL.replace('import "lab.scene"\n', "")
    project.open(uri, 1, text)
    at_scene = text.index("<bench_scene>") + 1
    (found,) = complete(project.snapshot(), uri, at_scene, elsewhere)
    assert [edit.text for edit in found.edits] == ['import "../cells/lab.scene"\n']
    assert "bench_scene" in str(describe_entry(project.snapshot(), found.kind, *(found.origin or ())))
    unknown = next(one for one in fast_diagnostics(project.snapshot(), uri) if one.code == "unknown-name")
    fixes = fixes_on_demand(project.snapshot(), uri, unknown, elsewhere)
    assert [fix.title for fix in fixes] == ["Import '../cells/lab.scene'"]
    elsewhere.update([])
    assert complete(project.snapshot(), uri, at_scene, elsewhere) == []


def test_the_configurations_that_can_be_set_are_offered() -> None:
    found = at(edited("<part> is located at <goal>, before", "<robot> has config max$0, before"))
    assert {entry.label: entry.detail for entry in found}["max_speed"] == "of an agent, m/s"
    assert {entry.kind for entry in found} == {"setting"}


@pytest.mark.parametrize("path", [path for path in MODELS if path.parent.name in ("pickplace", "ownrobot")], ids=str)
def test_every_proposal_of_every_kind_is_documented(path: Path) -> None:
    project, uri = Project(), path_to_uri(path)
    project.load(uri)
    snapshot = project.snapshot()
    text = snapshot.document(uri).text
    places = [0, *(match.start() for match in re.finditer(r"(?<=[<\s\"'])", text))]
    found = {
        (entry.kind, *(entry.origin or (uri, entry.label)))
        for place in places[:: max(1, len(places) // 150)]
        for entry in complete(snapshot, uri, place)
    }
    assert found
    assert [entry for entry in sorted(found) if not describe_entry(snapshot, *entry)] == []


def test_completion_works_below_broken_lines_of_the_same_declaration() -> None:
    text = edited("task: <task>", "tusk: <task>").replace("<robot> picks", "<$0> picks", 1)
    assert labels(text)[:3] == ["goal", "part", "robot"]


def test_the_rest_of_a_word_behind_the_cursor_can_be_replaced() -> None:
    (found,) = [entry for entry in at(edited("before <pick-start>", "before <pi$0ck-start>")) if entry.label == "end"]
    assert (found.whole.end - found.whole.start, found.span.end - found.span.start) == (10, 2)


@pytest.mark.parametrize(
    ("name", "text", "labels_expected"),
    [
        ("main.scene", SCENE + "comp (ns=env) more of ws <$0", ["places.bench_ws", "places.tray_ws"]),
        ("main.scene", SCENE + "scene (ns=$0", ["env"]),
        ("main.scenex", 'import "lab.scene"\nns x = "http://x/"\nscene inst (ns=x) s { scene: <$0', ["bench_scene"]),
        ("main.ktree", "ns x = 'http://x/'\nktree (ns=x) arm { body base { frame $0", []),
        (
            "main.ktree",
            "ns x = 'http://x/'\nktree (ns=x) arm { body base { frame f { } } }\nktree (ns=x) b { root: <$0",
            ["arm.base.f"],
        ),
        (
            "main.bddx",
            "ns x = 'http://x/'\nobs provider (ns=x) p { simulation ground truth update-rate: 1 Hz }\n"
            "observation (ns=x) o { provider: <$0",
            ["p"],
        ),
    ],
)
def test_every_file_kind_is_completed(name: str, text: str, labels_expected: list[str]) -> None:
    case = fixture(f"//- {name}\n{text}")
    found = complete(case.snapshot, case.uri, case.cursor)
    assert [entry.label for entry in found] == labels_expected


@pytest.mark.parametrize("text", ["// befo$0", 'const set (ns=t) s { "be$0" }', "const set (ns=t) s { 'be$0"])
def test_nothing_is_offered_in_comments_and_strings(text: str) -> None:
    assert labels(text) == []


def test_completion_works_behind_a_broken_declaration() -> None:
    text = edited("task: <task>", "tusk: <task>") + "const set (ns=t) s { <$0> }"
    assert "parts.bolt" in labels(text)


def test_completion_uses_the_names_of_a_broken_declaration() -> None:
    broken = edited("task: <task>", "tusk: <task>")
    assert labels(broken.replace("var <fetch.part>", "var <$0>", 1)) == ["fetch.goal", "fetch.part", "fetch.robot"]
