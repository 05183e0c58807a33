"""Results are shown after clauses and rows, aggregated over variations, and marked when the text has changed."""

from __future__ import annotations

from dataclasses import replace

import pytest

from features.judged_clauses import HOLDS, IRI, NS, ONE, TWO, VIOLATED, judged
from gherkin_kit import edited
from kit import MODEL, fixture
from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.features.clause_results import appearance, clause_diagnostics, clause_hints, row_hints
from robbdd_tools.features.pass_rates import pass_rate
from robbdd_tools.features.project_findings import findings_of
from robbdd_tools.features.run_verdicts import (
    JudgedScenario,
    Judgement,
    Results,
    as_json,
    digests_of,
    from_json,
)
from robbdd_tools.features.scenarios import number_of_scenarios
from robbdd_tools.names.variant_places import variants_of

WORSE = Judgement("in-tray", "violated", "−40 mm", -0.040, "✗ −40 mm at 2.00 s", "")
UNKNOWN = Judgement("in-tray", "unknown", "", 1e6, "? unknown: event never occurred", "")
UNDEFINED = Judgement("in-tray", "undefined", "", 1e6, "? unknown: no step definition for 'x'", "")
TABLE = edited(
    """var <fetch.part>: obj set <parts>
                var <fetch.robot>: { <arms.panda> }
                var <fetch.goal>: { <places.bench_ws>, <places.tray_ws> }""",
    """| <fetch.part> | <fetch.robot> | <fetch.goal> |
                |---|---|---|
                | <parts.bolt> | <arms.panda> | <places.tray_ws> |
                | <parts.nut> | <arms.ur10> | <places.tray_ws> |""",
)


def hints(*judgements: Judgement, text: str = MODEL, before: str = MODEL) -> list[str]:
    """The hints of a text that was run as ``before``."""
    case = fixture(before)
    findings = judged(case, *judgements)
    case.project.open(case.uri, 2, text)
    return [
        f"{text[hint.span.start : hint.span.end].partition(':')[0]} {hint.label}"
        for hint in clause_hints(case.snapshot, case.uri, findings)
    ]


def test_one_result_is_shown_as_it_is() -> None:
    assert hints(HOLDS, text=ONE, before=ONE) == ["in-tray ✔ +31 mm"]


def test_several_results_show_the_worst_and_how_many_hold() -> None:
    assert hints(HOLDS, VIOLATED, HOLDS) == ["in-tray ✗ 2/3  worst −12 mm"]
    assert hints(VIOLATED, WORSE) == ["in-tray ✗ 0/2  worst −40 mm"]
    assert hints(HOLDS, UNKNOWN) == ["in-tray ? 1/2"]
    assert hints(UNDEFINED, UNDEFINED) == ["in-tray ? 0/2 no step definition"]


def test_a_clause_of_a_run_of_some_scenarios_has_not_passed() -> None:
    assert hints(HOLDS) == ["in-tray ? 1 of 4 executed  +31 mm"]
    assert hints(HOLDS, HOLDS) == ["in-tray ? 2 of 4 executed  worst +31 mm"]
    assert hints(HOLDS, VIOLATED) == ["in-tray ✗ 1/2  worst −12 mm"]
    case = fixture(MODEL)
    (hint,) = clause_hints(case.snapshot, case.uri, judged(case, HOLDS, HOLDS))
    assert appearance(hint)["verdict"] == "unknown"
    assert clause_diagnostics(case.snapshot, case.uri, judged(case, HOLDS, HOLDS)) == []


def test_a_clause_of_a_variant_with_an_unknown_number_of_scenarios_has_not_passed() -> None:
    gone = ONE.replace("{ <parts.bolt> }", "obj set <gone>")
    assert hints(HOLDS, text=gone, before=ONE) == ["in-tray ? 1 executed, others unknown  +31 mm"]


def test_an_edited_clause_needs_all_scenarios_again() -> None:
    case = fixture(TWO)
    results = Results(scenario for several in judged(case, HOLDS, HOLDS).variants.values() for scenario in several)
    changed = edited("0.5 seconds after", "0.6 seconds after", TWO)
    case.project.open(case.uri, 2, changed)
    again = judged(case, HOLDS).variants
    for scenarios in again.values():
        results.drop(scenarios[0].scenario_key)
        results.add(scenarios)
    (hint,) = clause_hints(case.snapshot, case.uri, findings_of(results))
    assert hint.label == "? 1 of 2 executed  +31 mm"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("ns t =", "// note\nns t ="),
        ("0.5 seconds after", "0.5   seconds /* */ after".replace("/* */", "// why\n           ")),
        ("var part\n", "var part\n    var spare\n"),
    ],
)
def test_an_edit_elsewhere_or_of_layout_keeps_the_result(old: str, new: str) -> None:
    assert hints(HOLDS, text=edited(old, new, ONE), before=ONE) == ["in-tray ✔ +31 mm"]


