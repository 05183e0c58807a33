"""Results of a run are shown at the policies of a ``.bddx`` and where its executions use them."""

from __future__ import annotations

from dataclasses import replace

import pytest

from features.judged_clauses import HOLDS, IRI, NS, ONE, VIOLATED
from kit import MODEL, SCENE, Fixture, fixture
from robbdd_tools.features.hover import hover
from robbdd_tools.features.policy_results import policy_hints
from robbdd_tools.features.project_findings import findings_of
from robbdd_tools.features.run_verdicts import Findings, JudgedScenario, Judgement, Results, digests_of

X = "https://example.org/x/"
RUNS = """import "main.bdd"
import "cell.scenex"
ns x = 'https://example.org/x/'
bhv impl (ns=x) motion { catalog "pick-place" }
obs policy (ns=x) seen
    for <fetch.in-tray>
{ trinary topic: "/tray" }
obs policy (ns=x) spare for <fetch.in-tray> { trinary topic: "/spare" }
Scenario Exec (ns=x) by-topic {
    variant: <fetching.bench-to-tray>
    scene inst: <cell>
    bhv: <motion>
    policies: { <seen> }
}
Scenario Exec (ns=x) again {
    variant: <fetching.bench-to-tray>
    scene inst: <cell>
    bhv: <motion>
    policies: { <seen> }
}
Scenario Exec (ns=x) plain { variant: <fetching.bench-to-tray> scene inst: <cell> bhv: <motion> }
"""
CELL = "import \"lab.scene\"\nns x = 'https://example.org/x/'\nscene inst (ns=x) cell { scene: <bench_scene> }\n"


def case(runs: str = RUNS, model: str = ONE) -> Fixture:
    return fixture(f"//- run.bddx\n{runs}//- main.bdd\n{model}//- cell.scenex\n{CELL}//- lab.scene\n{SCENE}")


def judged(**outcomes: Judgement) -> Findings:
    """Findings of a run of each execution with the text as it is, one scenario each."""
    known = case()
    digests, variant, results = digests_of(known.snapshot, known.uri), f"{NS}bench-to-tray", Results()
    for number, (name, judgement) in enumerate(outcomes.items(), start=1):
        iri = f"{X}{name.replace('_', '-')}"
        found = JudgedScenario(known.uri, variant, 1, f"part = {number}", digests.variants[variant], "")
        found.execution, found.execution_digest, found.finished = iri, digests.executions.get(iri, ""), True
        found.judge(IRI, replace(judgement, digest=digests.clauses[IRI]))
        results.add([found])
    return findings_of(results)


def hints(findings: Findings, text: Fixture | None = None) -> list[str]:
    text = text or case()
    shown = text.snapshot.document(text.uri).text
    return [
        f"{' '.join(shown[one.head.start : one.head.end].split())} {one.label}"
        for one in policy_hints(text.snapshot, text.uri, findings)
    ]


def test_a_policy_has_the_results_of_the_executions_that_use_it() -> None:
    findings = judged(by_topic=HOLDS, again=VIOLATED, plain=VIOLATED)
    assert hints(findings) == [
        "seen for <fetch.in-tray> ✗ 1/2  worst −12 mm",
        "<seen> ✔ +31 mm",
        "<seen> ✗ −12 mm at 3.40 s",
    ]


def test_a_policy_with_some_of_its_executions_has_not_passed() -> None:
    # Each execution has four scenarios, of which one was executed.
    found = hints(judged(by_topic=HOLDS, again=HOLDS), case(model=MODEL))
    assert [one.removesuffix(" (stale)") for one in found] == [
        "seen for <fetch.in-tray> ? 2 of 8 executed  worst +31 mm",
        "<seen> ? 1 of 4 executed  +31 mm",
        "<seen> ? 1 of 4 executed  +31 mm",
    ]


def test_results_without_the_policy_are_not_its_results() -> None:
    assert hints(judged(plain=VIOLATED)) == []
    no_execution = judged(by_topic=HOLDS)
    for scenarios in no_execution.variants.values():
        scenarios[0].execution = ""
    assert hints(no_execution) == []


EDITS = [
    ('"/tray"', '"/other"', " (stale)"),
    ("<seen> }", "<seen> }\n    seed: 3", " (stale)"),
    ("<motion>\n", "<motion> // as before\n", ""),
]


@pytest.mark.parametrize(("old", "new", "age"), EDITS)
def test_they_are_stale_when_the_policy_or_the_execution_has_changed(old: str, new: str, age: str) -> None:
    found = hints(judged(by_topic=HOLDS), case(RUNS.replace(old, new, 1)))
    assert found == [f"seen for <fetch.in-tray> ✔ +31 mm{age}", f"<seen> ✔ +31 mm{age}"]


def test_they_are_stale_when_the_clause_has_changed() -> None:
    edited = ONE.replace("0.5 seconds after", "0.6 seconds after")
    assert edited != ONE
    found = hints(judged(by_topic=HOLDS), case(model=edited))
    assert found == ["seen for <fetch.in-tray> ✔ +31 mm (stale)", "<seen> ✔ +31 mm (stale)"]


def words(place: str, findings: Findings) -> str:
    text = case(RUNS.replace(place.replace("$0", ""), place, 1))
    found = hover(text.snapshot, text.uri, text.cursor, findings)
    assert found is not None
    return found.markdown


def test_hover_shows_the_results_of_a_policy_once() -> None:
    findings = judged(by_topic=HOLDS, again=VIOLATED)
    results = "Last results:\n\n- part = 2: ✗ −12 mm at 3.40 s\n- part = 1: ✔ +31 mm"
    for place in ("policy (ns=x) se$0en", "policies: { <se$0en> }"):
        assert words(place, findings).count(results) == 1


def test_hover_shows_the_results_of_an_execution() -> None:
    found = words("Exec (ns=x) aga$0in", judged(by_topic=HOLDS, again=VIOLATED))
    assert "Last results:\n\n- `again`: ✗ 0/1 passed\n  - part = 2: in-tray ✗ −12 mm at 3.40 s" in found
    assert "part = 1" not in found
