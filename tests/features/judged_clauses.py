"""Verdicts of the clauses of one model, as a run of its text would leave them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from kit import MODEL
from robbdd_tools.features.project_findings import findings_of
from robbdd_tools.features.run_verdicts import JudgedScenario, Judgement, Results, digests_of

if TYPE_CHECKING:
    from kit import Fixture
    from robbdd_tools.features.run_verdicts import Findings

NS = "https://example.org/t/"
IRI = f"{NS}in-tray"
HOLDS = Judgement("in-tray", "holds", "+31 mm", 2e6, "✔ +31 mm", "")
VIOLATED = Judgement("in-tray", "violated", "−12 mm", -0.012, "✗ −12 mm at 3.40 s", "")
TWO = MODEL.replace("{ <places.bench_ws>, <places.tray_ws> }", "{ <places.tray_ws> }")
"""The model with two scenarios, instead of four."""
ONE = TWO.replace("obj set <parts>\n", "{ <parts.bolt> }\n")
"""The model with one scenario."""


def judged(case: Fixture, *judgements: Judgement, iri: str = IRI) -> Findings:
    """Findings of a run of the text as it is now, one scenario per judgement."""
    digests, variant = digests_of(case.snapshot, case.uri), f"{NS}bench-to-tray"
    results = Results()
    for number, judgement in enumerate(judgements, start=1):
        row = digests.rows.get((variant, number), "")
        scenario = JudgedScenario(case.uri, variant, number, f"part = {number}", digests.variants[variant], row)
        scenario.judge(iri, replace(judgement, digest=digests.clauses[iri]))
        scenario.finished = True
        results.add([scenario])
    return findings_of(results)