def test_the_result_of_an_edited_clause_is_stale_until_the_edit_is_undone() -> None:
    changed = edited("0.5 seconds after", "0.6 seconds after")
    assert hints(HOLDS, VIOLATED, text=changed) == ["in-tray ✗ 1/2  worst −12 mm (stale)"]
    case = fixture(MODEL)
    findings = judged(case, VIOLATED)
    case.project.open(case.uri, 2, changed)
    (hint,) = clause_hints(case.snapshot, case.uri, findings)
    assert hint.tooltip.startswith("The text has changed since this was judged")
    assert clause_diagnostics(case.snapshot, case.uri, findings) == []
    case.project.open(case.uri, 3, MODEL)
    (hint,) = clause_hints(case.snapshot, case.uri, findings)
    assert not hint.stale


def test_a_url_in_a_string_is_no_comment() -> None:
    text = edited("holds(<part> is located at <goal>, 0.5", "holds(pred('see http://a {p}', p=<part>), 0.5")
    case = fixture(text)
    findings = judged(case, HOLDS)
    case.project.open(case.uri, 2, text.replace("http://a {p}", "http://b {p}"))
    (hint,) = clause_hints(case.snapshot, case.uri, findings)
    assert hint.stale


@pytest.mark.parametrize(
    ("result", "severity", "code"),
    [
        (VIOLATED, Severity.ERROR, "clause-violated"),
        (UNKNOWN, Severity.WARNING, "clause-unknown"),
        (UNDEFINED, Severity.WARNING, "clause-undefined"),
    ],
)
def test_what_does_not_hold_is_a_diagnostic_that_names_variation_and_instant(
    result: Judgement, severity: Severity, code: str
) -> None:
    case = fixture(MODEL)
    (found,) = clause_diagnostics(case.snapshot, case.uri, judged(case, HOLDS, result))
    assert (found.severity, found.code) == (severity, code)
    assert f"part = 2: {result.said}" in found.message
    assert "part = 1" not in found.message
    assert clause_diagnostics(case.snapshot, case.uri, judged(case, HOLDS)) == []


def test_many_variations_are_told_in_short() -> None:
    case = fixture(MODEL)
    findings = judged(case, *[VIOLATED] * 30)
    (found,) = clause_diagnostics(case.snapshot, case.uri, findings)
    assert found.message.count("\n") == 6
    assert found.message.endswith("… and 25 more")
    (found,) = clause_diagnostics(case.snapshot, case.uri, findings, brief=True)
    assert found.message.count("\n") == 1
    (hint,) = clause_hints(case.snapshot, case.uri, findings)
    assert hint.tooltip.endswith("… and 10 more")


def test_a_row_says_which_clauses_failed_and_moves_with_its_text() -> None:
    case = fixture(TABLE)
    findings = judged(case, HOLDS, VIOLATED)

    def rows(text: str) -> list[str]:
        case.project.open(case.uri, 2, text)
        found = row_hints(case.snapshot, case.uri, findings)
        return [f"{text[hint.span.start : hint.span.end].split('>')[0][2:]} {hint.label}" for hint in found]

    assert rows(TABLE) == ["<parts.bolt ✔", "<parts.nut ✗ in-tray"]
    bolt, nut = (line for line in TABLE.split("\n") if line.strip().startswith(("| <parts.b", "| <parts.n")))
    assert rows(TABLE.replace(f"{bolt}\n{nut}", f"{nut}\n{bolt}")) == ["<parts.nut ✗ in-tray", "<parts.bolt ✔"]
    assert rows(TABLE.replace("ur10", "panda")) == ["<parts.bolt ✔", "<parts.nut ✗ in-tray (stale)"]
    case.project.open(case.uri, 3, TABLE)
    (found,) = clause_diagnostics(case.snapshot, case.uri, findings)
    assert [TABLE[place.span.start : place.span.end].strip() for place in found.related] == [nut.strip()]


