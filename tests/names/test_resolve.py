"""References resolve to their declarations, or the diagnostics say why not."""

import pytest

from kit import EVENTS, FOLDER, MODEL, SCENE, TEMPLATE, Fixture, assert_diagnostics, corpus, fixture
from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.names.imports import components
from robbdd_tools.names.project import Project


def findings(case: Fixture) -> list[Diagnostic]:
    analysis = case.snapshot.file(case.uri)
    assert analysis is not None
    return list(analysis.diagnostics)


def check(text: str) -> None:
    case = fixture(text)
    analyses = [case.snapshot.file(uri) for uri in case.project.texts()]
    assert_diagnostics([entry for analysis in analyses if analysis for entry in analysis.diagnostics], case)


def test_a_sound_model_has_no_finding() -> None:
    check(MODEL)


def test_an_unknown_name_is_reported_with_the_nearest_known_one() -> None:
    case = fixture(MODEL.replace("template: <fetch>", "template: <fetsch>"))
    (found,) = findings(case)
    assert found.message == "there is no scenario template 'fetsch'; did you mean 'fetch'?"
    assert found.fixes[0].edits[0].text == "fetch"


def test_all_unknown_names_are_reported() -> None:
    check(
        EVENTS
        + """const set (ns=t) s { <parts.bold>, <places.bench_ws>, <parts.nutt> }
//                    ^^^^^^^^^^ unknown-name did you mean 'parts.bolt'
//                                                     ^^^^^^^^^^ unknown-name did you mean 'parts.nut'
Task (ns=tt) other
//       ^^ unknown-name no namespace 'tt'
"""
    )


def test_a_target_of_the_wrong_kind_names_both_kinds() -> None:
    check(
        EVENTS
        + """const set (ns=t) s { <start> }
//                    ^^^^^ wrong-kind 'start' is an event, but an object, workspace or agent belongs here
"""
    )


def test_members_of_similar_sets_can_be_referenced() -> None:
    check(EVENTS + "const set (ns=t) s { <washers.washer0>, <washers.washer2> }")


def test_beyond_the_count_of_a_similar_set_there_is_no_member() -> None:
    check(
        EVENTS
        + """const set (ns=t) s { <washers.washer3> }
//                    ^^^^^^^^^^^^^^^ unknown-name
"""
    )


def test_a_broken_declaration_leaves_its_siblings_and_users_intact() -> None:
    broken = TEMPLATE.replace("before <pick-start>", "befor <pick-start>")
    check(
        MODEL.replace(TEMPLATE, broken).replace(
            "\n    When:\n",
            "\n//                                                   ^^^^^ syntax expected\n    When:\n",
            1,
        )
    )


def test_a_name_declared_twice_is_reported_at_the_second_place() -> None:
    check(
        EVENTS
        + """Event (ns=t) start
//           ^^^^^ duplicate-name
"""
    )


def test_two_fluents_of_one_template_need_two_names() -> None:
    case = fixture(MODEL.replace("in-tray:", "on-bench:"))
    assert [entry.code for entry in findings(case)] == ["duplicate-name"]


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ('import "none.scene"', "there is no file 'none.scene'"),
        ('import "main.bdd"', "imports itself"),
        ('import "lab.txt"', "only '.bdd', '.scene', '.ttl', '.json' and '.jsonld'"),
    ],
)
def test_an_import_that_cannot_be_used_is_reported_on_its_path(line: str, words: str) -> None:
    path = line.split('"')[1]
    check(f"{line}\n//      {'^' * len(path)} import {words}\n")


def test_a_broken_import_is_reported_on_the_import_line_and_at_its_own_place() -> None:
    check(
        """//- main.bdd
import "middle.scene"
//      ^^^^^^^^^^^^ broken-import expected a name
//- middle.scene
import "bad.scene"
//      ^^^^^^^^^ broken-import
//- bad.scene
ns e = 'x'
obj set (ns=e) { object a }
//             ^ syntax expected a name
"""
    )


def test_names_are_found_through_imports_in_a_circle() -> None:
    check(
        """//- a.bdd
import "b.bdd"
ns t = 'x'
Event (ns=t) one
const set (ns=t) s { <s2.x> }
//                    ^^^^ unknown-name
//- b.bdd
import "a.bdd"
ns u = 'y'
Event (ns=u) two
"""
    )


