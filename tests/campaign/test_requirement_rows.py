"""Requirements in reports: requirement → scenarios → clauses → verdicts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from campaign.executed import UNKNOWN, executions
from campaign.study_agents import QuickAgent, write_study
from campaign.test_report import Page
from checks.test_requirements import CLAUSE, NEED
from kit import EVENTS, STORY
from robbdd_tools.campaign.requirement_rows import RequirementResult, requirement_results, requirement_summary
from robbdd_tools.cli import main
from robbdd_tools.graph.verified_requirements import LinkedRequirement, VerifyingVariant, counted_links
from robbdd_tools.run import scheduler

GRIP, STILL = {"https://x/grip": "grip"}, {"https://x/still": "still"}
OPEN = 'Requirement (ns=t) R-2 { "Nothing else moves." id: "4.1/a" }\n'


def linked(clauses: Mapping[str, str], *, whole: bool = False, iri: str = "https://x/v") -> LinkedRequirement:
    return LinkedRequirement("https://x/R", "R", "", "It grips.", "", (VerifyingVariant(iri, "s.v", clauses, whole),))


def results(margins: Mapping[str, Sequence[float]], link: LinkedRequirement) -> RequirementResult:
    (found,) = requirement_results([link], executions(margins))
    return found


@pytest.mark.parametrize(
    ("link", "verdict", "held"),
    [
        (linked(GRIP), "holds", 3),
        (linked(STILL), "violated", 1),
        (linked({**GRIP, **STILL}), "violated", 1),
        (linked(GRIP, whole=True), "violated", 1),
        (linked(GRIP, iri="https://x/other"), "not run", 0),
        (replace(linked(GRIP), variants=()), "no scenario", 0),
    ],
)
def test_only_the_clauses_that_verify_decide(link: LinkedRequirement, verdict: str, held: int) -> None:
    found = results({"grip": [0.3, 0.2, 0.1], "still": [0.1, -0.2, UNKNOWN]}, link)
    assert (found.verdict, found.held) == (verdict, held)


def test_an_open_clause_is_no_proof() -> None:
    assert results({"grip": [0.3, UNKNOWN]}, linked(GRIP)).verdict == "unknown"
    # A clause that the run did not judge at all is open, too.
    assert results({"other": [0.3, 0.2]}, linked(GRIP)).verdict == "unknown"


def test_a_run_of_some_scenarios_is_no_proof() -> None:
    def verdict(scenarios: int | None, margins: Sequence[float]) -> str:
        (link,) = counted_links([linked(GRIP)], {"https://x/v": scenarios})
        found = results({"grip": margins}, link)
        assert found.scenarios[0].verdict == found.verdict
        return found.verdict

    assert verdict(2, [0.3, 0.2]) == "holds"
    assert verdict(None, [0.3, 0.2]) == "holds"
    assert verdict(3, [0.3, 0.2]) == "not run in full"
    assert verdict(3, [0.3, -0.2]) == "violated"
    (link,) = counted_links([linked(GRIP)], {"https://x/v": 3})
    found = requirement_results([link], executions({"grip": [0.3, 0.2]}))
    assert requirement_summary(found) == "0 of 1 requirements shown, 1 not run in full"


def test_clauses_that_could_not_fail_prove_little() -> None:
    vacuous = [
        replace(one, clauses=(replace(one.clauses[0], vacuous="nothing was near"), *one.clauses[1:]))
        for one in executions({"grip": [0.3, 0.2], "still": [0.1, 0.1]})
    ]
    (alone,) = requirement_results([linked(GRIP)], vacuous)
    (with_other,) = requirement_results([linked({**GRIP, **STILL})], vacuous)
    assert (alone.verdict, with_other.verdict) == ("proves little", "holds")
    assert alone.scenarios[0].clauses[0].vacuous == "nothing was near"


def test_what_is_not_shown_comes_first_and_is_counted() -> None:
    links = [linked(GRIP), replace(linked(GRIP), variants=(), name="none"), linked(STILL)]
    found = requirement_results(links, executions({"grip": [0.3], "still": [-0.2]}))
    assert [one.verdict for one in found] == ["violated", "no scenario", "holds"]
    assert requirement_summary(found) == "1 of 3 requirements shown, 1 violated, 1 without scenario"


@pytest.fixture
def study(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(scheduler, "Agent", QuickAgent)
    monkeypatch.chdir(tmp_path)
    return write_study(tmp_path, model=EVENTS + NEED + OPEN + CLAUSE + STORY)


def test_reports_of_a_run_and_of_a_study_show_the_requirements(study: Path) -> None:
    assert main(["run", "m.bdd", "--junit", "junit.xml", "--repeat", "10"]) == 1
    assert main(["study", "run", str(study)]) == 1
    assert main(["report", "latest", "-o", "run.html", "--no-pictures"]) == 0
    assert main(["report", str(study), "-o", "study.html"]) == 0
    for name, total in (("run.html", 40), ("study.html", 40)):
        text = Page(Path(name).read_text(encoding="utf-8")).text
        assert "0 of 2 requirements shown, 1 violated, 1 without scenario." in text
        assert "✗ violated R-1" in text
        assert f"of {total} executions The part is in the tray. spec.pdf §4" in text
        assert "fetching.bench-to-tray" in text
        assert "○ no scenario R-2 (4.1/a) Nothing else moves. No scenario verifies it." in text
    assert Path("junit.xml").read_text(encoding="utf-8").count("verifies R-1\n") == 40


def test_a_report_shows_the_requirements_of_its_run_and_not_later_ones(study: Path) -> None:
    del study
    main(["run", "m.bdd"])
    Path("m.bdd").write_text(EVENTS + NEED.replace("tray", "bin") + CLAUSE + STORY, encoding="utf-8")
    assert main(["report", "latest", "-o", "run.html", "--no-pictures"]) == 0
    text = Path("run.html").read_text(encoding="utf-8")
    assert "The part is in the tray." in text
    assert "Nothing else moves." in text