def test_clauses_of_every_kind_have_results() -> None:
    text = edited(
        "in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)",
        "((in-tray: holds(<part> is located at <goal>, after <end>) or 'lamp' after <end>) and 'bell' after <end>)",
        ONE,
    )
    case = fixture(text)
    for iri in (f"{NS}or-fetch.then.0", f"{NS}text-fetch.then.1", f"{NS}when-bhv-fetch.when"):
        (hint,) = clause_hints(case.snapshot, case.uri, judged(case, HOLDS, iri=iri))
        assert hint.label == "✔ +31 mm"


def test_clauses_that_are_unknown_because_of_another_one_have_no_problem_of_their_own() -> None:
    case = fixture(MODEL)
    digests, when, bench = digests_of(case.snapshot, case.uri), f"{NS}when-bhv-fetch.when", f"{NS}on-bench"
    lost, late = replace(UNKNOWN, failure="panda lost it (unknown)"), replace(UNKNOWN, failure="timed out (unknown)")

    def following(cause: str, words: str) -> Judgement:
        return replace(lost, because=cause, because_words=words)

    def problems(*verdicts: tuple[int, str, Judgement], text: str = MODEL) -> list[tuple[str, str, list[str]]]:
        scenarios = [JudgedScenario(case.uri, f"{NS}bench-to-tray", n, f"part = {n}", "", "") for n in (1, 2)]
        for number, iri, verdict in verdicts:
            scenarios[number - 1].judge(iri, replace(verdict, digest=digests.clauses[iri]))
        case.project.open(case.uri, 2, text)
        found = clause_diagnostics(case.snapshot, case.uri, findings_of(scenarios))
        return [
            (text[one.span.start :].split()[0], one.message.split("\n")[0], [other.message for other in one.related])
            for one in found
        ]

    words = "unknown because of carry"
    assert problems((1, IRI, following(when, words)), (1, when, lost), (1, bench, late)) == [
        ("on-bench:", "timed out (unknown) [part = 1]", []),
        ("Behaviour", "panda lost it (unknown), and so 1 more clause [part = 1]", [words]),
    ]
    # Equal texts alone fold nothing.
    assert len(problems((1, IRI, lost), (1, when, lost))) == 2
    # A clause with a reason of its own in another execution has that one first.
    assert problems((1, IRI, following(when, words)), (1, when, lost), (2, IRI, late)) == [
        ("Behaviour", "panda lost it (unknown) [part = 1]", []),
        ("in-tray:", "timed out (unknown) · 0 of 2 hold", []),
    ]
    # If the cause was edited since, the clause must not be left without a problem.
    stale = MODEL.replace("on-bench: holds", "on-bench: not holds")
    assert stale != MODEL
    ((place, message, _),) = problems(
        (1, bench, lost), (1, IRI, following(bench, "unknown because of on-bench")), text=stale
    )
    assert (place, message) == ("in-tray:", "panda lost it (unknown) [part = 1]")


def test_the_hint_of_a_consequence_names_its_cause() -> None:
    case = fixture(MODEL)
    following = replace(UNKNOWN, because=f"{NS}when-bhv-fetch.when", because_words="unknown because of carry")

    def shown(*verdicts: Judgement) -> tuple[str, bool]:
        (hint,) = clause_hints(case.snapshot, case.uri, judged(case, *verdicts))
        return hint.label, "consequence" in appearance(hint)

    assert shown(following) == ("? because of carry", True)
    assert shown(HOLDS, following) == ("? 1/2  because of carry", True)
    (hint,) = clause_hints(case.snapshot, case.uri, judged(case, replace(UNKNOWN, failure="lost (at 2 s) (unknown)")))
    assert appearance(hint)["reason"] == "lost (at 2 s)"
    (hint,) = clause_hints(
        case.snapshot, case.uri, judged(case, replace(VIOLATED, failure="violated by −12 mm at 3.40 s"))
    )
    assert "reason" not in appearance(hint)
    assert shown(UNKNOWN, following) == ("? 0/2", False)
    assert shown(VIOLATED, following)[1] is False


def test_the_failure_of_a_behaviour_is_shown_at_its_first_words() -> None:
    case = fixture(MODEL)
    findings = judged(case, VIOLATED, iri=f"{NS}when-bhv-fetch.when")
    (hint,) = clause_hints(case.snapshot, case.uri, findings)
    (found,) = clause_diagnostics(case.snapshot, case.uri, findings)
    assert "\n" in MODEL[hint.span.start : hint.span.end]
    assert MODEL[found.span.start : found.span.end] == "Behaviour (ns=t) carry"
    assert hint.head == found.span


