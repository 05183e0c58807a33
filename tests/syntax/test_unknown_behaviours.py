"""Unknown behaviours, units of settings, missing units and written-out sets of quantifiers are explained and fixed."""

from __future__ import annotations

import pytest

from kit import MODEL
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.syntax.declaration import SyntaxFault
from robbdd_tools.syntax.parse import parse_declaration

TEMPLATE = MODEL[MODEL.index("Scenario Template") : MODEL.index("User Story")]
GIVEN = "on-bench: holds(<part> is located at <goal>, before <pick-start>)"
ACTION = "<robot> picks <part> and places at <goal>"


def faults(text: str) -> tuple[SyntaxFault, ...]:
    return parse_declaration("bdd", text).faults


def fixed(text: str, fault: SyntaxFault) -> str:
    assert fault.fix is not None
    return text[: fault.fix.span.start] + fault.fix.text + text[fault.fix.span.end :]


@pytest.mark.parametrize(
    ("behaviour", "written", "nearest", "fix"),
    [
        ("<robot> grabs <part>", "grabs <part>", "<agent> picks <object>", None),
        ("<robot> picks <part> and puts it at <goal>", None, "<agent> picks <object> and places at <workspace>", None),
        ("<robot> piks <part>", "piks <part>", "<agent> picks <object>", "picks <part>"),
        ("<robot> drives to <goal>", "drives to <goal>", "<agent> moves to <workspace>", None),
        ("<robot> shoves <part> to <goal>", None, "<agent> pushes <object> to <workspace>", None),
        ("<robot> shuts <part>", None, "<agent> closes <object>", None),
        ("<robot> gives <part> to <other>", None, "<agent> hands over <object> to <receiver>", None),
        ("<robot> dances", "dances", None, None),
    ],
)
def test_the_nearest_behaviours_are_named(
    behaviour: str, written: str | None, nearest: str | None, fix: str | None
) -> None:
    text = TEMPLATE.replace(ACTION, behaviour)
    assert text != TEMPLATE
    fault = faults(text)[0]
    assert text[fault.span.start : fault.span.end] == (written or behaviour.partition("> ")[2])
    listed = fault.message.partition(": ")[2]
    if nearest is None:
        phrases = [word.phrase for word in load_catalog().behaviours.values()]
        assert listed == f"there are {', '.join(map(repr, phrases))}"
    else:
        assert listed.removeprefix("the nearest is ").removeprefix("the nearest are ").split("'")[1] == nearest
    if fix is not None:
        assert fault.fix is not None
        assert fault.fix.text == fix
        assert faults(fixed(text, fault)) == ()


def test_the_behaviour_of_a_loop_and_a_further_behaviour_are_explained() -> None:
    further = TEMPLATE.replace(
        f"{ACTION}\n        }}",
        f"{ACTION}\n        }}\n        then <robot> drops <part> from <pick-start> until <end>",
    )
    (fault,) = faults(further)
    assert further[fault.span.start : fault.span.end] == "drops <part>"
    assert "'<agent> places <object> at <workspace>'" in fault.message


def test_no_synonym_is_the_verb_of_a_behaviour() -> None:
    behaviours = load_catalog().behaviours.values()
    verbs = {word.phrase.partition("> ")[2].partition(" ")[0] for word in behaviours}
    assert verbs.isdisjoint(synonym for word in behaviours for synonym in word.synonyms)


@pytest.mark.parametrize(
    ("phrase", "found", "message", "written"),
    [
        ("<robot> has config travel_height = 0.3 m", "m", "is a number in m, without a unit: write '0.3'", "= 0.3,"),
        ("<robot> has config travel_height = 30 cm", "cm", "is a number in m, without a unit: write '0.3'", "= 0.3,"),
        ("<part> has config mass = 45 g", "g", "is a number in kg, without a unit: write '0.045'", "= 0.045,"),
        ("<part> has config height_scale = 0.9 m", "m", "is a number, without a unit: write '0.9'", "= 0.9,"),
        ("<part> has config own = 3 N", "N", "'own' is a number, without a unit: write '3'", "= 3,"),
        ("<robot> has config travel_height = 0.3 s", "s", "is a number in m, without a unit: write it in m", None),
        ("<robot> moves slower than 0.25", "0.25", "a number needs a unit here: write for example", "0.25 m/s,"),
        ("<part> is tilted less than 10", "10", "a number needs a unit here: write for example", "10 deg,"),
        ("<robot> is nearer than 3 to <part>", "3", "a number needs a unit here: write for example", "3 m to"),
    ],
)
def test_units_are_removed_inserted_or_converted(phrase: str, found: str, message: str, written: str | None) -> None:
    text = TEMPLATE.replace(GIVEN, f"on-bench: holds({phrase}, before <pick-start>)")
    (fault,) = faults(text)
    assert text[fault.span.start : fault.span.end] == found
    assert message in fault.message
    if written is None:
        assert fault.fix is None
        return
    assert written in fixed(text, fault)
    assert faults(fixed(text, fault)) == ()


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (GIVEN, f"( var x exists in {{ <a.b>, <a.c> }} ) such that {{ {GIVEN} }}"),
        (f"    Given:\n        {GIVEN}\n    When:", "    for all ( var x in { <a.b>, <a.c> } ) {\n    When:"),
    ],
)
def test_a_set_that_is_written_out_gets_a_name(old: str, new: str) -> None:
    assert old in TEMPLATE
    text = TEMPLATE.replace(old, new)
    if "for all" in new:
        text = text.replace("    Then:", "    }\n    Then:")
    (fault,) = faults(text)
    assert text[fault.span.start : fault.span.end] == "{ <a.b>, <a.c> }"
    declared = "const set (ns=t) x-values { <a.b>, <a.c> }"
    assert fault.message == (f"a quantifier runs over a named set: declare '{declared}', and write '<x-values>' here")
    written = fixed(text, fault)
    above, _, template = written.partition("\n\n")
    assert above == declared
    assert faults(above) == () == faults(template)
    assert "in <x-values> )" in template


