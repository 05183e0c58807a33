"""The cause of a failure is the first thing that the badge, Test Results and Problems show."""

from __future__ import annotations

import json

import pytest

from kit import MODEL, fixture
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.features.clause_results import clause_diagnostics
from robbdd_tools.features.project_findings import findings_of
from robbdd_tools.features.run_verdicts import digests_of
from robbdd_tools.lsp.locations import Places
from robbdd_tools.lsp.run_messages import for_client
from robbdd_tools.lsp.run_request import RunText
from robbdd_tools.monitor.time import After
from robbdd_tools.protocol.clauses import Fluent, Junction
from robbdd_tools.protocol.messages import ClauseJudged, decode
from robbdd_tools.protocol.specs import ClauseSpec, Manifest, ScenarioSpec, SceneSpec
from robbdd_tools.run.results import RunResults
from robbdd_tools.workbench.judged_scenarios import judged_scenario, judgement

NS = "https://example.org/t/"
LOCATED = load_catalog().predicates["located-at"]
PARTS = [Fluent(LOCATED, {"object": part, "workspace": "t:tray"}, After("t:end")) for part in ("t:nut", "t:bolt")]
CLAUSE = ClauseSpec(
    5, f"{NS}in-tray", "in-tray", "then", '"t:nut" is located at "t:tray"', Junction("and", tuple(PARTS))
)
SPEC = ScenarioSpec(
    "features/s.feature", 3, "t:bench-to-tray -- 1", f"{NS}fetching", f"{NS}bench-to-tray", 1,
    {"t:var-part": "t:nut"}, 7, SceneSpec(), {}, (CLAUSE,),
)  # fmt: skip
DECIDED = "decided by: bolt is located at tray after end (violated by −12 mm at 3.20 s)"
MEASURED = {"robustness": -0.012, "unit": "m", "at": 3.2}


@pytest.mark.parametrize(
    ("verdict", "fields", "words"),
    [
        ("violated", MEASURED, "violated by −12 mm at 3.20 s"),
        ("violated", {**MEASURED, "operand": 1}, DECIDED),
        ("violated", {"reason": "panda cannot reach a free place"}, "panda cannot reach a free place (violated)"),
        ("violated", {**MEASURED, "reason": "pushed\nby ur10"}, "pushed by ur10 (violated by −12 mm at 3.20 s)"),
        ("no-step", {"reason": "no step judges 'the lamp is green'"}, "no step judges 'the lamp is green' (unknown)"),
        ("user-code", {"reason": "the step failed: KeyError: 'goal'"}, "the step failed: KeyError: 'goal' (unknown)"),
        ("scene", {"reason": "there is no free place on bench_ws"}, "there is no free place on bench_ws (unknown)"),
        ("timed-out", {"reason": "no result within 60 s"}, "no result within 60 s (unknown)"),
        ("process-ended", {"reason": "the process ended: SIGSEGV"}, "the process ended: SIGSEGV (unknown)"),
        ("unreached", {"reason": "panda lost the nut at 2.10 s"}, "panda lost the nut at 2.10 s (unknown)"),
        ("no-event", {"reason": "event place-end never occurred"}, "event place-end never occurred (unknown)"),
        ("simulation", {"reason": "the simulation diverged at 0.50 s"}, "the simulation diverged at 0.50 s (unknown)"),
    ],
)  # fmt: skip
def test_the_cause_of_a_failure_is_shown_first(verdict: str, fields: dict[str, object], words: str) -> None:
    violated = verdict == "violated"
    line = {"robustness": None, "unit": "", "at": None, "reason": "", **fields}
    kind = {"verdict": "violated"} if violated else {"verdict": "unknown", "cause": verdict}
    message = decode(json.dumps({"type": "ClauseJudged", "index": 0, "line": 5, **line, **kind}))
    assert isinstance(message, ClauseJudged)
    case = fixture(MODEL)
    digests = digests_of(case.snapshot, case.uri)

    text = RunText(case.uri, Places((case.uri,), {}, {}), digests, frozenset(), frozenset(), None, ())
    found = RunResults(Manifest("main.bdd", 1, (SPEC,)))
    found.apply(message)
    assert for_client("run", text, found, message)["message"]["failure"] == words

    scenario = judged_scenario(SPEC, case.uri, digests, "", run=1, index=0, seed=None)
    scenario.judge(CLAUSE.iri, judgement(CLAUSE, message, digests))
    (problem,) = clause_diagnostics(case.snapshot, case.uri, findings_of([scenario]))
    assert problem.message == f"{words} [part = nut]"
