"""Every clause of the language has its sentence."""

from __future__ import annotations

import pytest

from gherkin_kit import edited, steps
from kit import EVENTS, MODEL

AT = '"env:bolt" is located at "env:bench_ws"'
HELD = '"env:bolt" is held by "env:panda"'


def then(clauses: str, model: str = MODEL) -> list[str]:
    """The Then steps of a template with other clauses there."""
    clause = "in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)"
    return [step for step in steps(edited(clause, clauses, model)) if step.startswith("Then")]


@pytest.mark.parametrize(
    ("clause", "sentence"),
    [
        ("c: holds(<part> is located at <goal>, after <end>)", f'{AT} after event "t:end"'),
        ("c: holds(<part> is held by <robot>, before <end>)", f'{HELD} before event "t:end"'),
        ("c: holds(<robot> can reach <part>, before <end>)", '"env:panda" can reach "env:bolt" before event "t:end"'),
        (
            "c: holds(<robot> does not drop <part>, from <start> until <end>)",
            '"env:panda" does not drop "env:bolt" from "t:start" until "t:end"',
        ),
        (
            "c: holds(<robot> does not collide <goal>, 2 seconds before <end>)",
            '"env:panda" does not collide "env:bench_ws" for 2 seconds before event "t:end"',
        ),
        (
            "c: holds(pred('the {x} glows', x=<part>), after <end>)",
            'the env:bolt glows after event "t:end"',
        ),
        ('"the lamp is green" after <end>', 'the lamp is green after event "t:end"'),
    ],
)
def test_each_kind_of_clause_has_its_sentence(clause: str, sentence: str) -> None:
    assert then(clause) == [f"Then {sentence}"]


def test_a_configuration_has_its_value() -> None:
    model = edited("var part\n", "var part\n    var speed\n")
    model = edited("var <fetch.part>", "var <fetch.speed>: { 0.9, 1 }\n                var <fetch.part>", model)
    clause = "c: holds(<robot> has config speed = <speed>, 0.1234567 seconds after <end>)"
    sentence = '"env:panda" has config "speed" = "0.9" for 0.1234567 seconds after event "t:end"'
    assert then(clause, model) == [f"Then {sentence}"]


A, B, C = (f"c-{name}: holds(<part> is located at <goal>, after <{name}>)" for name in ("start", "end", "place-end"))
SA, SB, SC = (f'{AT} after event "t:{name}"' for name in ("start", "end", "place-end"))


@pytest.mark.parametrize(
    ("clauses", "sentences"),
    [
        (f"({A} and {B})", [SA, SB]),
        (f"({A} or {B})", [f"( {SA} or {SB} )"]),
        (f"(not {A})", [f"not ( {SA} )"]),
        (f"(({A} or (not {B})) and {C})", [f"( {SA} or not ( {SB} ) )", SC]),
        (f"({A} or ({B} and {C}))", [f"( {SA} or ( {SB} and {SC} ) )"]),
        (f"(not ({A} or {B}))", [f"not ( ( {SA} or {SB} ) )"]),
    ],
)
def test_groups_nest(clauses: str, sentences: list[str]) -> None:
    assert then(clauses) == [f"Then {sentence}" for sentence in sentences]


def test_what_free_text_says_cannot_change_its_group() -> None:
    (step,) = then("""('on ) or ( "odd" and (so' after <end> or (not '"a" or (b)' after <end>))""")
    assert step == (
        'Then ( on \\) \\or \\( "odd" \\and \\(so after event "t:end" or not ( "a" \\or \\(b\\) after event "t:end" ) )'
    )


IN = "(var y exists in <places>) such that { %s }"
THERE, BESIDE = (f"y-{name}: holds(<part> is located at <y>, after <{name}>)" for name in ("start", "end"))


def at(place: str, event: str) -> str:
    return f'"env:bolt" is located at "env:{place}" after event "t:{event}"'


@pytest.mark.parametrize(
    ("body", "sentences"),
    [
        (THERE, ['"env:bolt" is located at "any of [\'env:tray_ws\', \'env:bench_ws\']" after event "t:start"']),
        (
            f"({THERE} and {C})",
            ['"env:bolt" is located at "any of [\'env:tray_ws\', \'env:bench_ws\']" after event "t:start"', SC],
        ),
        (f"(not {THERE})", [f"( not ( {at('tray_ws', 'start')} ) or not ( {at('bench_ws', 'start')} ) )"]),
        (
            f"({THERE} and {BESIDE})",
            [
                f"( ( {at('tray_ws', 'start')} and {at('tray_ws', 'end')} )"
                f" or ( {at('bench_ws', 'start')} and {at('bench_ws', 'end')} ) )"
            ],
        ),
    ],
)
def test_one_choice_must_satisfy_everything_that_is_said_of_it(body: str, sentences: list[str]) -> None:
    model = edited(
        "Scenario Template", "const set (ns=t) spots { <places.tray_ws>, <places.bench_ws> }\nScenario Template"
    )
    assert then(IN.replace("<places>", "<spots>") % body, model) == [f"Then {sentence}" for sentence in sentences]


def test_events_of_a_variant_are_awaited_after_what_the_template_does() -> None:
    model = edited("When:", "When:\n        event <start> occurs")
    model = edited("scene: <bench_scene>", "scene: <bench_scene>\n            When: event <end> occurs", model)
    assert [step for step in steps(model) if step.startswith("When")] == [
        'When event "t:start" occurs',
        'When "env:panda" picks "env:bolt" and places it at "env:bench_ws"',
        'When event "t:end" occurs',
    ]


NESTED = """Scenario Template (ns=t) all {
    duration: from <start> until <end>
    task: <task>
    set var parts
    set var goals
    for all ( var x in <parts> ) {
        for all ( var y in <goals> ) {
            Given: there: holds(<x> is located at <y>, before <start>)
            When: Behaviour (ns=t) take { duration: from <start> until <end> <arm> picks <x> }
        }
    }
"""


def test_quantifiers_nest() -> None:
    story = """}
User Story (ns=t) sorting {
    As A "o" I Want "p" So That "w"
    Scenarios:
        Scenario sort {
            template: <all>
            scene: <bench_scene>
            variation:
                set var <all.parts>: { { <parts.bolt>, <parts.nut> } }
                set var <all.goals>: { { <places.bench_ws>, <places.tray_ws> } }
                var <all.arm>: { <arms.panda> }
        }
}
"""
    given = [
        step
        for step in steps(EVENTS + NESTED.replace("set var parts", "var arm\n    set var parts") + story)
        if "located" in step
    ]
    assert given == [
        f'Given "env:{part}" is located at "env:{place}" before event "t:start"'
        for part in ("bolt", "nut")
        for place in ("bench_ws", "tray_ws")
    ]


def test_a_behaviour_chooses_any_of_a_set_of_places() -> None:
    model = edited("var goal\n", "set var goals\n    var goal\n").replace("places at <goal>", "places at <goals>")
    bins = "set var <fetch.goals>: { { <places.bench_ws>, <places.tray_ws> } }"
    model = edited("var <fetch.part>", f"{bins}\n                var <fetch.part>", model)
    (found,) = [step for step in steps(model) if step.startswith("When")]
    places = "any of ['env:bench_ws', 'env:tray_ws']"
    assert found == f'When "env:panda" picks "env:bolt" and places it at "{places}"'