def test_names_reach_through_imports_transitively() -> None:
    check(
        '//- a.bdd\nimport "b.bdd"\nns t = \'x\'\nconst set (ns=t) s { <parts.bolt> }\n//- b.bdd\nimport "lab.scene"\n'
    )


def test_names_behind_an_unreadable_import_are_not_reported_again() -> None:
    check(
        """import "gone.scene"
//      ^^^^^^^^^^ import
ns t = 'x'
const set (ns=t) s { <unheard.of> }
"""
    )


def test_an_edit_changes_what_importers_see() -> None:
    case = fixture(MODEL)
    scene = "file:///fixture/lab.scene"
    case.project.open(scene, 2, SCENE.replace("object bolt", "object screw"))
    assert findings(case) == []
    case.project.open(scene, 3, SCENE.replace("obj set (ns=env) parts", "obj set (ns=env) pieces"))
    assert [entry.code for entry in findings(case)] == ["unknown-name"]
    case.project.open(scene, 4, SCENE)
    assert findings(case) == []


def test_iris_follow_their_namespaces() -> None:
    case = fixture(MODEL)
    main = case.snapshot.file(case.uri)
    scene = case.snapshot.file("file:///fixture/lab.scene")
    assert main is not None
    assert scene is not None
    iris = {path: found.iri for analysis in (main, scene) for path, found in analysis.definitions.items()}
    assert iris["fetch"] == "https://example.org/t/fetch"
    assert iris["fetch.part"] == "https://example.org/t/var-part"
    assert iris["fetch.in-tray"] == "https://example.org/t/in-tray"
    assert iris["washers.washer1"] == "https://example.org/env/washer1"
    assert iris["fetching.bench-to-tray"] == "https://example.org/t/bench-to-tray"


def test_foreign_models_link_without_an_error() -> None:
    project = Project()
    uris = [path_to_uri(path) for path in corpus(".bdd", ".scene")]
    for uri in uris:
        project.load(uri)
    snapshot = project.snapshot()
    for uri in uris:
        analysis = snapshot.file(uri)
        assert analysis is not None
        assert [entry for entry in analysis.diagnostics if entry.severity is Severity.ERROR] == []


def test_files_that_import_each_other_are_told_from_those_on_the_way_to_them() -> None:
    edges = {"a": ["b"], "b": ["c", "d"], "c": ["a"], "d": ["e", "gone"], "e": ["d"], "f": ["a", "d"]}
    numbers = components(edges)
    groups = {frozenset(uri for uri in edges if numbers[uri] == number) for number in numbers.values()}
    assert groups == {frozenset("abc"), frozenset("de"), frozenset("f")}


def test_a_chain_of_imports_longer_than_the_stack_is_followed() -> None:
    edges = {str(number): [str((number + 1) % 50_000)] for number in range(50_000)}
    assert set(components(edges).values()) == {0}


def test_an_element_can_be_named_by_its_scene() -> None:
    found = fixture(f"""//- lab.scene
{SCENE}//- m.bdd
import "lab.scene"
ns t = 'https://example.org/t/'
const set (ns=t) some {{ <bench_scene.bolt>, <bench_scene.tray_ws>, <bench_scene.tray>, <bench_scene.ur10> }}
""")
    file = found.snapshot.file(f"{FOLDER}m.bdd")
    assert file is not None
    placed = file.declarations[-1]
    paths = {target.symbol.path for target in placed.targets.values() if "." in target.symbol.path}
    assert paths == {"parts.bolt", "places.tray_ws", "furniture.tray", "arms.ur10"}
    assert file.diagnostics == ()


def test_an_element_that_two_sets_of_a_scene_have_is_not_named_by_the_scene() -> None:
    check("""//- lab.scene
ns e = 'https://example.org/e/'
ns f = 'https://example.org/f/'
obj set (ns=e) left { object cube }
obj set (ns=f) right { object cube }
scene (ns=e) both { obj set <left> obj set <right> }
//- m.bdd
import "lab.scene"
ns t = 'https://example.org/t/'
const set (ns=t) some { <both.cube> }
//                       ^^^^^^^^^ unknown-name did you mean
""")
