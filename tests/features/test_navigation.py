"""References, rename, outline and folding over several files."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit import MODEL, SCENE, Fixture, fixture
from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.features.folding import folds
from robbdd_tools.features.outline import Item, outline
from robbdd_tools.features.references import highlights, references
from robbdd_tools.features.rename import RenameRefused, prepare_rename, rename
from robbdd_tools.features.workspace_symbols import workspace_symbols
from robbdd_tools.names.project import Project
from robbdd_tools.names.scope import Scope

LAB = "file:///fixture/lab.scene"


def marked(old: str, new: str, scene: bool = False) -> tuple[Fixture, str]:
    """The model (or its scene) with a cursor in some text."""
    text = SCENE if scene else MODEL
    assert old in text
    files = {"main.bdd": MODEL, "lab.scene": SCENE} | {"lab.scene" if scene else "main.bdd": text.replace(old, new, 1)}
    case = fixture("".join(f"//- {name}\n{content}" for name, content in files.items()))
    return case, LAB if scene else case.uri


def lines(case: Fixture, places: list[tuple[str, object]]) -> list[str]:
    texts = case.project.texts()
    found: list[str] = []
    for uri, span in places:
        start = getattr(span, "start", 0)
        found.append(f"{uri.rsplit('/', 1)[-1]}:{texts[uri][1].count(chr(10), 0, start) + 1}")
    return found


def test_an_element_is_found_in_every_file_that_uses_it() -> None:
    case, uri = marked("workspace bench_ws", "workspace bench$0_ws", scene=True)
    found = references(case.snapshot, uri, case.cursor, with_declaration=True)
    assert lines(case, list(found)) == ["lab.scene:5", "lab.scene:8", "main.bdd:33"]


def test_a_variable_is_found_by_its_short_and_its_qualified_name() -> None:
    case, uri = marked("var goal", "var go$0al")
    assert len(references(case.snapshot, uri, case.cursor, with_declaration=False)) == 4


TABLE = """                | <fetch.part> | <fetch.robot> | <fetch.goal> |
                |---|---|---|
                | <parts.bolt> | <arms.panda> | <places.tray_ws> |
