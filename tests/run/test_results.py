"""Messages add up to results, in words and as the documented JSON."""

from __future__ import annotations

from dataclasses import asdict, replace

import pytest

from kit import schema_errors
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.commands.progress import Display
from robbdd_tools.monitor.contact import Contact
from robbdd_tools.monitor.time import After
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.protocol.clauses import Fluent, Junction
from robbdd_tools.protocol.messages import ClauseJudged, RunFinished, ScenarioFinished
from robbdd_tools.protocol.specs import ClauseSpec, Manifest, ScenarioSpec, SceneSpec
from robbdd_tools.run.report import margin, plain_sentence, values_words, verdict_words
from robbdd_tools.run.results import RunResults

CLAUSES = tuple(ClauseSpec(line, f"https://x/c{line}", f"c{line}", "then", f'"e:a" {line}') for line in (5, 6))
SPEC = ScenarioSpec(
    "features/s.feature", 3, "e:v -- 1", "https://x/s", "https://x/v", 1, {"e:var-x": "e:a", "e:var-s": ["e:a", 2]}, 7,
    SceneSpec(), {}, CLAUSES,
)  # fmt: skip


def results(*outcomes: str) -> RunResults:
    found = RunResults(Manifest("m.bdd", 1, (SPEC,)))
    for clause, outcome in zip(CLAUSES, outcomes, strict=False):
        found.apply(ClauseJudged(0, clause.line, outcome, 0.01, "m", 1.0, ""))
    return found


@pytest.mark.parametrize(
    ("outcomes", "verdict"),
    [
        (("holds", "holds"), Outcome.HOLDS),
        (("holds", "violated"), Outcome.VIOLATED),
        (("unknown", "holds"), Outcome.UNKNOWN),
        (("unknown", "violated"), Outcome.VIOLATED),
        (("holds",), Outcome.UNKNOWN),
        ((), Outcome.UNKNOWN),
    ],
)
def test_a_scenario_is_as_good_as_its_worst_clause(outcomes: tuple[str, ...], verdict: Outcome) -> None:
    assert results(*outcomes).scenarios[0].verdict is verdict


def test_what_a_crash_leaves_open_is_unknown_and_nothing_is_lost() -> None:
    found = results("holds")
    closed = found.close("the agent process ended unexpectedly")
    assert [message.line for message in closed] == [6]
    clauses = found.as_json()["scenarios"][0]["clauses"]
    assert [(clause["verdict"], clause["reason"]) for clause in clauses] == [
        ("holds", ""),
        ("unknown", "the agent process ended unexpectedly"),
    ]


