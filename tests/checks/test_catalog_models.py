"""A scene without an executable one says once which models of the catalog it runs on."""

from __future__ import annotations

from kit import SCENE, fixture
from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.features.diagnostics import fast_diagnostics

INSTANCE = """import "lab.scene"
ns s = 'https://example.org/s/'
scene inst (ns=s) bench_mjc { scene: <bench_scene> }
"""


def messages_of(text: str, *files: str) -> list[str]:
    case = fixture("\n".join([f"//- lab.scene\n{text}", *files]))
    found = [entry for entry in fast_diagnostics(case.snapshot, case.uri) if entry.code == "catalog-models"]
    assert {entry.severity for entry in found} <= {Severity.INFORMATION}
    return [text[entry.span.start : entry.span.end] + ": " + entry.message.partition(": ")[2] for entry in found]


def test_a_scene_says_once_what_its_elements_are() -> None:
    assert messages_of(SCENE) == [
        "bench_scene: bolt as bolt; panda as franka-panda; nut as nut; bench as table; tray as tray; ur10 as ur10"
    ]


def test_an_executable_scene_says_it_better() -> None:
    assert messages_of(SCENE, f"//- bench.scenex\n{INSTANCE}") == []


def test_a_scene_of_which_nothing_is_in_the_catalog_says_nothing() -> None:
    text = SCENE.replace("object bench", "object plank").replace("object tray", "object dish")
    text = text.replace("agent panda", "agent one").replace("agent ur10", "agent two")
    text = text.replace("object bolt, object nut", "object gizmo, object gadget")
    text = text.replace("<furniture.bench>", "<furniture.plank>").replace("<furniture.tray>", "<furniture.dish>")
    assert messages_of(text) == []
