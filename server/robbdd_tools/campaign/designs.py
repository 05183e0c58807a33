"""Experimental designs: the points of a box at which a study executes its scenarios."""

from __future__ import annotations

from collections.abc import Sequence
from math import floor, log10
from typing import TYPE_CHECKING

from robbdd_tools.campaign.rates import StatisticsNotInstalled
from robbdd_tools.syntax.study_content import GRID, SOBOL
from robbdd_tools.workbench.points import Points

if TYPE_CHECKING:
    from robbdd_tools.syntax.study_content import Design, Range

DIGITS = 6
"""Decimal places of a value, relative to the width of its range. Values appear in features and tables."""


def design_points(design: Design, ranges: Sequence[Range], seed: int) -> Points:
    """Return the points of a design. The same design, ranges and seed give the same points.

    - ``grid``: all combinations of ``size`` levels of each range, bounds included.
    - ``latin-hypercube``: each of ``size`` equal parts of each range has one point (McKay et al. 1979).
    - ``sobol``: the first ``size`` points of the scrambled Sobol sequence (Owen 1998; directions of Joe and Kuo 2008).

    Raises ``StatisticsNotInstalled`` for the last two if SciPy is missing.
    """
    names, units = tuple(one.variable.text for one in ranges), tuple(one.unit for one in ranges)
    if design.kind == GRID:
        shares = [number / (design.size - 1) for number in range(design.size)]
        levels = tuple(tuple(value_at(one, share) for share in shares) for one in ranges)
        return Points(names, levels=levels, units=units)
    unit = _unit_points(design, len(ranges), seed)
    return Points(names, tuple(tuple(map(value_at, ranges, row)) for row in unit), units=units)


def _unit_points(design: Design, dimensions: int, seed: int) -> Sequence[Sequence[float]]:
    try:
        import numpy as np
        from scipy.stats import qmc
    except ImportError as error:
        raise StatisticsNotInstalled from error
    dice = np.random.default_rng(seed)
    # SciPy 1.15 renamed the argument to ``rng`` and still accepts this name.
    kind = qmc.Sobol if design.kind == SOBOL else qmc.LatinHypercube
    return kind(dimensions, seed=dice).random(design.size).tolist()


def value_at(one: Range, share: float) -> float:
    """Return the value at a share of a range, rounded to meaningful digits."""
    width = one.high - one.low
    value = round(one.low + share * width, DIGITS - floor(log10(width)))
    return min(max(value, one.low), one.high)
