"""A text that says a phrase is proposed as this phrase, if its values can fill the slots."""

from __future__ import annotations

import pytest

from checks.models import found
from kit import MODEL, SCENE

GIVEN = "on-bench: holds(<part> is located at <goal>, before <pick-start>)"


@pytest.mark.parametrize(
    ("predicate", "code", "titles"),
    [
        (
            'pred("{r} is nearer than {d} to {p}", r=<robot>, d=0.5 m, p=<places.bench_ws>)',
            "catalog-phrase",
            ["Write '<robot> is nearer than 0.5 m to <places.bench_ws>'"],
        ),
        ('pred("{x} is located at {y}", x=<part>, y="table")', "no-evaluator", []),
        ('pred("{x} is located at {y}", x=<part>, y=3)', "no-evaluator", []),
        ('pred("{x} waves {y}", x=<robot>, y="left")', "no-evaluator", []),
    ],
)
def test_literals_fill_the_slots_of_quantities_only(predicate: str, code: str, titles: list[str]) -> None:
    text = MODEL.replace(GIVEN, f"on-bench: holds({predicate}, before <pick-start>)")
    findings = found(f"//- main.bdd\n{text}//- lab.scene\n{SCENE}", "catalog-phrase") + found(
        f"//- main.bdd\n{text}//- lab.scene\n{SCENE}", "no-evaluator"
    )
    assert [one.code for one in findings] == [code]
    assert [fix.title for fix in findings[0].fixes if fix.title.startswith("Write '")] == titles


AGENTS, OBJECTS = "<agent> does not collide <target>", "<one> does not collide with <other>"


def written(phrase: str, subject: str) -> str:
    for slot in ("<agent>", "<one>"):
        phrase = phrase.replace(slot, f"<{subject}>")
    return phrase.replace("<target>", "<places.bench_ws>").replace("<other>", "<places.bench_ws>")


@pytest.mark.parametrize("preposition", ["", " with"])
@pytest.mark.parametrize(
    ("subject", "values", "judged", "offered"),
    [
        ("robot", "", [AGENTS], [AGENTS]),
        ("part", "", [OBJECTS], [OBJECTS]),
        ("arms.panda", "", [AGENTS], [AGENTS]),
        ("parts.bolt", "", [OBJECTS], [OBJECTS]),
        ("goal", "", [], []),
        ("any", "{ <arms.panda>, <arms.ur10> }", [AGENTS], [AGENTS]),
        ("any", "{ <parts.bolt> }", [OBJECTS], [OBJECTS]),
        ("any", "{ <arms.panda>, <parts.bolt> }", [AGENTS, OBJECTS], []),
        ("any", "{ <arms.panda>, <places.bench_ws> }", [AGENTS], [AGENTS]),
        ("any", "{ <places.bench_ws> }", [], []),
        ("any", "", [AGENTS, OBJECTS], [AGENTS, OBJECTS]),
    ],
)
def test_the_kinds_of_the_values_decide_between_phrases_with_the_same_words(
    preposition: str, subject: str, values: str, judged: list[str], offered: list[str]
) -> None:
    line = f"var <fetch.any>: {values}\n" if values else ""
    clause = f'apart: holds(pred("{{x}} does not collide{preposition} {{y}}", x=<{subject}>, y=<places.bench_ws>), '
    text = MODEL.replace("    var goal\n", "    var goal\n    var any\n")
    text = text.replace(GIVEN, f"( {GIVEN} and {clause}before <end>) )")
    text = text.replace("variation:\n", f"variation:\n{line}")
    files = f"//- main.bdd\n{text}//- lab.scene\n{SCENE}"
    remarks, warnings = found(files, "catalog-phrase"), found(files, "no-evaluator")
    assert (len(remarks), len(warnings)) == ((1, 0) if judged else (0, 1))
    for remark in remarks:
        assert {phrase for phrase in (AGENTS, OBJECTS) if f"'{phrase}'" in remark.message} == set(judged)
        titles = {fix.title for fix in remark.fixes}
        assert titles == {f"Write '{written(phrase, subject)}'" for phrase in offered}
