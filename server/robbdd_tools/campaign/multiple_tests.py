"""Correct the p-values of several tests so that any false alarm among them is as rare as stated."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from itertools import accumulate


@dataclass(frozen=True, slots=True)
class Test:
    """A test.

    - ``probability``: its p-value.
    - ``least``: the smallest p-value that is possible with its number of flips, in any direction. An exact test with
      few flips cannot reject, so it cannot raise a false alarm.
    - ``data``: tests with equal data count as one test.
    """

    probability: float
    least: float = 0.0
    data: Hashable = None

    __test__ = False
    """Not a test of pytest."""


def corrected(tests: Sequence[Test], alpha: float) -> list[float]:
    """Correct p-values for the number of tests, so that the probability of any false alarm is at most ``alpha``.

    Tests that cannot reject are not counted (Tarone 1990); the others are corrected by Holm's method (1979). A test is
    left out by its number of flips, which does not depend on their direction, so this does not raise the level.
    """
    able = _able(tests, alpha)
    order = sorted({tests[index].probability for index in able})
    # Tests of the same data have the same p-value and count once.
    sizes = {
        value: len({_identity(tests, index) for index in able if tests[index].probability == value}) for value in order
    }
    left = sum(sizes.values())
    scaled: list[float] = []
    for value in order:
        scaled.append(min(1.0, value * left))
        left -= sizes[value]
    found = dict(zip(order, accumulate(scaled, max), strict=True))
    return [found[test.probability] if index in able else 1.0 for index, test in enumerate(tests)]


def _able(tests: Sequence[Test], alpha: float) -> frozenset[int]:
    """Return the largest group of tests in which each test could still reject after correction for the group's size."""
    count = 1
    while True:
        able = [index for index, test in enumerate(tests) if test.least <= alpha / count]
        if len({_identity(tests, index) for index in able}) <= count:
            return frozenset(able)
        count += 1


def _identity(tests: Sequence[Test], index: int) -> Hashable:
    data = tests[index].data
    return index if data is None else (data,)
