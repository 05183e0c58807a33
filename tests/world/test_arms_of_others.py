"""Arms of other projects pick and place as often as docs/robots.md says; each has its picture there."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from world.arms_of_others import ARMS, FOLDER, Arm, outcome

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "robots.md").read_text(encoding="utf-8")


@pytest.mark.physics
@pytest.mark.nightly
@pytest.mark.filterwarnings("ignore:.*obj_decoder")
@pytest.mark.skipif(not FOLDER.is_dir(), reason="the arms of others are not here: make arms")
@pytest.mark.parametrize("arm", ARMS, ids=lambda arm: arm.name)
def test_an_arm_as_shipped_works_as_often_as_the_page_says(arm: Arm) -> None:
    outcomes = Counter(outcome(arm, seed) for seed in range(1, 11))
    assert outcomes["in the bin"] == arm.works, outcomes


@pytest.mark.parametrize("arm", ARMS, ids=lambda arm: arm.name)
def test_the_page_has_the_picture_and_the_figure_of_each_arm(arm: Arm) -> None:
    row = next(line for line in PAGE.splitlines() if f"images/arms/{arm.name}.png" in line)
    assert f"{arm.works} of 10" in row
    assert (ROOT / "docs" / "images" / "arms" / f"{arm.name}.png").stat().st_size < 40_000
