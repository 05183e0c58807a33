"""Feature files and the maps from their lines back to the text."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from kit import MODEL, SCENE, fixture, schema_errors
from robbdd_tools.gherkin.feature_files import FeaturePlan, clause_origins, whole_plan, write_features
from robbdd_tools.gherkin.user_template import sheet
from robbdd_tools.graph.read.acceptance import read_model
from robbdd_tools.graph.write.build import build_graph

GROUPED = MODEL.replace(
    "in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)",
    "(in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>) or (not 'lost' after <end>))",
)


def plan_of(text: str) -> FeaturePlan:
    case = fixture(f"//- main.bdd\n{text}\n//- lab.scene\n{SCENE}")
    built = build_graph(case.snapshot, case.uri)
    model = read_model(built.graph)
    return whole_plan(model, clause_origins(built, case.snapshot, model))


@pytest.mark.parametrize("template", ["default", "compact", "de"])
def test_each_step_leads_back_to_the_text_that_states_it(tmp_path: Path, template: str) -> None:
    (feature,) = write_features(replace(plan_of(GROUPED), sheet=sheet(template)), tmp_path)
    lines = feature.read_text(encoding="utf-8").split("\n")
    document: Any = json.loads((tmp_path / "fetching.feature.map.json").read_text(encoding="utf-8"))
    assert schema_errors("featuremap.schema.json", document) == []
    assert document["feature"] == feature.name
    assert [scenario["variation"] for scenario in document["scenarios"]] == [1, 2, 3, 4]
    assert document["scenarios"][1]["values"] == {"part": "env:bolt", "robot": "env:panda", "goal": "env:tray_ws"}
    for scenario in document["scenarios"]:
        assert re.search(rf"(Scenario|Szenario): {scenario['name']}|\| env:", lines[int(scenario["line"]) - 1])
        stated = {
            lines[int(line) - 1].strip().split(" ", 1)[1]: written(document["clauses"][number])
            for line, number in scenario["steps"].items()
        }
        assert [text.split(" ", 1)[0] for text in stated.values()] == ["on-bench", "carry", "(in-tray:"]
        assert next(sentence for sentence in stated if " or not ( lost " in sentence).startswith('( "')


def written(clause: dict[str, Any]) -> str:
    """The text in the range of a clause."""
    assert clause["file"] == "main.bdd"
    start, end = clause["range"]["start"], clause["range"]["end"]
    lines = GROUPED.split("\n")[start["line"] - 1 : end["line"]]
    lines[-1] = lines[-1][: end["column"] - 1]
    lines[0] = lines[0][start["column"] - 1 :]
    return "\n".join(lines)


def test_a_model_without_text_has_no_ranges(tmp_path: Path) -> None:
    plan = plan_of(MODEL)
    write_features(replace(plan, origins={}), tmp_path)
    document: Any = json.loads((tmp_path / "fetching.feature.map.json").read_text(encoding="utf-8"))
    assert schema_errors("featuremap.schema.json", document) == []
    assert all(set(clause) == {"iri", "name"} for clause in document["clauses"])


def test_a_step_that_a_template_leaves_out_is_not_in_the_map(tmp_path: Path) -> None:
    own = tmp_path / "own.feature.jinja"
    own.write_text(
        "{% block feature %}Feature: f\n{% endblock %}"
        "{% block scenario %}  Scenario: {{ scenario.name }}\n    Then {{ scenario.steps[-1].text }}\n{% endblock %}",
        encoding="utf-8",
    )
    write_features(replace(plan_of(MODEL), sheet=sheet(str(own))), tmp_path)
    document: Any = json.loads((tmp_path / "fetching.feature.map.json").read_text(encoding="utf-8"))
    assert [(scenario["line"], scenario["steps"]) for scenario in document["scenarios"]] == [
        (2 * number, {str(2 * number + 1): 2}) for number in range(1, 5)
    ]