"""
PRODUCT = MODEL[MODEL.index("                var <fetch.part>") :].rpartition("        }")[0]


@pytest.mark.parametrize("text", [MODEL, MODEL.replace(PRODUCT, TABLE)], ids=["product", "table"])
def test_a_variable_is_written_where_it_is_declared_and_given_values_and_read_in_clauses(text: str) -> None:
    assert "<fetch.goal>" in text
    case = fixture(text.replace("var goal", "var go$0al"))
    found = highlights(case.snapshot, case.uri, case.cursor)
    written = [(text[place.start : place.end], place.writes) for place in found]
    assert written == [("goal", True), ("goal", False), ("goal", False), ("goal", False), ("goal", True)]


def test_an_imported_name_is_only_read() -> None:
    case, uri = marked("<places.tray_ws>", "<places.tray$0_ws>")
    assert [place.writes for place in highlights(case.snapshot, uri, case.cursor)] == [False]
    case, uri = marked("workspace tray_ws", "workspace tray$0_ws", scene=True)
    assert [place.writes for place in highlights(case.snapshot, uri, case.cursor)] == [True, False]


def renamed(old: str, new: str, name: str, scene: bool = False) -> tuple[str, str]:
    case, uri = marked(old, new, scene)
    texts = {file: text for file, (_, text) in case.project.texts().items()}
    for edit in reversed(rename(case.snapshot, uri, case.cursor, name)):
        text = texts[edit.uri]
        texts[edit.uri] = text[: edit.span.start] + edit.text + text[edit.span.end :]
    for file, text in texts.items():
        case.project.open(file, 2, text)
    for file in texts:
        errors = [found for found in fast_diagnostics(case.snapshot, file) if found.severity is Severity.ERROR]
        assert errors == []
    return texts[case.uri], texts[LAB]


@pytest.mark.parametrize(
    ("old", "new", "scene"),
    [("<places.tray_ws>", "<places.tray$0_ws>", False), ("workspace tray_ws", "workspace tray$0_ws", True)],
)
def test_an_element_is_renamed_in_all_files_from_either_end(old: str, new: str, scene: bool) -> None:
    main, lab = renamed(old, new, "crate_ws", scene)
    assert main == MODEL.replace("tray_ws", "crate_ws")
    assert lab == SCENE.replace("tray_ws", "crate_ws")


def test_a_search_for_uses_asks_no_file_without_the_name_for_the_names_that_it_knows(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    files = [
        f"//- f{n}.bdd\nimport \"f{(n + 1) % 9}.bdd\"\nns t = 'https://x/{n}/'\nTask (ns=t) task-{n}\n"
        for n in range(9)
    ]
    case = fixture("".join(files).replace("task-4\n", "task-$04\n"))
    for n in range(9):
        fast_diagnostics(case.snapshot, f"file:///fixture/f{n}.bdd")
    asked: list[str] = []
    known = Scope.tables.fget
    assert known is not None
    monkeypatch.setattr(Scope, "tables", property(lambda one: asked.append(one.own.document.uri) or known(one)))
    assert lines(case, list(references(case.snapshot, case.uri, case.cursor, with_declaration=True))) == ["f0.bdd:3"]
    assert asked == [case.uri]


def test_a_set_is_renamed_inside_qualified_names() -> None:
    main, lab = renamed("ws set (ns=env) places", "ws set (ns=env) pla$0ces", "spots", scene=True)
    assert main == MODEL.replace("places.", "spots.")
    assert lab == SCENE.replace("places", "spots")


TREES = """//- cell.scenex
import "arm.ktree"
ns c = 'https://example.org/c/'
ktree inst (ns=c) left of <arm>
ktree inst (ns=c) right of <arm>
ktree (ns=c) cell {
    tree <left>
    tree <right>
    body floor { frame ground { } }
    joints {
        fixed left-on-floor { parent: <floor.ground> child: <left.foot.base> }
        fixed right-on-floor { parent: <floor.ground> child: <right.foot.base> }
        fixed on-top { parent: <cell.left.foot.base> child: <right.foot.base> }
    }
}
//- arm.ktree
ktree arm { body foot { frame base { } } joints { } }
"""


@pytest.mark.parametrize(
    ("old", "new", "name", "places"),
    [
        ("inst (ns=c) left", "inst (ns=c) le$0ft", "first", ["left of", "left>", "left.foot.base>", "left.foot.base>"]),
        ("cell.left.foot", "cell.left.fo$0ot", "plate", ["foot {", *["foot.base>"] * 4]),
        ("cell.left.foot.base", "ce$0ll.left.foot.base", "room", ["cell {", "cell.left.foot.base>"]),
    ],
)
def test_names_that_lead_through_an_instance_are_renamed_part_by_part(
    old: str, new: str, name: str, places: list[str]
) -> None:
    case = fixture(TREES.replace(old, new, 1))
    texts = {uri: text for uri, (_, text) in case.project.texts().items()}
    edits = rename(case.snapshot, case.uri, case.cursor, name)
    assert [
        texts[edit.uri][edit.span.start :][: len(place)] for edit, place in zip(edits, places, strict=True)
    ] == places
    for edit in reversed(edits):
        text = texts[edit.uri]
        texts[edit.uri] = text[: edit.span.start] + edit.text + text[edit.span.end :]
        case.project.open(edit.uri, 2, texts[edit.uri])
    every = (found for uri in texts for found in fast_diagnostics(case.snapshot, uri))
    assert [found.message for found in every if found.severity is Severity.ERROR] == []


def test_the_set_before_its_element_is_a_name_of_its_own() -> None:
    case, uri = marked("<places.tray_ws>", "<pla$0ces.tray_ws>")
    span = prepare_rename(case.snapshot, uri, case.cursor)
    assert span is not None
    assert case.project.texts()[uri][1][span.start : span.end] == "places"
    found = references(case.snapshot, uri, case.cursor, with_declaration=True)
    assert lines(case, list(found)) == ["lab.scene:5", "lab.scene:7", "lab.scene:8", "main.bdd:33", "main.bdd:33"]


def test_a_node_of_a_behaviour_tree_is_renamed_with_its_links() -> None:
    tree = "Behaviour Tree (ns=t) handling { sequence whole { selector grasp { node pi$0ck } } }\n"
    link = "places at <goal>\n            node: <handling.pick>\n        }"
    case = fixture(MODEL.replace("places at <goal>\n        }", link) + tree)
    text = case.project.texts()[case.uri][1]
    edits = sorted(rename(case.snapshot, case.uri, case.cursor, "take"), key=lambda edit: edit.span)
    assert [text[edit.span.start - 5 : edit.span.end] for edit in edits] == ["ling.pick", "node pick"]


def test_a_template_and_its_variable_are_renamed_apart() -> None:
    main, _ = renamed("Template (ns=t) fetch", "Template (ns=t) fe$0tch", "carry-off")
    assert main == MODEL.replace(") fetch {", ") carry-off {").replace("<fetch", "<carry-off")
    main, _ = renamed("var part", "var pa$0rt", "piece")
    assert main == MODEL.replace("var part\n", "var piece\n").replace("<part>", "<piece>").replace(".part>", ".piece>")


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("1st", "is not a valid name"),
        ("a b", "is not a valid name"),
        ("robot", "is already declared"),
        ("", "is not a valid name"),
    ],
)
def test_a_rename_that_would_break_the_model_is_refused(name: str, words: str) -> None:
    case, uri = marked("var part", "var pa$0rt")
    with pytest.raises(RenameRefused, match=words):
        rename(case.snapshot, uri, case.cursor, name)


def test_members_of_similar_sets_have_no_name_of_their_own() -> None:
    case = fixture(MODEL.replace("obj set <parts>", "{ <washers.was$0her1> }"))
    assert prepare_rename(case.snapshot, case.uri, case.cursor) is None
    with pytest.raises(RenameRefused, match="numbered by its set"):
        rename(case.snapshot, case.uri, case.cursor, "ring")


def test_the_part_of_a_qualified_name_under_the_cursor_is_offered_for_renaming() -> None:
    case, uri = marked("<places.tray_ws>", "<places.tray$0_ws>")
    span = prepare_rename(case.snapshot, uri, case.cursor)
    assert span is not None
    assert case.project.texts()[uri][1][span.start : span.end] == "tray_ws"


def shown(items: list[Item], depth: int = 0) -> list[str]:
    return [
        line
        for item in items
        for line in (f"{'  ' * depth}{item.name}: {item.kind}", *shown(list(item.children), depth + 1))
    ]


def test_the_outline_nests_names_as_they_are_declared() -> None:
    case = fixture(MODEL)
    assert shown(outline(case.snapshot, case.uri))[6:] == [
        "fetch: scenario template",
        "  part: variable",
        "  robot: variable",
        "  goal: variable",
        "  on-bench: fluent",
        "  carry: behaviour",
        "  in-tray: fluent",
        "fetching: user story",
        "  bench-to-tray: scenario variant",
    ]


INSTANCE = """//- main.scenex
import "lab.scene"
ns s = 'https://example.org/s/'
scene inst (ns=s) bench_sim {
    scene: <bench_scene>
    kgraph (ns=s) poses { body foot { frame middle { } } }
    model walls as mjcf { sys path = 'walls.xml' }
    ws <places.bench_ws> { camera above { frame: <poses.foot.middle> type: rgb
        resolution: (640, 480) fov: 60 deg update-rate: 30 Hz } }
    obj set <parts> { model part as mjcf { catalog "cube" } obj <parts.nut> { model nut as mjcf { catalog "ball" } } }
    agn <arms.panda> { }
}
"""


def test_the_outline_of_a_scene_instance_has_the_elements_that_it_models() -> None:
    case = fixture(INSTANCE)
    assert shown(outline(case.snapshot, case.uri))[1:] == [
        "bench_sim: scene instance",
        "  poses: kinematic graph",
        "    foot: body",
        "      middle: frame",
        "  walls: model",
        "  bench_ws: workspace",
        "    above: sensor",
        "  parts: object set",
        "    part: model",
        "    nut: object",
        "      nut: model",
        "  panda: agent",
    ]


def test_the_outline_survives_broken_text() -> None:
    case = fixture(MODEL.replace("var robot", "var robot !!").replace("template: <fetch>", "template <fetch>"))
    assert "  robot: variable" in shown(outline(case.snapshot, case.uri))


def test_symbols_of_the_workspace_are_found_by_some_of_their_letters() -> None:
    snapshot = fixture(MODEL).snapshot
    (found,) = workspace_symbols(snapshot, (), "trws")
    assert (found.path, found.document.text[found.span.start : found.span.end]) == ("places.tray_ws", "tray_ws")
    assert workspace_symbols(snapshot, (), "zzz") == []
    assert len(workspace_symbols(snapshot, (), "", most=3)) == 3


def test_symbols_of_files_that_nobody_has_loaded_are_found_as_they_are_on_disk(tmp_path: Path) -> None:
    closed, opened = tmp_path / "deep" / "lab.scene", tmp_path / "open.scene"
    closed.parent.mkdir()
    closed.write_text("ns env = 'https://example.org/'\nagn set (ns=env) arms { agent panda }\n", encoding="utf-8")
    opened.write_text("ws set (ns=env) saved { }\n", encoding="utf-8")
    (tmp_path / "odd.scene").write_bytes(b"\xff\xfe\0")
    project = Project()
    project.open(path_to_uri(opened), 1, "ws set (ns=env) unsaved { }\n")

    def found(query: str) -> list[tuple[str, int]]:
        symbols = workspace_symbols(project.snapshot(), [path_to_uri(tmp_path)], query)
        return [(named.path, named.document.position(named.span.start).line) for named in symbols]

    assert found("panda") == [("arms.panda", 1)]
    assert (found("unsaved"), found("saved")) == ([("unsaved", 0)], [("unsaved", 0)])
    closed.write_text("// changed\nagn set (ns=env) robots { agent ur10 }\n", encoding="utf-8")
    assert (found("panda"), found("ur10")) == ([], [("robots.ur10", 1)])


def test_blocks_comments_and_imports_fold() -> None:
    imports = "import 'a.scene'\nimport 'b.scene'\n"
    text = imports + "// one\n// two\nScenario Template (ns=t) x {\n  var a\n  // lone\n  var b\n}\n"
    case = fixture(text)
    assert [(fold.first, fold.last, fold.kind) for fold in folds(case.snapshot, case.uri)] == [
        (0, 1, "imports"),
        (2, 3, "comment"),
        (4, 7, "region"),
    ]
