"""Coverage of requirements with the verdicts of the latest runs."""

from dataclasses import replace

import pytest

from checks.test_requirements import LINKED, NEED
from features.judged_clauses import HOLDS, VIOLATED, judged
from kit import EVENTS, STORY, TEMPLATE, fixture
from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.features.hover import hover
from robbdd_tools.features.implementation import implementation
from robbdd_tools.features.requirement_results import coverage_of_file, requirement_diagnostics
from robbdd_tools.features.run_verdicts import NOTHING, Judgement

VACUOUS = replace(HOLDS, vacuous="a set is empty")
UNKNOWN = replace(HOLDS, outcome="unknown", said="? not reached", rank=1e6)


def model(where: str) -> str:
    """A model with two scenarios."""
    template, story = LINKED[where]
    return EVENTS + NEED + template + story.replace("{ <places.bench_ws>, <places.tray_ws> }", "{ <places.tray_ws> }")


@pytest.mark.parametrize("where", LINKED)
@pytest.mark.parametrize(
    ("verdicts", "label", "codes"),
    [
        ((), "verified by 1 scenario, not run", []),
        ((HOLDS, HOLDS), "verified by 1 scenario · ✔ 2/2 held", []),
        ((HOLDS, VIOLATED), "verified by 1 scenario · ✗ 1/2 held", ["requirement-failed"]),
        ((HOLDS, UNKNOWN), "verified by 1 scenario · ? 1/2 held", ["requirement-failed"]),
        ((VACUOUS, VACUOUS), "verified by 1 scenario · ✔ 2/2 held (vacuous)", ["requirement-vacuous"]),
        ((VACUOUS, HOLDS), "verified by 1 scenario · ✔ 2/2 held", []),
        ((HOLDS,), "verified by 1 scenario · ? 1 of 2 executed, 1 held", []),
        ((VIOLATED,), "verified by 1 scenario · ✗ 1 of 2 executed, 0 held", ["requirement-failed"]),
    ],
)
def test_a_requirement_shows_its_coverage(
    where: str, verdicts: tuple[Judgement, ...], label: str, codes: list[str]
) -> None:
    case = fixture(model(where))
    findings = judged(case, *verdicts) if verdicts else NOTHING
    assert [one.label for one in coverage_of_file(case.snapshot, case.uri, findings)] == [label]
    found = list(requirement_diagnostics(case.snapshot, case.uri, findings))
    assert [one.code for one in found] == codes
    severities = {"requirement-vacuous": Severity.WARNING}
    bad = Severity.ERROR if VIOLATED in verdicts else Severity.WARNING
    assert [one.severity for one in found] == [severities.get(code, bad) for code in codes]


def test_a_verdict_on_another_text_is_stale_and_no_finding() -> None:
    before, now = fixture(model("clause")), fixture(model("clause").replace("0.5 seconds", "9 seconds"))
    findings = judged(before, VIOLATED)
    (found,) = coverage_of_file(now.snapshot, now.uri, findings)
    assert found.label == "verified by 1 scenario · ✗ 1 of 2 executed, 0 held (stale)"
    assert list(requirement_diagnostics(now.snapshot, now.uri, findings)) == []


def test_a_requirement_with_a_scenario_that_was_not_run_is_not_shown() -> None:
    head, body = model("story").split("        Scenario bench-to-tray {")
    scenario = body.removesuffix("}\n")
    text = f"{head}        Scenario bench-to-tray {{{scenario}        Scenario other {{{body}"
    case = fixture(text)
    (found,) = coverage_of_file(case.snapshot, case.uri, judged(case, HOLDS, HOLDS))
    assert (found.label, found.outcome) == ("verified by 2 scenarios · ? 2/2 held · 1 not run", "unknown")


def test_without_a_scenario_the_label_says_so() -> None:
    case = fixture(EVENTS + NEED + TEMPLATE + STORY)
    assert [one.label for one in coverage_of_file(case.snapshot, case.uri, NOTHING)] == ["no scenario verifies it"]


def test_hover_has_text_source_and_coverage_and_the_implementations_are_scenarios() -> None:
    case = fixture(model("clause").replace("Requirement (ns=t) R-1", "Requirement (ns=t) R$0-1"))
    found = hover(case.snapshot, case.uri, case.cursor, judged(case, VIOLATED))
    assert found is not None
    assert "> The part is in the tray." in found.markdown
    assert "Source: spec.pdf §4" in found.markdown
    assert "- `fetching.bench-to-tray` (`in-tray`): ✗ 1 of 2 executed, 0 held" in found.markdown
    ((_, span),) = implementation(case.snapshot, case.uri, case.cursor)
    assert case.snapshot.document(case.uri).text[span.start : span.end] == "bench-to-tray"
