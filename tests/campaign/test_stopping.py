"""Rules that end a study early: how often they decide wrongly, and how many executions they save."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from campaign.study_agents import QuickAgent, write_study
from robbdd_tools.campaign.rates import rate_interval
from robbdd_tools.campaign.stopping import RatioTest, Ruling, UntilWidth
from robbdd_tools.campaign.study_progress import StudyProgress
from robbdd_tools.campaign.study_run import StudyRun
from robbdd_tools.cli import main
from robbdd_tools.run import scheduler

STUDIES = 2000
STAGE = 10
"""Executions between two decisions."""
RULE = RatioTest(0.95, 0.90)


def simulated(
    rule: RatioTest | UntilWidth, rate: float, seed: int, studies: int = STUDIES
) -> list[tuple[Ruling, int, int]]:
    """Return the decisions of studies with a true pass rate, with the executions that hold and all executions."""
    random = np.random.default_rng(seed)
    found: list[tuple[Ruling, int, int]] = []
    for _ in range(studies):
        holding = total = 0
        while (ruling := rule.ruling(holding, total)) is None:
            holding += int(random.binomial(STAGE, rate))
            total += STAGE
        found.append((ruling, holding, total))
    return found


def test_wrong_decisions_are_at_most_as_frequent_as_stated() -> None:
    # 2,000 studies with an error of 5 % have more than 6.2 % errors once in 150 times.
    for rate, wrong in ((RULE.refused, Ruling.SHOWN), (RULE.required, Ruling.REFUTED)):
        counted = Counter(ruling for ruling, _, _ in simulated(RULE, rate, 1))
        assert 0 < counted[wrong] <= 0.062 * STUDIES, (rate, counted)


def test_the_ratio_test_needs_fewer_executions_than_a_fixed_number() -> None:
    # A test of fixed size with both errors 5 % needs 291 executions for 0.95 against 0.90 (normal approximation).
    sizes = [total for _, _, total in simulated(RULE, 0.95, 2)]
    assert np.mean(sizes) < 0.75 * 291


def test_the_interval_at_the_end_covers_the_true_rate() -> None:
    ends = simulated(UntilWidth(0.1), 0.8, 3, 300)
    intervals = [rate_interval(holding, total) for _, holding, total in ends]
    assert all(one.high - one.low <= 0.1 for one in intervals)
    assert sum(one.low <= 0.8 <= one.high for one in intervals) >= 0.93 * len(intervals)


def test_nothing_is_decided_without_executions() -> None:
    assert RULE.ruling(0, 0) is None
    assert UntilWidth(0.5).ruling(0, 0) is None
    assert RULE.ruling(0, 3) is None
    assert RULE.ruling(0, 5) is Ruling.REFUTED
    assert RULE.ruling(54, 54) is None
    assert RULE.ruling(55, 55) is Ruling.SHOWN


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(scheduler, "Agent", QuickAgent)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    ("rule", "code", "executed", "words"),
    [
        ("rate 0.5 against 0.2", 0, 8, "a pass rate of 50 % against 20 % is shown (errors at most 5 %)"),
        ("rate 0.9 against 0.8", 3, 40, "a pass rate of 90 % against 80 % is neither shown nor refuted"),
        ("width 0.4", 0, 8, "stopped early: the interval is at most 40 points wide"),
        ("width 0.01", 1, 40, "the interval is still wider than 1 points"),
    ],
)
def test_a_study_stops_at_the_end_of_a_stage(
    folder: Path, capsys: pytest.CaptureFixture[str], rule: str, code: int, executed: int, words: str
) -> None:
    text = f'import "m.bdd" Study s {{ repeat: 10 batch: 8 seed: 3 stop: {rule} }}'
    write_study(folder, text)
    assert main(["study", "run", "x.study"]) == code
    printed = capsys.readouterr().out
    assert printed.splitlines()[0].startswith("all executions: ")
    assert f" of {executed} hold" in printed.splitlines()[0]
    assert words in printed.splitlines()[-1]
    # A stopped study stays stopped.
    assert main(["study", "resume", "x.study"]) == code
    assert capsys.readouterr().out == printed


@pytest.mark.parametrize(
    ("rule", "message"),
    [
        ("soon", "a study stops at 'width 0.05' or 'rate 0.95 against 0.9'"),
        ("width 5", "expected a number between 0 and 1, not 5"),
        ("rate 0.9 against 0.95", "the rate after 'against' has to be below 0.9"),
        ("rate 0.9", "expected 'against', not '}'"),
    ],
)
def test_a_rule_that_cannot_be_used_is_reported(folder: Path, rule: str, message: str) -> None:
    from robbdd_tools.campaign.study_file import load_study

    (found,) = load_study(write_study(folder, f'import "m.bdd" Study s {{ stop: {rule} }}')).findings
    assert found.message == message


def test_a_study_that_is_interrupted_does_not_decide(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    write_study(folder, 'import "m.bdd" Study s { repeat: 10 batch: 8 seed: 3 stop: rate 0.99 against 0.98 }')
    whole = StudyRun.progress

    def interrupted(self: StudyRun) -> Iterator[StudyProgress]:
        self.cancel("the study was interrupted")
        return whole(self)

    monkeypatch.setattr(StudyRun, "progress", interrupted)
    assert main(["study", "run", "x.study"]) == 2
    assert "sequential test" not in capsys.readouterr().out
