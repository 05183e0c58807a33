"""Reports of truth values: how long each of them counts."""

from __future__ import annotations

import numpy as np
import pytest

from robbdd_tools.logs.log_contents import Truths


@pytest.mark.parametrize(
    ("times", "asked", "known"),
    [
        (np.arange(100) / 50, 2.4, True),
        (np.arange(100) / 50, 2.6, False),  # a topic of 50 Hz has ended at 1.98 s
        (np.array([*np.arange(50) / 50, *(2.0 + np.arange(50) / 50)]), 1.6, False),  # or was interrupted
        (np.array([0.0, 0.1, 0.2, 1.5]), 9.0, True),  # changes only
        (np.arange(20) / 50, 9.0, True),
        (np.arange(100) * 2.0, 9.0, True),
    ],
    ids=["just reported", "ended", "interrupted", "changes", "too few", "slow"],
)
def test_a_report_of_a_regular_topic_counts_until_the_next_one_is_overdue(
    times: np.ndarray, asked: float, known: bool
) -> None:
    truths = Truths(times, np.ones(len(times)))
    assert truths.at(np.array([asked]), 0.5)[0] == pytest.approx(1.0 if known else np.nan, nan_ok=True)
    assert np.isnan(truths.at(np.array([times[0] - 0.1]), 0.5)[0])
