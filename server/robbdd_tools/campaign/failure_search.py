"""Search a box for a failure with few executions, and move the failure as near to nominal as possible.

Points are in the unit box of the ranges. The search begins with combinations of the ends of the ranges (boundary value
analysis, ISO/IEC/IEEE 29119-4), where physical limits are usually met first. Then generations of CMA-ES (Hansen 2016,
*The CMA Evolution Strategy*), which follow the margins, alternate with quasi-random points, which do not need any. Each
method is also available alone, as are uniform points, for comparison.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain, combinations, islice, zip_longest
from math import dist
from typing import TYPE_CHECKING

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.campaign.rates import StatisticsNotInstalled

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

BOUNDARY, CMA_ES, SOBOL, UNIFORM = "boundary", "cma-es", "sobol", "uniform"
METHODS = (BOUNDARY, CMA_ES, SOBOL, UNIFORM)
SPREAD = 0.3
"""Initial standard deviation of CMA-ES, as a share of each range. The box is about three deviations wide."""
GENERATION = 8
"""Points of a generation of all methods but CMA-ES."""
MOST_SUBSETS = 70
"""Sets of changed variables of one size are tried only if there are at most this many."""
ROUNDS, PARTS = 3, 8
"""In each round, the way from nominal to the failure is divided into parts. The part with the first failure remains."""

Point = tuple[float, ...]


class SearchNotInstalled(RobbddError):
    """The optimiser is not installed."""

    def __init__(self) -> None:
        super().__init__("the optimiser is not installed: pip install 'robbdd-tools[search]'")


@dataclass(frozen=True, slots=True)
class Evaluation:
    """The executions at a point: their smallest robustness, and whether a clause is violated in one of them."""

    point: Point
    robustness: float
    fails: bool


@dataclass(frozen=True, slots=True)
class Failure:
    """The result of a search.

    - ``first``: the first failure that was found, after ``searched`` points. ``None`` if there was none.
    - ``nearest``: a failure with the fewest changed variables, as near to nominal as was found.
    - ``passing``: the point closest to ``nearest``, on the way from nominal to it, that does not fail.
    - ``evaluated``: the number of all evaluated points.
    """

    first: Evaluation | None
    nearest: Evaluation | None
    passing: Point
    searched: int
    evaluated: int


Evaluate = Callable[[Sequence[Point]], Sequence[Evaluation]]


def find_failure(evaluate: Evaluate, nominal: Point, *, budget: int, seed: int = 1, method: str = BOUNDARY) -> Failure:
    """Search for a failure with at most ``budget`` points, then shrink the failure with further points.

    The same seed gives the same points. Raises ``SearchNotInstalled`` and ``StatisticsNotInstalled``.
    """
    found = first_failure(evaluate, nominal, budget=budget, seed=seed, method=method)
    return found if found.first is None else shrink(evaluate, nominal, found)


def first_failure(evaluate: Evaluate, nominal: Point, *, budget: int, seed: int = 1, method: str = BOUNDARY) -> Failure:
    """Search for a failure with at most ``budget`` points, and leave it as it is found."""
    searched = 0
    for generation in _generations(evaluate, nominal, budget, seed, method):
        for number, one in enumerate(generation, start=1):
            if one.fails:
                return Failure(one, one, nominal, searched + number, searched + len(generation))
        searched += len(generation)
    return Failure(None, None, nominal, searched, searched)


def shrink(evaluate: Evaluate, nominal: Point, failure: Failure) -> Failure:
    """Return a failure with fewer changed variables, nearer to nominal."""
    assert failure.first is not None
    best, evaluated = failure.first, failure.evaluated
    for points in _subsets(nominal, failure.first.point):
        tried = evaluate(points)
        evaluated += len(points)
        failing = [one for one in tried if one.fails]
        if failing:
            best = min(failing, key=lambda one: dist(one.point, nominal))
            break
    low, high = 0.0, 1.0
    end = best.point
    for _ in range(ROUNDS):
        shares = [low + (high - low) * part / PARTS for part in range(1, PARTS)]
        tried = evaluate([between(nominal, end, share) for share in shares])
        evaluated += len(tried)
        first = next((index for index, one in enumerate(tried) if one.fails), None)
        if first is None:
            low = shares[-1]
            continue
        best = tried[first]
        high = shares[first]
        low = shares[first - 1] if first else low
    return replace(failure, nearest=best, passing=between(nominal, end, low), evaluated=evaluated)


def _subsets(nominal: Point, failing: Point) -> Iterator[list[Point]]:
    """Yield groups of points in which only some variables have their failing values, the smallest sets first."""
    changed = [index for index, value in enumerate(failing) if value != nominal[index]]
    for size in range(1, len(changed)):
        kept = list(combinations(changed, size))
        if len(kept) <= MOST_SUBSETS:
            yield [tuple(failing[i] if i in some else value for i, value in enumerate(nominal)) for some in kept]


def between(nominal: Point, failing: Point, share: float) -> Point:
    """Return the point after a share of the way from one point to another one."""
    return tuple(one + share * (other - one) for one, other in zip(nominal, failing, strict=True))


def _generations(
    evaluate: Evaluate, nominal: Point, budget: int, seed: int, method: str
) -> Iterator[Sequence[Evaluation]]:
    """Yield evaluated points, until the budget is used."""
    if method == BOUNDARY:
        corners = list(islice(_corners(nominal, seed), budget // 2))
        rest = budget - len(corners)
        both = _evolved(evaluate, nominal, rest // 2, seed), _listed(evaluate, _sobol(nominal, rest - rest // 2, seed))
        yield from _listed(evaluate, corners)
        yield from (one for one in chain.from_iterable(zip_longest(*both)) if one is not None)
    elif method == CMA_ES:
        yield from _evolved(evaluate, nominal, budget, seed)
    elif method == SOBOL:
        yield from _listed(evaluate, _sobol(nominal, budget, seed))
    else:
        yield from _listed(evaluate, _uniform(nominal, budget, seed))


def _listed(evaluate: Evaluate, points: Iterable[Point]) -> Iterator[Sequence[Evaluation]]:
    """Yield evaluated points that do not depend on earlier ones."""
    rest = iter(points)
    while chosen := list(islice(rest, GENERATION)):
        yield evaluate(chosen)


def _corners(nominal: Point, seed: int) -> Iterator[Point]:
    """Yield the corners of the box but nominal, each once, in random order."""
    import numpy as np

    random = np.random.default_rng(seed)
    known = {nominal}
    left = 2 ** len(nominal) - all(value in (0.0, 1.0) for value in nominal)
    while left > 0:
        corner = tuple(map(float, random.integers(0, 2, len(nominal))))
        if corner not in known:
            known.add(corner)
            left -= 1
            yield corner


def _sobol(nominal: Point, number: int, seed: int) -> Sequence[Point]:
    import numpy as np

    try:
        from scipy.stats import qmc
    except ImportError as error:
        raise StatisticsNotInstalled from error
    sampler = qmc.Sobol(len(nominal), seed=np.random.default_rng(seed))
    return _points(sampler.random_base2(max(1, (number - 1).bit_length()))[:number])


def _uniform(nominal: Point, number: int, seed: int) -> Sequence[Point]:
    import numpy as np

    return _points(np.random.default_rng(seed).random((number, len(nominal))))


def _points(rows: FloatArray) -> Sequence[Point]:
    return [tuple(map(float, row)) for row in rows]


def _evolved(evaluate: Evaluate, nominal: Point, budget: int, seed: int) -> Iterator[Sequence[Evaluation]]:
    import numpy as np

    try:
        from cmaes import CMA  # pyright: ignore[reportMissingTypeStubs] -- cmaes ships types without a marker
    except ImportError as error:
        raise SearchNotInstalled from error
    dimensions = len(nominal)
    # CMA-ES needs two dimensions; a second one without effect does no harm.
    mean = np.array([*nominal, 0.5][: max(2, dimensions)])
    bounds = np.array([[0.0, 1.0]] * len(mean))
    search = CMA(mean=mean, sigma=SPREAD, bounds=bounds, seed=seed % 2**32)
    used = 0
    while used < budget:
        asked = [search.ask() for _ in range(min(search.population_size, budget - used))]
        found = evaluate([tuple(map(float, point[:dimensions])) for point in asked])
        used += len(found)
        yield found
        if len(asked) < search.population_size:
            return
        search.tell([(point, one.robustness) for point, one in zip(asked, found, strict=True)])
        if search.should_stop():
            # A local minimum without a failure: begin again elsewhere.
            start = np.random.default_rng((seed, used)).random(len(mean))
            search = CMA(mean=start, sigma=SPREAD, bounds=bounds, seed=(seed + used) % 2**32)
