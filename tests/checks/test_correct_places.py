"""``no-correct-place``: clauses that ask where an object belongs, which the scene does not state."""

from __future__ import annotations

import pytest

from checks.models import found
from kit import MODEL, SCENE
from robbdd_tools.base.diagnostic import Severity

ASKED = MODEL.replace("<part> is located at <goal>, 0.5 seconds", "<goal> is correct for <part>, 0.5 seconds")


def missing(*stated: str, model: str = ASKED) -> list[str]:
    """The names of the values that lack a correct place."""
    fitting = f"workspace tray_ws {{ correct for: {', '.join(stated)} }} }}" if stated else "workspace tray_ws }"
    scene = SCENE.replace("workspace tray_ws }", fitting)
    assert bool(stated) == (scene != SCENE)
    findings = found(f"//- main.bdd\n{model}//- lab.scene\n{scene}", "no-correct-place")
    assert {finding.severity for finding in findings} <= {Severity.WARNING}
    assert [finding.related[0].message for finding in findings] == ["the clause"] * len(findings)
    return [finding.message.split("'")[1] for finding in findings]


@pytest.mark.parametrize(
    ("stated", "names"),
    [
        ((), ["parts.bolt", "parts.nut"]),
        (("obj <parts.bolt>",), ["parts.nut"]),
        (("obj <parts.bolt>", "obj <parts.nut>"), []),
        (("obj set <parts>",), []),
        (("obj set <washers>",), ["parts.bolt", "parts.nut"]),
    ],
)
def test_each_object_without_a_correct_place_is_a_warning(stated: tuple[str, ...], names: list[str]) -> None:
    assert missing(*stated) == names


def test_clauses_that_do_not_ask_need_no_relation() -> None:
    assert missing(model=MODEL) == []


def test_an_incomplete_relation_is_not_held_against_the_values() -> None:
    assert missing("obj <parts.bol>") == []


@pytest.mark.parametrize(
    ("stated", "names"), [("bolt", ["parts.nut"]), ("parts", []), ("washers", ["parts.bolt", "parts.nut"])]
)
def test_an_imported_graph_may_state_the_relation(stated: str, names: list[str]) -> None:
    lines = (
        "@prefix env: <https://example.org/env/> .\n@prefix rbw: <https://robbdd.org/metamodels/workbench#> .\n"
        f"env:tray_ws rbw:correct-for env:{stated} .\n"
    )
    text = f'//- main.bdd\n{ASKED}//- lab.scene\nimport "fits.ttl"\n{SCENE}//- fits.ttl\n{lines}'
    assert [finding.message.split("'")[1] for finding in found(text, "no-correct-place")] == names
