"""Elements of a scene without a model are reported while editing, with the entry that gives them one."""

from __future__ import annotations

import pytest

import kit
from checks.models import apply, fixes_of
from kit import Fixture, fixture
from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.features.describe import describe_path
from robbdd_tools.features.diagnostics import all_diagnostics, fast_diagnostics

SCENE = kit.SCENE.replace("object bolt, object nut", "object gizmo, object gadget")
MODEL = kit.MODEL.replace("parts.bolt", "parts.gizmo").replace("parts.nut", "parts.gadget")
SCENE_URI = "file:///fixture/lab.scene"


def reported(case: Fixture, uri: str = SCENE_URI) -> list[Diagnostic]:
    return [entry for entry in fast_diagnostics(case.snapshot, uri) if entry.code == "no-model"]


def words(case: Fixture, uri: str = SCENE_URI) -> dict[str, str]:
    """The reported texts of a scene's file with their severities."""
    text = case.snapshot.document(uri).text
    return {text[one.span.start : one.span.end]: one.severity.name for one in reported(case, uri)}


def with_scene(scene: str, model: str = MODEL) -> Fixture:
    return fixture(f"//- main.bdd\n{model}//- lab.scene\n{scene}")


def test_each_name_is_a_warning_that_lists_all_of_them() -> None:
    case = with_scene(SCENE)
    assert words(case) == {"gizmo": "WARNING", "gadget": "WARNING"}
    first, second = reported(case)
    assert first.message.startswith("no model fits the name 'gizmo': it has none of the catalog's words (ball, bin, ")
    assert second.message.startswith("no model fits the name 'gadget': ")
    assert [related.span for related in first.related] == [second.span]


def test_a_bystander_is_an_information() -> None:
    scene = SCENE.replace("scene (ns=env) bench_scene {", "obj set (ns=env) others { object kit }\n$").replace(
        "$", "scene (ns=env) bench_scene { obj set <others>"
    )
    assert words(with_scene(scene)) == {"gizmo": "WARNING", "gadget": "WARNING", "kit": "INFORMATION"}


def test_what_carries_a_used_workspace_is_used() -> None:
    scene = SCENE.replace("object tray }", "object dish }").replace("<furniture.tray>", "<furniture.dish>")
    assert words(with_scene(scene))["dish"] == "WARNING"


def test_without_a_scenario_each_is_a_warning() -> None:
    case = fixture(f"//- lab.scene\n{SCENE}")
    assert set(words(case).values()) == {"WARNING"}


def test_a_set_name_that_fits_is_enough() -> None:
    case = with_scene(SCENE.replace("parts", "cubes"), MODEL.replace("<parts", "<cubes"))
    assert reported(case) == []
    assert "Simulated as *cube*" in (describe_path(case.snapshot, SCENE_URI, "cubes.gizmo") or "")


def test_elements_of_another_file_are_reported_at_the_entry_of_the_scene() -> None:
    sets = "ns o = 'https://example.org/o/'\nobj set (ns=o) spares { object widget, object doodad }\n"
    scene = 'import "other.scene"\n' + SCENE.replace("bench_scene {", "bench_scene { obj set <spares>")
    case = fixture(f"//- lab.scene\n{scene}//- other.scene\n{sets}")
    assert words(case)["spares"] == "WARNING"
    assert any("'doodad' and 'widget'" in one.message for one in reported(case))


@pytest.mark.parametrize("name", ["robot", "three"])
def test_an_agent_without_a_model_is_reported(name: str) -> None:
    case = with_scene(SCENE.replace("agent panda", f"agent {name}"), MODEL.replace("<arms.panda>", f"<arms.{name}>"))
    assert words(case)[name] == "WARNING"


def test_a_model_of_the_whole_scene_may_have_them() -> None:
    scenex = """//- lab.scenex
import "lab.scene"
ns x = 'https://example.org/x/'
scene inst (ns=x) all { scene: <bench_scene> model world as mjcf { sys path = 'lab.xml' } }
"""
    assert words(fixture(f"//- main.bdd\n{MODEL}//- lab.scene\n{SCENE}{scenex}")) == {}


def test_the_fixes_write_the_entries_one_by_one_and_each_removes_its_finding() -> None:
    case = with_scene(SCENE)
    for left in (["gadget"], []):
        found = reported(case)[0]
        fix = next(one for one in fixes_of(case, found) if "as 'cube'" in one.title)
        apply(case, fix)
        assert list(words(case)) == left
    text = case.project.texts()["file:///fixture/lab.scenex"][1]
    assert "obj <parts.gizmo>" in text
    assert "obj <parts.gadget>" in text
    errors = [
        one for one in all_diagnostics(case.snapshot, "file:///fixture/lab.scenex") if one.severity is Severity.ERROR
    ]
    assert errors == []


def test_the_copies_of_a_similar_set_get_one_entry() -> None:
    scene = SCENE.replace("bench_scene {", "bench_scene { obj set <washers>")
    case = with_scene(scene)
    found = next(one for one in reported(case) if "washer1" in one.message)
    fix = fixes_of(case, found)[0]
    assert fix.new_file is not None or fix.edits
    apply(case, fix)
    assert all("'washer" not in one.message for one in reported(case))


def test_what_carries_a_nested_workspace_is_simulated_too() -> None:
    scene = SCENE.replace("object tray }", "object dish }").replace("<furniture.tray>", "<furniture.dish>")
    nested = scene.replace("ws comp <bench_comp> ws comp <tray_comp>", "ws comp <bench_comp>")
    assert nested != scene
    assert words(with_scene(nested))["dish"] == "WARNING"


def test_an_agent_that_is_a_person_has_the_model_of_one() -> None:
    case = with_scene(
        SCENE.replace("agent ur10", "agent operator").replace("parts", "cubes"), MODEL.replace("<parts", "<cubes")
    )
    assert reported(case) == []
    assert "Simulated as *person*" in (describe_path(case.snapshot, SCENE_URI, "arms.operator") or "")
