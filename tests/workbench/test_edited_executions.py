"""Repetitions of a scenario are compared with their executions once, if they differ in number and seed only."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import pytest

from protocol.test_spec_changes import STORED, act, goal
from robbdd_tools.protocol import spec_changes
from robbdd_tools.protocol.specs import ScenarioSpec
from robbdd_tools.workbench import edited_executions
from robbdd_tools.workbench.edited_executions import Comparison, Edits

EDITED = replace(STORED, clauses=(act(), goal(2.0)))
OTHER_SCENE = replace(STORED.scene, places={"e:cube": "e:bin"})


def repeated(spec: ScenarioSpec, number: int) -> ScenarioSpec:
    return replace(spec, name=f"s {number}", seed=number, repetition=number)


def edits(pairs: Sequence[tuple[ScenarioSpec, ScenarioSpec]]) -> list[Edits]:
    comparison = Comparison(cast(Any, SimpleNamespace(uri="untitled:s.bdd")))
    return [comparison.edits(spec, stored) for spec, stored in pairs]


def test_repetitions_are_compared_once(monkeypatch: pytest.MonkeyPatch) -> None:
    compared: list[int] = []

    def counting(spec: ScenarioSpec, stored: ScenarioSpec) -> str:
        compared.append(stored.repetition)
        return spec_changes.content_change(spec, stored)

    monkeypatch.setattr(edited_executions, "content_change", counting)
    found = edits([(repeated(EDITED, number), repeated(STORED, number)) for number in (1, 2, 3)])
    assert found == [Edits("", EDITED.clauses[1:])] * 3
    assert compared == [1]


@pytest.mark.parametrize(
    ("spec", "stored"),
    [
        (EDITED, replace(STORED, scene=OTHER_SCENE)),
        (replace(EDITED, scene=OTHER_SCENE), STORED),
        (EDITED, replace(STORED, clauses=(act(), goal(2.0)))),
        (replace(EDITED, clauses=(act(), goal(3.0))), STORED),
        (replace(EDITED, variation=2), STORED),
    ],
)
def test_a_repetition_that_differs_is_compared_by_itself(spec: ScenarioSpec, stored: ScenarioSpec) -> None:
    plain, other = (repeated(EDITED, 1), repeated(STORED, 1)), (repeated(spec, 2), repeated(stored, 2))
    alone = edits([other])
    assert edits([plain, other, plain]) == [*edits([plain]), *alone, *edits([plain])]
