"""Policies whose verdicts come from users' Python code."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from judging.judged_policies import SENTENCE, STATED, judged, moving, spec_of
from robbdd_tools.judging.decisions import decide
from robbdd_tools.judging.scenario_clauses import judged_clause, stated_by_step
from robbdd_tools.monitor.policy import Rule
from robbdd_tools.monitor.verdict import Cause, Outcome, Verdict
from robbdd_tools.protocol.clauses import Fluent
from world.worlds import CUBE


def by_code(folder: Path, module: str, body: str) -> Verdict:
    (folder / f"{module}.py").write_text(f"import numpy as np\n\n\ndef judge(evidence, arguments):\n    {body}\n")
    return judged(spec_of(Rule("python", f"{module}:judge"), model=str(folder / "m.bddx")), moving([0.2, 0.4]))


@pytest.mark.parametrize(
    ("module", "body", "outcome", "robustness"),
    [
        ("by_margin", "return 0.5 - evidence.position(arguments['thing'])[:, 0]", Outcome.HOLDS, 0.1),
        ("by_truth", "return evidence.position(arguments['thing'])[:, 0] < 0.3", Outcome.VIOLATED, -1.0),
        ("by_one_answer", "return bool(evidence.stamps('env:bin')[0] == 0.0)", Outcome.HOLDS, 1.0),
        ("by_nothing_known", "return np.full(len(evidence.times), np.nan)", Outcome.UNKNOWN, None),
    ],
)
def test_code_of_the_user_judges(
    tmp_path: Path, module: str, body: str, outcome: Outcome, robustness: float | None
) -> None:
    found = by_code(tmp_path, module, body)
    assert found.outcome is outcome
    assert found.robustness == (None if robustness is None else pytest.approx(robustness))


@pytest.mark.parametrize(
    ("module", "body", "reason"),
    [
        ("divides", "return 1 / 0", "divides:judge failed: ZeroDivisionError: division by zero ({}:5)"),
        ("gives_up", "raise SystemExit(3)", "gives_up:judge failed: SystemExit: 3 ({}:5)"),
        ("looks_away", "return evidence.position('env:lamp')", "looks_away:judge failed: KeyError: 'env:lamp' ({}:5)"),
        ("broken", "return (", "broken:judge failed: SyntaxError: '(' was never closed ({}:5)"),
        ("says", "return 'yes'", "says:judge must return one number or truth value, or one for each of the 2 samples"),
    ],
)
def test_a_failure_of_the_users_code_is_reported_as_theirs(tmp_path: Path, module: str, body: str, reason: str) -> None:
    found = by_code(tmp_path, module, body)
    assert (found.outcome, found.reason) == (Outcome.UNKNOWN, reason.format(tmp_path / f"{module}.py"))


def test_code_that_computes_in_place_changes_no_other_verdict(tmp_path: Path) -> None:
    (tmp_path / "in_place.py").write_text(
        "def judge(evidence, arguments):\n"
        "    times, places, stamps = evidence.times, evidence.position('env:bin'), evidence.stamps('env:bin')\n"
        "    times -= 5.0\n    places -= 5.0\n    stamps -= 5.0\n    return times < 0.0\n"
    )
    spec = spec_of(Rule("python", "in_place:judge"), model=str(tmp_path / "m.bddx"))
    trace = moving([0.2, 0.4])
    assert [judged(spec, trace).robustness for _ in range(2)] == [1.0, 1.0]
    assert trace.times.tolist() == [0.0, 0.1]
    assert trace.positions.tolist() == moving([0.2, 0.4]).positions.tolist()


def test_a_module_that_is_not_there_is_explained(tmp_path: Path) -> None:
    spec = spec_of(Rule("python", "no_such_module:judge"), model=str(tmp_path / "m.bddx"))
    found = judged(spec, moving([0.2]))
    assert found.reason == ("no_such_module:judge failed: ModuleNotFoundError: No module named 'no_such_module'")


def test_users_code_gets_what_fills_the_slots_and_quantified_variables_of_its_clause(tmp_path: Path) -> None:
    (tmp_path / "own_arguments.py").write_text(
        "import numpy as np\n\n\ndef judge(evidence, arguments):\n"
        "    assert arguments == {'thing': 'env:bin', 'part': 'env:cube1', 'others': ['a', 'b']}, arguments\n"
        "    return 0.3 - evidence.position(arguments['part'])[:, 0]\n"
    )
    arguments = {"thing": "env:bin", "part": CUBE, "others": ["a", "b"]}
    spec = spec_of(Rule("python", "own_arguments:judge"), targets=("t:part",), model=str(tmp_path / "m.bddx"))
    located = stated_by_step("then", SENTENCE, STATED)
    assert isinstance(located, Fluent)
    clause = judged_clause(replace(located, named=arguments), STATED, spec)
    found = decide(clause, moving([0.2, 0.4]), {}, {"t:a", "t:b"})
    assert (found.outcome, found.robustness, found.reason) == (Outcome.VIOLATED, pytest.approx(-0.1), "")


def test_answers_of_code_that_are_no_margins_are_refused_with_the_place_of_the_function(tmp_path: Path) -> None:
    for module, body, words in (
        ("too_many", "return [1.0, 2.0, 3.0]", "each of the 2 samples"),
        ("infinite", "return [1.0, float('inf')]", "1 are not"),
        ("complex_one", "return 1j", "each of the 2 samples"),
    ):
        found = by_code(tmp_path, module, body)
        assert found.cause is Cause.USER_CODE
        assert words in found.reason
        assert found.fault is not None
        assert found.fault.place is not None
        assert (found.fault.place.line, found.fault.origin) == (4, "x:policy")
    assert by_code(tmp_path, "whole_numbers", "return [1, 2]").robustness == 1.0
    assert by_code(tmp_path, "unsigned", "return np.uint8(3)").robustness == 3.0


def test_code_that_returns_no_numbers_is_named_with_its_place(tmp_path: Path) -> None:
    found = by_code(tmp_path, "by_nan", "return np.full(len(evidence.times), np.nan)")
    assert found.reason == "by_nan:judge must return finite numbers, but 2 are not"
    assert found.fault is not None
    assert found.fault.code == "by_nan:judge"
