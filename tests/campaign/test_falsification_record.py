"""The recorded searches for rare failures: their tables, and that the documentation has them."""

from __future__ import annotations

import pytest

from bench.falsification.__main__ import BUDGET, HERE, PROBLEMS, recorded
from bench.falsification.summary import Search, tables
from kit import ROOT
from robbdd_tools.campaign.study_file import load_study


def searches(method: str, *points: int) -> list[Search]:
    """Searches of one problem with a budget of 40; those of 40 points found nothing."""
    return [Search("rim", method, seed, one, int(one < 40), 40, 0) for seed, one in enumerate(points)]


def test_searches_without_a_failure_count_as_the_budget() -> None:
    found = tables([*searches("uniform", 40, 40, 40, 20), *searches("cma-es", 10, 4, 40, 6)], 40)
    assert "| rim | 160 | 1 | 0.6 % | 0.0 % to 3.4 % |" in found
    assert "| rim | `uniform` | 1 of 4 | > 40 | 35.0 [" in found
    assert "| rim | `cma-es` | 3 of 4 | 8 | 15.0 [" in found
    assert "] | 0.43 [" in found


def test_searches_that_all_find_nothing_have_no_interval() -> None:
    assert "| rim | `uniform` | 0 of 3 | > 40 | 40.0 | 1 |" in tables(searches("uniform", 40, 40, 40), 40)


def test_the_documentation_has_the_recorded_tables() -> None:
    text = (ROOT / "docs/falsify.md").read_text(encoding="utf-8")
    for line in tables(list(recorded()), BUDGET).splitlines():
        assert line in text


@pytest.mark.parametrize("problem", PROBLEMS)
def test_each_problem_is_a_study_without_faults(problem: str) -> None:
    study = load_study(HERE / problem / f"{problem}.study")
    assert [one.message for one in study.findings if one.is_error] == []
    assert len(study.content.ranges) in (3, 4)
