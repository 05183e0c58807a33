"""The language core as the playground of the site calls it; a browser drives the page in tests/editors/playground."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import jsonschema
import pytest
from language_core import Playground, serve
from recordings import RECORDED, record

from kit import DOCS, ROOT

MODEL = "pickplace.bdd"


@pytest.fixture
def call() -> Callable[..., Any]:
    answer = serve(Playground())

    def ask(method: str, *arguments: object) -> Any:
        return json.loads(answer(method, json.dumps(arguments)))

    return ask


def test_each_file_of_each_example_is_without_an_error_and_has_a_graph(call: Callable[..., Any]) -> None:
    examples = call("examples")
    assert "pickplace" in examples
    for example in examples:
        for name in call("open", example):
            assert [one for one in call("check", name)["findings"] if one["severity"] == "error"] == []
            assert "@prefix" in call("graph", name)
            if name.endswith(".bdd"):
                assert "Feature:" in call("feature", name)
                assert call("picture", name).startswith("<svg")


def test_places_are_those_of_javascript(call: Callable[..., Any]) -> None:
    text = call("open", "pickplace")[MODEL].replace("// Acceptance", "// 🤖 Acceptance")
    text = text.replace("evt-place-end>)", "evt-ends>)", 1)
    call("change", MODEL, text)
    units = text.encode("utf-16-le")
    (found,) = (one for one in call("check", MODEL)["findings"] if one["code"] == "unknown-name")
    start, end = found["range"]
    assert units[2 * start : 2 * end].decode("utf-16-le") == "evt-ends"
    (fix,) = (fix for fix in found["fixes"] if fix["title"] == "Change to 'evt-end'")
    ((start, end, instead),) = fix["edits"]
    fixed = (units[: 2 * start] + instead.encode("utf-16-le") + units[2 * end :]).decode("utf-16-le")
    call("change", MODEL, fixed)
    assert call("check", MODEL)["findings"] == []
    place = len(fixed[: fixed.index("<goal>, after") + 2].encode("utf-16-le")) // 2
    assert "goal" in call("hover", MODEL, place)["markdown"]
    offered = call("complete", MODEL, place - 1)
    assert {"thing", "goal"} <= {one["label"] for one in offered}
    assert {tuple(one["range"]) for one in offered} <= {(place - 1, place - 1)}


def test_a_violated_shape_is_found(call: Callable[..., Any]) -> None:
    text = call("open", "pickplace")[MODEL]
    call("change", MODEL, text.replace("{ <cubes.cube0>, <balls.ball0> }", "{ <places.left_ws> }"))
    found = [*call("check", MODEL)["findings"], *call("validate", MODEL)]
    assert any(one["code"].startswith("shacl-") for one in found)


@pytest.mark.physics
def test_a_recording_has_the_form_of_the_servers_answer_and_no_path() -> None:
    answer = record("pickplace", RECORDED["pickplace"])
    jsonschema.validate(answer, json.loads((DOCS / "schemas" / "trace.schema.json").read_text(encoding="utf-8")))
    assert {clause["name"] for clause in answer["clauses"]} >= {"in-hand", "at-goal"}
    assert str(ROOT) not in json.dumps(answer)
    assert RECORDED.keys() <= {path.name for path in (ROOT / "examples").iterdir()}
