"""``python -m tests.bench.falsification [METHOD]...``: executions up to the first failure, on rare failures.

Each problem is searched with ``SEEDS`` seeds, at most ``BUDGET`` points each, one execution at a point. ``uniform``
executes all its points, because they also give the failure rate. Results are added to ``recorded.csv``; a search that
is recorded there is not repeated. The tables and the plot for ``docs/falsify.md`` are written from this file alone.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Iterator
from dataclasses import astuple, fields, replace
from itertools import product
from pathlib import Path
from unittest.mock import patch

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2]))

from bench.falsification.summary import PLOT, Search, draw, tables
from fork_kit import INTERPRETERS, fork_server
from robbdd_tools.campaign.failure_search import METHODS, UNIFORM, first_failure
from robbdd_tools.campaign.point_runs import PointRuns
from robbdd_tools.campaign.study_file import Study, load_study
from robbdd_tools.run.run_policy import Policy

HERE = Path(__file__).parent
RECORDED = HERE / "recorded.csv"
PROBLEMS = ("rim", "grip", "reach", "belt", "over")
SEEDS, BUDGET = 20, 40


def searched(study: Study, problem: str, method: str, seed: int) -> Search:
    """Search one problem with one seed, which also gives the seed of the executions, as ``robbdd falsify`` does."""
    runs = PointRuns(study, replace(Policy.of(jobs=1), timeout=study.timeout), 1, seed)
    nominal = (0.5,) * len(study.content.ranges)
    (first,) = runs.evaluate([nominal])
    if first.fails:
        raise SystemExit(f"{problem}: the nominal values fail with seed {seed}")
    if method != UNIFORM:
        found = first_failure(runs.evaluate, nominal, budget=BUDGET, seed=seed, method=method)
        failed = found.first is not None
        return Search(problem, method, seed, found.searched, int(failed), found.evaluated, runs.unknown)
    points = np.random.default_rng(seed).random((BUDGET, len(nominal)))
    fails = [one.fails for one in runs.evaluate([tuple(map(float, row)) for row in points])]
    first_at = fails.index(True) + 1 if any(fails) else BUDGET
    return Search(problem, method, seed, first_at, sum(fails), BUDGET, runs.unknown)


def recorded() -> Iterator[Search]:
    """Yield the searches in the file."""
    if RECORDED.is_file():
        with RECORDED.open(encoding="utf-8", newline="") as file:
            for problem, method, *numbers in list(csv.reader(file))[1:]:
                yield Search(problem, method, *map(int, numbers))


def main(methods: tuple[str, ...]) -> None:
    """Search what is not recorded yet, then print the tables and draw the plot."""
    found = list(recorded())
    known = {(one.problem, one.method, one.seed) for one in found}
    # Agents are forks, since starting one takes longer than an execution.
    with fork_server(), patch(*INTERPRETERS):
        studies = {problem: load_study(HERE / problem / f"{problem}.study") for problem in PROBLEMS}
        for seed, problem, method in product(range(1, SEEDS + 1), PROBLEMS, methods):
            if (problem, method, seed) not in known:
                found.append(searched(studies[problem], problem, method, seed))
                print(found[-1], flush=True)
                write(found)
    print(tables(found, BUDGET))
    draw(found, BUDGET, PLOT)


def write(found: list[Search]) -> None:
    """Write all searches, in the order of problems, methods and seeds."""
    order = sorted(found, key=lambda one: (PROBLEMS.index(one.problem), METHODS.index(one.method), one.seed))
    with RECORDED.open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(field.name for field in fields(Search))
        rows.writerows(astuple(one) for one in order)


if __name__ == "__main__":
    main(tuple(sys.argv[1:]) or (UNIFORM, *(one for one in METHODS if one != UNIFORM)))
