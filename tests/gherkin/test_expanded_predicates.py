"""On request, features have the definitions of named predicates in place of their phrases."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from gherkin_kit import edited, model_of
from graph.test_named_predicates import WHOLE
from kit import EXAMPLES, fixture
from robbdd_tools.gherkin.feature import ScenarioText, feature_pieces
from robbdd_tools.gherkin.feature_files import whole_plan, write_features
from robbdd_tools.gherkin.preview import preview
from robbdd_tools.gherkin.user_template import sheet
from robbdd_tools.judging.parsed_sentences import read_clause
from robbdd_tools.monitor.compound import definition_of
from robbdd_tools.monitor.predicate_definitions import Combination, Definition
from robbdd_tools.protocol.clauses import Condition, Filler, Fluent
from robbdd_tools.workbench.model import load

WHENEVER = (
    WHOLE.replace(
        "within 2 seconds after <place-end>)",
        "within 2 seconds after <place-end>) and slow: holds(<robot> moves safely whenever "
        "<part> is-put at <goal> by <robot> and <part> is at rest, from <start> until <end>)",
    )
    .replace("    Then:\n", "    Then: (\n")
    .replace("until <end>)\n}", "until <end>)\n    )\n}")
)


def written(text: str, *, expanded: bool, template: str = "default") -> str:
    model = model_of(text)
    found = (feature_pieces(model, one, sheet=sheet(template), expanded=expanded) for one in model.stories)
    return "".join(piece.text for pieces in found for piece in pieces)


def scenarios(text: str, *, expanded: bool) -> list[ScenarioText]:
    model = model_of(text)
    found = (feature_pieces(model, one, expanded=expanded) for one in model.stories)
    return [piece.scenario for pieces in found for piece in pieces if piece.scenario]


def step(text: str, start: str) -> str:
    return next(line.strip() for line in written(text, expanded=True).splitlines() if line.strip().startswith(start))


def test_the_definition_is_in_place_of_the_phrase_and_the_comment() -> None:
    assert step(WHOLE, "Then") == (
        'Then ( ( "env:bolt" is located at "env:bench_ws" or "env:bolt" is nearer than "5 cm" to "env:bench_ws" ) and '
        'not ( "env:bolt" is held by "env:panda" ) ) at some time within 2 seconds after event "t:place-end"'
    )
    text = written(WHOLE, expanded=True)
    assert " means " not in text
    assert "is-put" not in text
    assert '# event "t:put" occurs when ( ( "env:bolt" is located at "env:bench_ws" or ' in text


def test_conditions_are_expanded() -> None:
    assert step(WHENEVER, 'Then "env:panda" moves safely') == (
        'Then "env:panda" moves safely whenever ( ( "env:bolt" is located at "env:bench_ws" or "env:bolt" is nearer '
        'than "5 cm" to "env:bench_ws" ) and not ( "env:bolt" is held by "env:panda" ) ) and "env:bolt" is at rest '
        'from "t:start" until "t:end"'
    )


def test_all_other_sentences_are_unchanged() -> None:
    plain, expanded = (written(WHENEVER, expanded=one).splitlines() for one in (False, True))
    assert [line for line in expanded if "( (" not in line] == [line for line in plain if "is-put" not in line]


def test_a_choice_of_elements_keeps_the_phrase_because_one_element_must_satisfy_all_of_it() -> None:
    text = edited(
        "in-tray: holds(<part> is-put at <goal> by <robot>, within 2 seconds after <place-end>)",
        "( var x exists in <parts> ) such that { in-tray: holds(<x> is-put at <goal> by <robot>, after <place-end>) }",
        WHOLE,
    )
    shown = written(text, expanded=True)
    assert "Then \"any of ['env:bolt', 'env:nut']\" is-put at" in shown
    assert "# \"any of ['env:bolt', 'env:nut']\" is-put at" in shown


Flat = tuple[object, ...]


def flat(definition: Definition, arguments: dict[str, Filler]) -> Flat:
    """A definition with the values of its slots, without the names of parameters and of other definitions."""
    if isinstance(definition, Combination):
        return (definition.operator, *(flat(one, arguments) for one in definition.operands))
    own = {slot: one if isinstance(one, str) else arguments[one.parameter] for slot, one in definition.fillers.items()}
    inner = definition_of(definition.predicate)
    return flat(inner, own) if inner is not None else (definition.predicate.name, own)


def whole(one: Fluent | Condition) -> Flat:
    definition = definition_of(one.predicate)
    return (one.predicate.name, dict(one.arguments)) if definition is None else flat(definition, dict(one.arguments))


def conditions(fluent: Fluent) -> list[Flat]:
    return [] if fluent.condition is None else [whole(part) for part in fluent.condition.parts]


def test_a_sentence_that_is_read_back_has_the_same_definition() -> None:
    read = 0
    for scenario in scenarios(WHENEVER, expanded=True):
        for one in scenario.steps:
            if isinstance(one.statement, Fluent):
                found = read_clause(one.text)
                assert isinstance(found, Fluent)
                assert (whole(found), found.time) == (whole(one.statement), one.statement.time)
                assert conditions(found) == conditions(one.statement)
                read += one.text.count("( (")
    assert read > 5


@pytest.mark.parametrize(
    "text",
    [
        '( "a" is at rest and "b" shines ) after event "t:e"',
        '( "a" is at rest and "b" is at rest or "c" is at rest ) after event "t:e"',
        '( "a" is at rest and ) after event "t:e"',
        '( "a" is at rest after event "t:e" ) after event "t:e"',
        'not ( "a" is at rest ) whenever ( "b" shines ) after event "t:e"',
    ],
)
def test_what_is_no_definition_is_not_judged(text: str) -> None:
    assert not isinstance(read_clause(text), Fluent)


def test_a_negation_within_and_without_its_time_differ() -> None:
    inside, outside = 'not ( "a" is at rest ) after event "t:e"', 'not ( "a" is at rest after event "t:e" )'
    found = read_clause(inside)
    assert isinstance(found, Fluent)
    assert whole(found) == ("not", ("is-at-rest", {"object": "a"}))
    assert not isinstance(read_clause(outside), Fluent)


def test_an_outline_has_the_steps_of_its_rows() -> None:
    text = written(WHOLE, expanded=True, template="compact")
    assert "Scenario Outline" in text
    assert '( ( "<part>" is located at "<goal>" or "<part>" is nearer than "5 cm" to "<goal>" )' in text


def test_the_line_map_leads_to_the_same_clauses(tmp_path: Path) -> None:
    model = load(EXAMPLES / "namedpredicates" / "namedpredicates.bdd").files[0].acceptance
    maps: list[object] = []
    for expanded in (False, True):
        plan = replace(whole_plan(model), expanded=expanded)
        (feature,) = write_features(plan, tmp_path / str(expanded))
        lines = feature.read_text(encoding="utf-8").splitlines()
        found = json.loads(feature.with_name(feature.name + ".map.json").read_text(encoding="utf-8"))
        for scenario in found["scenarios"]:
            assert all(lines[int(line) - 1].strip().split()[0] in ("When", "Then") for line in scenario["steps"])
        maps.append([list(scenario["steps"].values()) for scenario in found["scenarios"]])
    assert maps[0] == maps[1]


def test_the_preview_is_expanded_on_request() -> None:
    case = fixture(WHOLE)
    assert "is-put" in preview(case.snapshot, case.uri).text
    shown = preview(case.snapshot, case.uri, expanded=True)
    assert "is-put" not in shown.text
    assert len(shown.lines) == len(preview(case.snapshot, case.uri).lines)
