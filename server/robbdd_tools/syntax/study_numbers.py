"""The settings of a study that are numbers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from robbdd_tools.syntax.study_content import MOST_BATCH, MOST_REPETITIONS, MOST_SECONDS, MOST_SEED


class NumberRange(NamedTuple):
    """The permitted values of a setting, bounds included, and the unit that follows."""

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
"""Settings of a study with a number, by their names."""
