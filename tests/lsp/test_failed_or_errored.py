"""A violated clause has failed and an unknown one has an error: whatever the server and the reports show agrees."""

from __future__ import annotations

import json
from xml.etree import ElementTree

import pytest

from features.judged_clauses import ONE
from kit import fixture
from robbdd_tools.commands.failure_summary import failure_summary
from robbdd_tools.features.clause_results import appearance, clause_diagnostics, clause_hints
from robbdd_tools.features.pass_rates import pass_rate
from robbdd_tools.features.project_findings import findings_of
from robbdd_tools.features.run_verdicts import digests_of
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.names.variant_places import variants_of
from robbdd_tools.protocol.clauses import Text
from robbdd_tools.protocol.messages import ClauseJudged, ScenarioFinished, decode
from robbdd_tools.protocol.specs import ClauseSpec, Manifest, ScenarioSpec, SceneSpec
from robbdd_tools.run.imported import read_results
from robbdd_tools.run.junit import junit
from robbdd_tools.run.results import RunResults
from robbdd_tools.workbench.judged_scenarios import judged_scenario, judgement

NS = "https://example.org/t/"
NAMES = ("on-bench", "in-tray")
CLAUSES = tuple(
    ClauseSpec(5 + number, f"{NS}{name}", name, "then", f"{name} is so", Text(f"{name} is so"))
    for number, name in enumerate(NAMES)
)
SPEC = ScenarioSpec(
    "features/s.feature", 3, "t:bench-to-tray -- 1", f"{NS}fetching", f"{NS}bench-to-tray", 1,
    {"t:var-part": "t:nut"}, 7, SceneSpec(), {}, CLAUSES,
)  # fmt: skip
HOLDS, MARGIN = {"verdict": "holds"}, {"verdict": "violated", "robustness": -0.012, "unit": "m", "at": 3.2}
REFUSED = {"verdict": "violated", "reason": "panda cannot reach a free place"}


def unknown(cause: str) -> dict[str, object]:
    return {"verdict": "unknown", "cause": cause, "reason": f"because of {cause}"}


@pytest.mark.parametrize(
    ("verdicts", "outcome"),
    [
        ((HOLDS, HOLDS), "holds"),
        ((HOLDS, MARGIN), "violated"),
        ((REFUSED, HOLDS), "violated"),
        *(((HOLDS, unknown(cause)), "unknown") for cause in ("no-step", "user-code", "scene", "timed-out", "no-event")),
        *(((unknown(cause), HOLDS), "unknown") for cause in ("process-ended", "unreached", "simulation")),
        ((MARGIN, unknown("timed-out")), "violated"),
        ((unknown("no-step"), REFUSED), "violated"),
        ((unknown("user-code"), unknown("scene")), "unknown"),
    ],
)
def test_badge_lens_problems_reports_and_summaries_agree(verdicts: tuple[dict[str, object], ...], outcome: str) -> None:
    fields = {"robustness": None, "unit": "", "at": None, "reason": ""}
    messages = [
        decode(json.dumps({"type": "ClauseJudged", "index": 0, "line": clause.line, **fields, **verdict}))
        for clause, verdict in zip(CLAUSES, verdicts, strict=True)
    ]
    results = RunResults(Manifest("main.bdd", 1, (SPEC,)))
    case = fixture(ONE)
    digests = digests_of(case.snapshot, case.uri)
    scenario = judged_scenario(SPEC, case.uri, digests, "", run=1, index=0, seed=None)
    for clause, message in zip(CLAUSES, messages, strict=True):
        assert isinstance(message, ClauseJudged)
        results.apply(message)
        scenario.judge(clause.iri, judgement(clause, message, digests))
    results.apply(ScenarioFinished(0, 9.0, 0.5, 0.3))
    scenario.finished = True
    findings = findings_of([scenario])

    # Each clause: the badge, its colour, and the problem.
    expected = {name: str(verdict["verdict"]) for name, verdict in zip(NAMES, verdicts, strict=True)}
    hints = clause_hints(case.snapshot, case.uri, findings)
    text = case.snapshot.document(case.uri).text
    badges = {text[one.head.start : one.head.end].partition(":")[0]: one for one in hints}
    signs = {"holds": "✔", "violated": "✗", "unknown": "?"}
    assert {name: one.label[0] for name, one in badges.items()} == {name: signs[one] for name, one in expected.items()}
    assert {name: appearance(one)["verdict"] for name, one in badges.items()} == expected
    problems = clause_diagnostics(case.snapshot, case.uri, findings)
    codes = {text[one.span.start : one.span.end].partition(":")[0]: one.code for one in problems}
    # A clause without a step has a code of its own, with a quick fix.
    alike = {name: "clause-unknown" if code == "clause-undefined" else code for name, code in codes.items()}
    assert alike == {name: f"clause-{one}" for name, one in expected.items() if one != "holds"}

    # The scenario: the lens, the stored results, the reports and the causes at the end of a run.
    (variant,) = variants_of(case.snapshot, case.uri)
    rate = pass_rate(case.snapshot, variant, findings, 1)
    assert rate is not None
    assert (rate.outcome, rate.passed) == (outcome, int(outcome == "holds"))
    assert scenario.outcome == outcome
    assert [results.scenarios[0].verdict, results.count(Outcome(outcome))] == [outcome, 1]
    document = results.as_json()
    assert document["scenarios"][0]["verdict"] == outcome
    report = junit(results)
    suite = ElementTree.fromstring(report).find("testsuite")
    assert suite is not None
    counts = (suite.get("failures"), suite.get("errors"))
    assert counts == {"holds": ("0", "0"), "violated": ("1", "0"), "unknown": ("0", "1")}[outcome]
    elements = [one.tag for one in suite.iter() if one.tag in ("failure", "error")]
    assert elements == {"holds": [], "violated": ["failure"], "unknown": ["error"]}[outcome]
    for written in (report, json.dumps(document)):
        (read,) = read_results(written)
        assert [one.verdict for one in read.clauses] == list(expected.values())
    listed = [str(verdict) for verdict, _ in failure_summary(results.scenarios)]
    assert sorted(listed) == sorted(one for one in expected.values() if one != "holds")
