"""Results written by a run elsewhere are read back unchanged."""

from __future__ import annotations

import json
import re
from dataclasses import replace

import pytest

from robbdd_tools.protocol.messages import ClauseJudged, ScenarioFinished
from robbdd_tools.protocol.specs import ClauseSpec, Manifest, ScenarioSpec, SceneSpec
from robbdd_tools.run.imported import BrokenResults, ImportedCause, ImportedScenario, read_results
from robbdd_tools.run.junit import junit
from robbdd_tools.run.results import RunResults

CLAUSES = tuple(
    ClauseSpec(line, f"https://x/c{line}", f"c{line}", "then", f'"e:cube" is at "e:bin{line}"') for line in (5, 6, 7)
)


def run() -> RunResults:
    specs = tuple(
        ScenarioSpec(
            "features/s.feature", 3, f"e:v -- {number}", "https://x/tidy", "https://x/v", number, {"e:var-x": "e:a"}, 7,
            SceneSpec(), {}, CLAUSES, model="cell/m.bdd",
        )
        for number in (1, 2)
    )  # fmt: skip
    found = RunResults(Manifest("m.bdd", 1, specs))
    found.apply(ClauseJudged(0, 5, "holds", 0.0156, "m", 1.0, ""))
    found.apply(ClauseJudged(0, 6, "violated", -0.012, "m", 3.2, "it was pushed\nby the arm"))
    found.apply(ClauseJudged(0, 7, "unknown", None, "", None, "timed out"))
    found.apply(ScenarioFinished(0, 9.0, 0.5, 0.3))
    return found


def reported(scenarios: list[ImportedScenario]) -> list[object]:
    return [
        (one.story, one.variation, one.values, [(c.verdict, c.margin, c.said, c.sentence) for c in one.clauses])
        for one in scenarios
    ]


def test_json_and_junit_give_the_same_but_for_consequences_which_junit_folds() -> None:
    from_json, from_junit = read_results(json.dumps(run().as_json())), read_results(junit(run()))
    assert reported(from_json)[0] == reported(from_junit)[0]
    assert [clause.said for clause in from_json[1].clauses] == ["? unknown: the clause was never judged"] * 3
    assert [clause.said for clause in from_junit[1].clauses] == [
        "? unknown: the clause was never judged",
        *["? unknown for the same reason as c5"] * 2,
    ]
    assert [clause.because for clause in from_json[1].clauses] == [
        None,
        *[ImportedCause("https://x/c5", 0, "unknown for the same reason as c5")] * 2,
    ]
    assert [clause.because for clause in from_junit[1].clauses] == [
        None,
        *[ImportedCause(None, None, "unknown for the same reason as c5")] * 2,
    ]
    assert [clause.said for clause in from_json[0].clauses] == [
        "✔ +16 mm",
        "✗ −12 mm at 3.20 s: it was pushed\nby the arm",
        "? unknown: timed out",
    ]
    assert [clause.failure for clause in from_junit[0].clauses] == [
        "",
        "it was pushed by the arm (violated by −12 mm at 3.20 s)",
        "timed out (unknown)",
    ]
    assert from_junit[0].clauses == tuple(replace(clause, iri=None) for clause in from_json[0].clauses)
    assert [clause.margin for clause in from_junit[0].clauses] == ["+16 mm", "−12 mm", ""]
    assert {clause.verdict for clause in from_junit[1].clauses} == {"unknown"}
    assert (from_json[0].variant, from_json[0].model) == ("https://x/v", "cell/m.bdd")
    assert (from_junit[0].variant, from_junit[0].seconds) == ("v", 0.5)


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("", 1, "neither JSON nor XML"),
        ('{\n  "scenarios": [', 2, "neither JSON nor XML"),
        ("[]", 1, "the file: expected an object"),
        ('{"seed": 1}', 1, "scenarios: missing"),
        ('{"scenarios": {}}', 1, "scenarios: expected a list"),
        ('{"scenarios": [3]}', 1, "scenarios[0]: expected an object"),
        ('{"scenarios": [{"values": {}, "story": 3}]}', 1, "scenarios[0].story: expected a text"),
        ('{"scenarios": [{"values": {}, "story": "s", "variant": "v", "variation": true}]}', 1, "a whole number"),
        ("<testsuites>\n<testsuite>", 2, "not well-formed XML"),
        ("<html></html>", 1, "its element is <html>"),
        ('<testsuite><testcase name="adds"/></testsuite>', 1, "not from robbdd"),
        ("[" * 100_000, 1, "nested too deeply"),
    ],
)
def test_a_broken_file_is_reported_with_its_place(text: str, line: int, words: str) -> None:
    with pytest.raises(BrokenResults, match=re.escape(words)) as found:
        read_results(text)
    assert found.value.line == line


def test_a_verdict_that_is_none_is_reported() -> None:
    data = run().as_json()
    data["scenarios"][1]["clauses"][0]["verdict"] = "maybe"
    with pytest.raises(BrokenResults, match=r"scenarios\[1\].clauses\[0\].verdict: expected one of holds, violated"):
        read_results(json.dumps(data))


def test_no_results_are_no_mistake() -> None:
    assert read_results("\ufeff<testsuites/>") == []
    assert read_results('{"scenarios": []}') == []
