"""The pages for assistants: their model runs, they name every phrase, and models written from them can be judged."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import robbdd_tools as robbdd
from assistants.judge_models import Requirement, expression, judged, requirements
from kit import DOCS
from robbdd_tools.catalog.registry import load_catalog

LANGUAGE = (DOCS / "assistants" / "language.md").read_text(encoding="utf-8")
SCENE, CRITERIA = re.findall(r"```robbdd\n(.*?)```", LANGUAGE, re.DOTALL)
NOT_FOR_NEWCOMERS = {"moves-safely", "can-reach"}


@pytest.fixture
def cell(tmp_path: Path) -> Path:
    (tmp_path / "cell.scene").write_text(SCENE, encoding="utf-8")
    (tmp_path / "main.bdd").write_text(CRITERIA, encoding="utf-8")
    return tmp_path


def test_the_model_of_the_page_has_no_error_and_no_warning(cell: Path) -> None:
    model = robbdd.load(cell)
    assert [one for one in model.diagnostics if one.severity < robbdd.Severity.INFORMATION] == []
    assert len(model.scenarios()) == 4


def test_the_page_names_every_phrase_of_the_catalog() -> None:
    catalog = load_catalog()
    for word in (*catalog.predicates.values(), *catalog.behaviours.values()):
        if word.name in NOT_FOR_NEWCOMERS:
            continue
        pattern = re.sub(r"<\w+>|[#$]\w+", "@", word.phrase)
        found = re.escape(pattern).replace("@", r"(?:<[\w-]+>|[\w.]+(?: [\w/%]+)?)")
        assert re.search(found, LANGUAGE), word.phrase


def test_a_model_is_judged_by_its_errors_and_by_its_clauses(cell: Path) -> None:
    def stated(*clauses: str, scenarios: int = 1, matches: int = 1) -> tuple[bool, bool]:
        found = judged(Requirement("r", "", clauses, matches, scenarios), cell)
        return found.clean, found.faithful

    assert stated("_ is located at _ at some time within {n} seconds after event _", "_ is held by _") == (True, True)
    assert stated("_ is located at _", matches=3) == (True, True)
    assert stated("_ is located at _", matches=4) == (True, False)
    assert stated("_ is located at _ for 3 seconds after event _") == (True, False)
    assert stated("_ is located at _", scenarios=5) == (True, False)
    (cell / "main.bdd").write_text(CRITERIA.replace("<carry-task>", "<carry-tusk>"), encoding="utf-8")
    assert stated("_ is located at _") == (False, False)
    (cell / "main.bdd").unlink()
    assert stated("_ is located at _") == (False, False)


def test_every_requirement_has_its_patterns_and_its_prose() -> None:
    found = requirements()
    assert len({one.id for one in found}) == len(found) >= 16
    for one in found:
        assert one.prose
        assert one.clauses
        assert all(re.compile(expression(pattern)) for pattern in one.clauses)
