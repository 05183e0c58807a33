"""A hint after each variant shows its number of scenarios."""

from __future__ import annotations

from kit import MODEL, fixture
from robbdd_tools.base.document import Span
from robbdd_tools.features.scenario_hints import scenario_hints


def hints(text: str) -> list[tuple[str, str]]:
    case = fixture(text)
    source = case.project.texts()[case.uri][1]
    found = scenario_hints(case.snapshot, case.uri, Span(0, len(source)))
    return [(source[hint.span.start : hint.span.end], hint.label) for hint in found]


def test_a_product_is_multiplied_out() -> None:
    assert hints(MODEL) == [("bench-to-tray", "4 scenarios")]


def test_rows_are_counted() -> None:
    rows = MODEL[MODEL.index("                var <fetch.part>") :].rpartition("        }")[0]
    assert hints(MODEL.replace(rows, "| <fetch.part> |\n|---|\n| <parts.bolt> |\n")) == [
        ("bench-to-tray", "1 scenario")
    ]


def test_nothing_is_said_while_a_set_is_unknown_or_the_variant_is_broken() -> None:
    assert hints(MODEL.replace("obj set <parts>", "obj set <gone>")) == []
    assert hints(MODEL.replace("variation:", "variation")) == []


def test_an_unsaved_scene_counts() -> None:
    scene = "ns e = 'http://e/'\nobj set (ns=e) parts { object a, object b, object c }\n"
    assert hints(f"//- main.bdd\n{MODEL}//- lab.scene\n{scene}") == [("bench-to-tray", "6 scenarios")]