def test_a_pass_rate_goes_stale_with_its_variant_and_its_template() -> None:
    case = fixture(MODEL)
    findings = judged(case, HOLDS, VIOLATED, UNKNOWN)

    def rate(text: str) -> str:
        case.project.open(case.uri, 2, text)
        (variant,) = variants_of(case.snapshot, case.uri)
        found = pass_rate(case.snapshot, variant, findings, number_of_scenarios(variant))
        assert found is not None
        return found.label

    assert rate(MODEL) == "✗ 3 of 4 executed, 1 passed"
    assert rate("// x\n" + MODEL) == "✗ 3 of 4 executed, 1 passed"
    assert rate(edited("picks <part> and places at <goal>", "picks <part>")) == "✗ 3 of 4 executed, 1 passed (stale)"
    assert rate(edited("{ <arms.panda> }", "{ <arms.ur10> }")) == "✗ 3 of 4 executed, 1 passed (stale)"
    (variant,) = variants_of(case.snapshot, case.uri)
    assert pass_rate(case.snapshot, variant, findings_of(()), 4) is None


def test_the_number_of_scenarios_is_told_from_the_text() -> None:
    for text, number in ((MODEL, 4), (TABLE, 2), (MODEL.replace("obj set <parts>", "obj set <gone>"), None)):
        case = fixture(text)
        (variant,) = variants_of(case.snapshot, case.uri)
        assert number_of_scenarios(variant) == number


def test_a_scenario_that_is_run_again_replaces_its_result() -> None:
    results = Results()
    scenarios = [JudgedScenario("m", "v", number, "", "", "") for number in (1, 1, 2)]
    results.add(scenarios)
    assert list(results) == scenarios
    other = replace(scenarios[0], project="another")
    results.add([other])
    results.drop(("", "v", 1))
    assert list(results) == [scenarios[2], other]
    results.drop_others("", "v", {1})
    assert list(results) == [other]


def test_a_clause_repeated_in_a_scenario_is_as_good_as_its_worst() -> None:
    scenario = JudgedScenario("m", "v", 1, "", "", "")
    for judgement in (VIOLATED, WORSE, HOLDS):
        scenario.judge(IRI, judgement)
    assert scenario.clauses == {IRI: WORSE}
    assert scenario.outcome == "violated"


def test_a_scenario_comes_back_from_plain_data() -> None:
    scenario = JudgedScenario("m", "v", 1, "part = 1", "d", "r", {IRI: VIOLATED}, True)
    assert from_json(as_json(scenario)) == scenario


def test_a_clause_that_could_not_have_failed_is_marked_quietly() -> None:
    vacuous = replace(HOLDS, vacuous="a set is empty")
    assert hints(vacuous, vacuous, text=TWO, before=TWO) == ["in-tray ✔ 2/2  worst +31 mm (vacuous)"]
    assert hints(vacuous, HOLDS, text=TWO, before=TWO) == ["in-tray ✔ 2/2  worst +31 mm"]
    case = fixture(MODEL)
    findings = judged(case, vacuous)
    (found,) = clause_diagnostics(case.snapshot, case.uri, findings)
    assert (found.severity, found.code) == (Severity.HINT, "clause-vacuous")
    assert found.message == "This clause proved little in the last run: a set is empty."
    (hint,) = clause_hints(case.snapshot, case.uri, findings)
    assert hint.tooltip.startswith("It proves little: a set is empty.\n")


def test_a_scenario_takes_the_reasons_of_its_own_clauses() -> None:
    scenario = JudgedScenario("m", "v", 1, "", "", "", {IRI: HOLDS})
    scenario.mark_vacuous({IRI: "constant", "other": "constant"})
    assert scenario.clauses == {IRI: replace(HOLDS, vacuous="constant")}
    assert from_json(as_json(scenario)) == scenario


def test_results_of_deleted_variants_are_forgotten_in_their_model_alone() -> None:
    entries = [JudgedScenario(model, variant, 1, "", "", "") for model, variant in (("a", "v"), ("a", "w"), ("b", "x"))]
    results = Results(entries)
    results.drop_deleted("a", {"w"})
    assert [(entry.model, entry.variant) for entry in results] == [("a", "w"), ("b", "x")]
