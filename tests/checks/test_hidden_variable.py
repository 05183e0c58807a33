"""Quantifiers whose variable has the name of another one are reported, unless they are beside it."""

from __future__ import annotations

import pytest

from checks.models import found
from kit import MODEL, SCENE
from robbdd_tools.base.diagnostic import Diagnostic, Severity

THEN = "in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)"


def hidden(text: str) -> list[Diagnostic]:
    assert "exists" in text or "for all" in text
    return found(f"//- main.bdd\n{text}//- lab.scene\n{SCENE}", "hidden-variable")


def exists(name: str, clause: str) -> str:
    return f"( var {name} exists in <places> ) such that {{ {clause} }}"


@pytest.mark.parametrize(
    ("clause", "count"),
    [
        (exists("goal", THEN), 1),
        (exists("y", THEN.replace("<goal>", "<y>")), 0),
        (f"( {exists('y', THEN)} and {exists('y', THEN.replace('in-tray', 'other'))} )", 0),
        (exists("y", exists("y", THEN.replace("<goal>", "<y>"))), 1),
        (exists("y", f"( {exists('z', THEN)} and {exists('z', THEN.replace('in-tray', 'other'))} )"), 0),
    ],
)
def test_a_variable_is_hidden_by_a_quantifier_around_its_use(clause: str, count: int) -> None:
    findings = hidden(MODEL.replace(THEN, clause))
    assert [one.severity for one in findings] == [Severity.WARNING] * count


@pytest.mark.parametrize(
    ("name", "clause", "severity"),
    [
        ("goal", "also: holds(<fetch.part> is located at <goal>, after <end>)", Severity.WARNING),
        ("goal", "also: holds(<fetch.goal> is on top of <goal>, after <end>)", Severity.ERROR),
        ("y", "also: holds(<fetch.part> is located at <y>, after <end>)", None),
    ],
)
def test_a_quantifier_of_a_variant_may_have_the_node_of_a_template_variable(
    name: str, clause: str, severity: Severity | None
) -> None:
    text = MODEL.replace("scene: <bench_scene>", f"scene: <bench_scene> Then: {exists(name, clause)}")
    assert [one.severity for one in hidden(text)] == ([] if severity is None else [severity])
    # In another namespace, the two variables have two nodes.
    apart = text.replace("ns t =", "ns u = 'https://example.org/u/'\nns t =").replace(
        "User Story (ns=t)", "User Story (ns=u)"
    )
    assert hidden(apart) == []
