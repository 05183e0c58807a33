"""Conflicts between the types of variables, reported at both places."""

import pytest

from checks.models import SETS, check, found, marked, story
from kit import EVENTS, MODEL, STORY, TEMPLATE
from robbdd_tools.base.diagnostic import Diagnostic, Severity


def errors(text: str) -> list[Diagnostic]:
    return [entry for entry in found(text) if entry.severity is Severity.ERROR]


def test_a_value_fits_the_phrase_that_takes_it() -> None:
    text = MODEL.replace("{ <arms.panda> }", "{ <places.tray_ws> }")
    value = "type-conflict 'places.tray_ws' is a workspace, but 'fetch.robot' stands for an agent"
    phrase = "type-conflict 'robot' is an agent here, but scenario 'bench-to-tray' gives it a workspace"
    text = marked(text, "{ <«places.tray_ws»> }", value)
    text = marked(text, "<«robot»> picks <part>", phrase)
    check(text)
    assert [entry.severity for entry in found(text)] == [Severity.HINT, Severity.ERROR]


@pytest.mark.parametrize(
    ("choices", "place"),
    [
        ("obj set <parts>", "parts"),
        ("set <stuff>", "stuff"),
        ("{ <arms.panda>, 3 }", "3"),
        ("{ 'panda' }", "'panda'"),
    ],
)
def test_every_way_to_give_a_value_is_checked(choices: str, place: str) -> None:
    text = EVENTS + "const set (ns=t) stuff { <arms.panda>, <parts.bolt> }\n" + TEMPLATE
    text += STORY.replace("{ <arms.panda> }", choices)
    findings = [entry for entry in errors(text) if entry.code == "type-conflict"]
    assert [text[entry.span.start : entry.span.end] for entry in findings] == [place]


def test_a_set_is_checked_by_its_elements() -> None:
    lines = STORY[STORY.index("                var ") : STORY.index("        }\n}")]
    for sets in ("{ { <places.tray_ws>, <parts.nut> } }", "select 1 combinations from <parts>"):
        findings = errors(story(lines + f"                set var <fetch.goals>: {sets}\n", SETS))
        assert [entry.code for entry in findings] == ["type-conflict"]
        assert "stands for a workspace in '<object> is located at <workspace>'" in findings[0].message


def test_two_phrases_take_a_variable_for_one_kind_of_thing() -> None:
    text = MODEL.replace("<part> is located at <goal>, 0.5 seconds", "<goal> is held by <robot>,")
    second = "type-conflict 'goal' stands for a workspace in '<object> is located at <workspace>', so it cannot be"
    text = marked(text, "holds(<«goal»> is held by", second)
    text = marked(text, "is located at <«goal»>, before", "type-conflict elsewhere it is an object")
    check(text)


def test_a_variant_uses_a_variable_as_its_template_does() -> None:
    clause = "Then: also: holds(<fetch.robot> is located at <fetch.goal>, after <end>)\n            variation:"
    findings = [entry for entry in found(MODEL.replace("variation:", clause)) if entry.code == "type-conflict"]
    assert sorted(entry.severity for entry in findings) == [Severity.ERROR, Severity.HINT]


def test_a_quantifier_gives_its_variable_the_type_of_its_set() -> None:
    clause = (
        "Then: ( var z exists in <places> ) such that { also: holds(<z> is held by <fetch.robot>, after <end>) }\n"
        "            variation:"
    )
    (finding,) = found(MODEL.replace("variation:", clause))
    assert finding.code == "type-conflict"
    assert "'z' runs over 'places'" in finding.message
    assert finding.related[0].message == "the set has a workspace"


def test_a_text_takes_anything_and_a_target_any_element() -> None:
    clause = (
        "Then: ( also: holds(pred('{g}', g=<fetch.goal>), after <end>)\n"
        " and safe: holds(<fetch.robot> does not collide <fetch.goal>, from <start> until <end>)\n"
        " and set-up: holds(<fetch.robot> has config ee_speed = <fetch.part>, before <start>) )\n variation:"
    )
    assert found(MODEL.replace("variation:", clause), "type-conflict") == []


def test_an_unknown_value_conflicts_with_nothing() -> None:
    assert [entry.code for entry in found(MODEL.replace("{ <arms.panda> }", "{ <arms.pandora> }"))] == ["unknown-name"]


def test_a_phrase_with_a_word_more_that_takes_the_variable_is_offered() -> None:
    text = MODEL.replace("<part> is located at <goal>, 0.5 seconds after", "<part> does not collide <goal>, after")
    (finding,) = [entry for entry in errors(text) if entry.code == "type-conflict"]
    assert finding.message.endswith("use two variables, or write '<one> does not collide with <other>'")
    assert "Write '<part> does not collide with <goal>'" in [fix.title for fix in finding.fixes]
    text = text.replace("<part> does not collide <goal>", "<robot> does not collide with <goal>")
    (finding,) = [entry for entry in errors(text) if entry.code == "type-conflict"]
    assert finding.fixes[0].title == "Write '<robot> does not collide <goal>'"
