"""Tables and a plot of recorded searches. A search without a failure is censored at the budget."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from robbdd_tools.campaign.rates import rate_interval

COLOURS = {"uniform": "#d29922", "sobol": "#2ea043", "cma-es": "#3f8fd6", "boundary": "#a371f7"}
"""Methods in the order of the tables, with their colours in the plot."""
PLOT = Path(__file__).parents[3] / "docs/images/falsification.svg"


@dataclass(frozen=True, slots=True)
class Search:
    """One search: ``points`` up to the first failure (or the budget), ``failures`` found, ``evaluated`` points."""

    problem: str
    method: str
    seed: int
    points: int
    failures: int
    evaluated: int
    unknown: int


def tables(found: Sequence[Search], budget: int) -> str:
    """Return the tables of failure rates and of executions to the first failure, in Markdown."""
    return "\n".join((*_rates(found), "", *_firsts(found, budget)))


def _rates(found: Sequence[Search]) -> Iterator[str]:
    yield "| problem | executions | failures | rate | 95 % interval |"
    yield "|---|---|---|---|---|"
    for problem in dict.fromkeys(one.problem for one in found):
        own = [one for one in found if (one.problem, one.method) == (problem, "uniform")]
        failures, total = sum(one.failures for one in own), sum(one.evaluated for one in own)
        if total:
            bounds = rate_interval(failures, total, exact=True)
            shown = f"{100 * bounds.low:.1f} % to {100 * bounds.high:.1f} %"
            yield f"| {problem} | {total:,} | {failures} | {100 * failures / total:.1f} % | {shown} |"


def _firsts(found: Sequence[Search], budget: int) -> Iterator[str]:
    yield "| problem | method | searches with a failure | median | restricted mean | share of uniform's |"
    yield "|---|---|---|---|---|---|"
    for problem in dict.fromkeys(one.problem for one in found):
        base = _points(found, problem, "uniform")
        for method in COLOURS:
            own = _points(found, problem, method)
            if own:
                hits = sum(one.failures > 0 for one in found if (one.problem, one.method) == (problem, method))
                middle = f"{median(own):g}" if 2 * hits > len(own) else f"> {budget}"
                share = "1" if method == "uniform" else _shown(_share, own, base, digits=2)
                mean = _shown(_mean, own, digits=1)
                yield f"| {problem} | `{method}` | {hits} of {len(own)} | {middle} | {mean} | {share} |"


def _shown(statistic: Any, *samples: Sequence[int], digits: int) -> str:
    """Return a statistic with its interval in brackets, if the samples have a spread."""
    value = f"{statistic(*map(np.array, samples)):.{digits}f}"
    if all(len(set(one)) == 1 for one in samples):
        return value
    low, high = _interval(statistic, *samples)
    return f"{value} [{low:.{digits}f}, {high:.{digits}f}]"


def _points(found: Sequence[Search], problem: str, method: str) -> list[int]:
    """Return the executions of each search, in the order of seeds; those without a failure count as the budget."""
    own = [one for one in found if (one.problem, one.method) == (problem, method)]
    return [one.points for one in sorted(own, key=lambda one: one.seed)]


def _mean(values: Any, axis: int = -1) -> Any:
    return np.mean(values, axis=axis)


def _share(one: Any, other: Any, axis: int = -1) -> Any:
    return np.mean(one, axis=axis) / np.mean(other, axis=axis)


def _interval(statistic: Any, *samples: Sequence[int]) -> tuple[float, float]:
    """Return a bootstrap interval; several samples are resampled independently, as their points are."""
    stats: Any = import_module("scipy.stats")
    chance = np.random.default_rng(1)
    found = stats.bootstrap(samples, statistic, n_resamples=9999, method="percentile", rng=chance)
    return float(found.confidence_interval.low), float(found.confidence_interval.high)


def draw(found: Sequence[Search], budget: int, path: Path) -> None:
    """Draw the share of searches that have found a failure, over the executions made."""
    pyplot: Any = import_module("matplotlib.pyplot")
    import_module("matplotlib").rcParams["svg.hashsalt"] = "robbdd"
    problems = list(dict.fromkeys(one.problem for one in found))
    figure, axes = pyplot.subplots(1, len(problems), figsize=(11.0, 3.0), sharey=True, squeeze=False)
    for axis, problem in zip(axes[0], problems, strict=True):
        for method, colour in COLOURS.items():
            own = [one for one in found if (one.problem, one.method) == (problem, method)]
            hits = sorted(one.points for one in own if one.failures)
            shares = [100.0 * number / max(1, len(own)) for number in range(len(hits) + 1)]
            if own:
                axis.step([0, *hits, budget], [*shares, shares[-1]], where="post", color=colour, label=method)
        axis.set(title=problem, xlabel="executions", xlim=(0, budget), ylim=(0, 100))
        axis.spines[["top", "right"]].set_visible(False)
    axes[0][0].set_ylabel("searches with a failure (%)")
    axes[0][-1].legend(frameon=False)
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})