@pytest.mark.parametrize(
    ("count", "words"), [(0, "s)"), (1, "; 1 initial place drawn again)"), (3, "places drawn again)")]
)
def test_a_run_tells_how_many_places_were_drawn_again(
    count: int, words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    found = results("holds", "holds")
    found.apply(ScenarioFinished(0, 9.0, 1.0, 0.5, count))
    assert found.as_json()["scenarios"][0]["resampled"] == count
    Display(found).summary(found)
    assert capsys.readouterr().out.rstrip().endswith(words)


TOUCHED = Contact("e:arm", "", "e:shelf", 3.216, 42.3, 3.232, 1.254)


def test_contacts_that_no_clause_names_are_in_the_results_and_shown(capsys: pytest.CaptureFixture[str]) -> None:
    found = results("holds", "holds")
    carried = Contact("e:arm", "e:cup", "scenery0/wall", 4.0, 8.0, 4.0, 0.1)
    itself = Contact("e:arm", "", "e:arm", 5.0, 8.0, 5.0, 0.1)
    message = ScenarioFinished(0, 9.0, 1.0, 0.5, contacts=(TOUCHED, carried, *[itself] * 5))
    found.apply(message)
    assert found.as_json()["scenarios"][0]["contacts"][0] == asdict(TOUCHED)
    Display(found).show(message)
    shown = [line for line in capsys.readouterr().out.splitlines() if "contact" in line]
    assert shown[0] == "  contact: arm touches shelf at 3.22 s: at most 42.3 N at 3.23 s, 1.25 N s"
    assert shown[1].startswith("  contact: cup, held by arm, touches scenery0/wall at 4.00 s")
    assert shown[2].startswith("  contact: arm touches itself at 5.00 s")
    assert shown[5:] == ["  … 2 more contacts in the results of the run"]


def test_results_follow_their_documented_schema() -> None:
    found = results("holds", "violated")
    found.apply(ScenarioFinished(0, 9.0, 1.0, 0.5, contacts=(TOUCHED,)))
    found.apply(RunFinished(True))
    for document in (found.as_json(), results().as_json()):
        assert schema_errors("run.schema.json", document) == []


@pytest.mark.parametrize(
    ("robustness", "unit", "words"),
    [
        (0.0312, "m", "+31 mm"),
        (-0.0012, "m", "−1.2 mm"),
        (0.25, "m/s", "+0.250 m/s"),
        (0.1745, "rad", "+0.174 rad"),
        (-0.004, "m/s", "−0.00400 m/s"),
        (139.96, "N", "+140 N"),
        (1234.6, "N", "+1235 N"),
        (1e-9, "N", "+1.00e-09 N"),
        (0.00004, "m", "+0.040 mm"),
        (1.0, "", ""),
        (None, "m", ""),
    ],
)
def test_margins_are_read_in_everyday_units(robustness: float | None, unit: str, words: str) -> None:
    assert margin(robustness, unit) == words


@pytest.mark.parametrize(
    ("sentence", "words"),
    [
        ('"e:a" is located at "e:w" after event "t:place-end"', "a is located at w after place-end"),
        (
            "\"['e:a', 'e:b']\" are sorted into \"any of ['e:w']\" after event \"t:e\"",
            "[a, b] are sorted into any of [w] after e",
        ),
        (
            '"e:r" has config "ee_speed" = "0.6" for 0.5 seconds before event "t:e"',
            "r has config ee_speed = 0.6 for 0.5 seconds before e",
        ),
    ],
)
def test_sentences_are_shown_without_prefixes(sentence: str, words: str) -> None:
    assert plain_sentence(sentence) == words


def test_a_verdict_says_when_and_why() -> None:
    assert verdict_words(ClauseJudged(0, 5, "holds", 0.031, "m", 2.0, "")) == "✔ +31 mm"
    assert verdict_words(ClauseJudged(0, 5, "violated", -0.02, "m", 3.42, "")) == "✗ −20 mm at 3.42 s"
    assert verdict_words(ClauseJudged(0, 5, "unknown", None, "", None, "event e never occurred")) == (
        "? unknown: event e never occurred"
    )


def test_values_are_shown_by_their_short_names() -> None:
    assert values_words(SPEC) == "x = a, s = {a, 2}"


def test_of_several_fluents_the_one_that_decides_is_named() -> None:
    located = load_catalog().predicates["located-at"]
    left, right = (Fluent(located, {"object": "t:a", "workspace": f"t:{place}"}, After("t:e")) for place in ("l", "r"))
    several = ClauseSpec(5, "t:c", "c", "then", "…", Junction("or", (left, right)))
    judged = ClauseJudged(0, 5, "holds", 0.031, "m", 2.0, "", operand=1)
    assert verdict_words(judged, several) == "✔ +31 mm (decided by: a is located at r after e)"
    assert verdict_words(judged, replace(several, statement=left)) == "✔ +31 mm"
    # The sentence was edited since.
    assert verdict_words(replace(judged, operand=2), several) == "✔ +31 mm"


def test_a_clause_without_a_name_is_called_by_its_sentence_in_the_first_scenario() -> None:
    clauses = (
        ClauseSpec(5, "urn:c", "c", "then", '"e:a" is at rest after event "t:e"'),
        ClauseSpec(6, "urn:not-fetch.then.1", "not-fetch.then.1", "then", 'not ( "e:a" is at rest after event "t:e" )'),
    )
    first = ScenarioSpec("s.feature", 3, "e:v -- 1", "urn:s", "urn:v", 1, {}, 7, SceneSpec(), {}, clauses)
    other = replace(first, variation=2, clauses=(replace(clauses[1], sentence='not ( "e:b" is at rest )'),))
    found = RunResults(Manifest("m.bdd", 1, (first, other))).titles()
    assert list(found.items()) == [("urn:c", "c"), ("urn:not-fetch.then.1", "'not ( a is at rest after e )'")]