@pytest.mark.parametrize(
    "group",
    [
        f"( not {GIVEN} )",
        f"( {GIVEN} or b: holds(<part> is at rest, before <end>) )",
        f"( var x exists in <places> ) such that {{ {GIVEN} }}",
    ],
)
def test_a_name_before_parentheses_is_removed(group: str) -> None:
    text = TEMPLATE.replace(GIVEN, f"( all-of-it : {group} and c: holds(<part> is glued, before <end>) )")
    named, unknown = faults(text)
    assert text[named.span.start : named.span.end] == "all-of-it :"
    assert named.message == "parentheses have no name, but each clause inside has one: remove 'all-of-it :'"
    assert unknown.message.startswith("there is no phrase 'is glued'")
    assert len(faults(fixed(text, named))) == 1


def test_a_second_hides_no_other_mistake() -> None:
    text = TEMPLATE.replace("0.5 seconds after", "1 second after").replace(
        "is located at <goal>, before", "is glued, before"
    )
    assert [one.message.partition(":")[0] for one in faults(text)] == [
        "there is no phrase 'is glued'",
        "write the unit as 'seconds'",
    ]


def test_the_words_of_a_feature_are_explained() -> None:
    text = TEMPLATE.replace("0.5 seconds after", "for 0.5 seconds after")
    (fault,) = faults(text)
    assert text[fault.span.start : fault.span.end] == "for"
    assert fault.message == "leave out 'for': 'N seconds after' means throughout these seconds"
    assert fixed(text, fault) == TEMPLATE


@pytest.mark.parametrize(
    ("phrase", "found", "message"),
    [
        ("at least 2 <parts> are located at <goal>", "at least", "a phrase does not count: write '( var x exists in"),
        ("all <parts> are located at <goal>", "all", "a phrase does not count: write '( var x exists in"),
        ("the duration is less than 4 s", "the duration", "a duration is required by 'it takes less than 12 s, from"),
        ("distance between <part> and <goal> below 1 m", "distance", "a distance is required by '<a> is nearer than"),
        ("part is at rest", "part", "names must be in angle brackets"),
    ],
)
def test_the_first_words_of_a_requirement_lead_to_what_the_language_has(phrase: str, found: str, message: str) -> None:
    text = TEMPLATE.replace(GIVEN, f"on-bench: holds({phrase}, before <pick-start>)")
    fault = faults(text)[0]
    assert text[fault.span.start : fault.span.end] == found
    assert fault.message.startswith(message)


@pytest.mark.parametrize(
    ("old", "new", "found", "written"),
    [
        (GIVEN, "a: holds(<robot> moves slower than 2 km/h, before <end>)", "km/h", "0.555556 m/s"),
        (GIVEN, "a: holds(<robot> moves slower than 25 cm/s, before <end>)", "cm/s", "0.25 m/s"),
        (GIVEN, "a: holds(<part> is tilted less than 10 degrees, before <end>)", "degrees", "10 deg"),
        (GIVEN, "a: holds(<part> is tilted less than 10°, before <end>)", "°", "10 deg"),
        (GIVEN, "a: holds(<robot> is nearer than 1.5 metres to <part>, before <end>)", "metres", "1.5 m"),
        (GIVEN, "a: holds(it takes less than 2 min, from <start> until <end>)", "min", "120 s"),
        ("0.5 seconds after", "500 ms after", "ms", "0.5 seconds"),
        ("0.5 seconds after", "within 2 minutes after", "minutes", "120 seconds"),
    ],
)
def test_units_of_others_are_converted(old: str, new: str, found: str, written: str) -> None:
    text = TEMPLATE.replace(old, new)
    assert text != TEMPLATE
    (fault,) = faults(text)
    assert text[fault.span.start : fault.span.end] == found
    assert fault.message.endswith(f"'{written}'")
    assert written in fixed(text, fault)
    assert faults(fixed(text, fault)) == ()


@pytest.mark.parametrize(
    ("kind", "text", "found", "written"),
    [
        ("bdd", "const set (ns=t) limits { 600 mm/s, 1 m/s }", "mm/s", "0.6 m/s"),
        ("bdd", "const set (ns=t) limits { 1 m/s, 5 km/h }", "km/h", "1.38889 m/s"),
        ("scene", "obj set (ns=t) parts { object nut { mass: 2 kilograms }, object bolt }", "kilograms", "2 kg"),
        ("scene", "obj set (ns=t) parts { object nut { wait: 2 min colour: red } }", "min", "120 s"),
    ],
)
def test_units_of_others_in_values_are_converted(kind: str, text: str, found: str, written: str) -> None:
    (fault,) = parse_declaration(kind, text).faults
    assert text[fault.span.start : fault.span.end] == found
    assert fault.message == f"'{found}' is not a unit of the language: write '{written}'"
    assert parse_declaration(kind, fixed(text, fault)).faults == ()


def test_an_unknown_unit_of_a_property_is_explained() -> None:
    text = "obj set (ns=t) parts { object nut { mass: 2 lb } }"
    (fault,) = parse_declaration("scene", text).faults
    assert text[fault.span.start : fault.span.end] == "lb"
    assert fault.message.startswith("'lb' is neither a unit nor a property with a value: the units are m cm mm ")
