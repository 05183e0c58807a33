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
