"""The numeric settings of a study."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from robbdd_tools.syntax.study_content import MOST_BATCH, MOST_REPETITIONS, MOST_SECONDS, MOST_SEED


class NumberRange(NamedTuple):
    """The permitted values of a setting, including both bounds, and the unit after the number."""

    least: int
    most: int
    is_whole: bool = True
    unit: str = ""


NUMBERS: Mapping[str, NumberRange] = {
    "first": NumberRange(1, MOST_REPETITIONS),
    "sample": NumberRange(1, MOST_REPETITIONS),
    "pairwise": NumberRange(2, 3),
    "repeat": NumberRange(1, MOST_REPETITIONS),
    "seed": NumberRange(0, MOST_SEED),
    "batch": NumberRange(1, MOST_BATCH),
    "timeout": NumberRange(0, MOST_SECONDS, is_whole=False, unit="seconds"),
}
"""Name of a numeric setting → its permitted values."""
