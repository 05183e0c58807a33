"""``robbdd falsify``: search the ranges of a study for a failure near to nominal."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.printable import printable, printable_json
from robbdd_tools.base.processes import end_requests
from robbdd_tools.base.writing import replace_file
from robbdd_tools.campaign.failure_search import BOUNDARY, Failure, between, find_failure
from robbdd_tools.campaign.point_runs import PointRuns, SearchEnded, fails
from robbdd_tools.campaign.study_file import load_study
from robbdd_tools.commands import FAILED, FINDINGS, OK, signal_code
from robbdd_tools.commands.execute import INTERRUPTED
from robbdd_tools.commands.models import print_findings
from robbdd_tools.commands.output import fail, print_line, print_note
from robbdd_tools.run.readable import clause_title
from robbdd_tools.run.report import failure_words
from robbdd_tools.run.run_policy import Policy

if TYPE_CHECKING:
    from robbdd_tools.campaign.failure_search import Point
    from robbdd_tools.campaign.study_file import Study
    from robbdd_tools.run.results import ScenarioResult

PAUSE = 5.0
"""Seconds between two lines of progress."""
FRESH, FRESH_SEED = 10, 1_000_003
"""The failure is repeated this many times, with seeds that follow from ``FRESH_SEED``, to see how often it occurs."""
HALVINGS = 4
"""The way from the nearest failure to one that occurs with all seeds is halved this often."""
MOST_SHOWN = 5


@dataclass(frozen=True, slots=True)
class FalsifyOptions:
    """The options of ``robbdd falsify``.

    ``nominal`` maps variables to the values at which the search begins; by default, the middle of their range.
    """

    path: Path
    budget: int = 200
    method: str = BOUNDARY
    seed: int | None = None
    nominal: Mapping[str, float] | None = None
    jobs: int | None = None
    json: Path | None = None


def falsify(options: FalsifyOptions) -> int:
    """Search and print the failure. Returns 0 if none was found, 1 if one was found, 2 if the search is impossible."""
    try:
        study = load_study(options.path)
        errors = [one for one in study.findings if one.is_error]
        print_findings(errors, print_note)
        if errors:
            return FAILED
        if not study.content.ranges:
            return fail(f"{options.path} has no range to search: write 'factor var <NAME>: from 0.1 to 0.5'")
        return _search(study, options)
    except RobbddError as error:
        return fail(str(error))
    except OSError as error:
        return fail(f"{error.filename}: {error.strerror or error}" if error.filename else str(error))


def _search(study: Study, options: FalsifyOptions) -> int:
    nominal = _nominal(study, options.nominal or {})
    seed = options.seed if options.seed is not None else study.content.whole("seed") or 1
    runs = PointRuns(study, replace(Policy.of(jobs=options.jobs), timeout=study.timeout), study.repeat or 1, seed)
    runs.on_progress = _Notes()
    ended_by = 0

    def cancel(number: int) -> None:
        nonlocal ended_by
        ended_by = number
        runs.cancel(INTERRUPTED)

    try:
        with end_requests(cancel):
            (first,) = runs.evaluate([nominal])
            if runs.unknown == runs.executions:
                return fail(f"no execution can be judged at the nominal values: {runs.reason}")
            if first.fails:
                _, group = runs.failing(nominal, seed)
                print_line("the nominal values fail already:")
                _print_failures(group)
                return FINDINGS
            found = find_failure(runs.evaluate, nominal, budget=options.budget, seed=seed, method=options.method)
            return _report(study, runs, nominal, found, options)
    except SearchEnded as error:
        print_note(f"robbdd: {error}")
        return signal_code(ended_by) if ended_by else FAILED


def _report(study: Study, runs: PointRuns, nominal: Point, found: Failure, options: FalsifyOptions) -> int:
    if found.first is None or found.nearest is None:
        counted = "1 point" if found.searched == 1 else f"{found.searched} points"
        print_line(f"no failure at {counted} ({runs.executions} executions); this proves nothing beyond them")
        _print_unknown(runs)
        return OK
    counted = "1 point" if found.searched == 1 else f"{found.searched} points"
    print_line(f"a failure after {counted}; with its reduction, {runs.executions} executions")
    print_line("")
    for line in _rows(study, runs, nominal, found):
        print_line(printable(line))
    print_line("")
    _, group = runs.failing(found.nearest.point, runs.seed)
    _print_failures(group)
    again = replace(runs, repeat=FRESH)
    often, fresh = again.failing(found.nearest.point, FRESH_SEED)
    farther, others = again.failing(found.first.point, FRESH_SEED)
    at_nearest = f"with other seeds, {often} of {len(fresh)} executions fail there"
    print_line(f"{at_nearest}, and {farther} of {len(others)} at the first failure")
    sure = found.nearest.point if often == len(fresh) else _sure_failure(again, nominal, found)
    kept, with_seeds = sure or found.nearest.point, "" if sure else ", with which not all executions fail"
    if sure not in (None, found.nearest.point):
        print_line(f"all {len(fresh)} fail at the values below: for any seed, the boundary is between both")
    print_line("")
    print_line(f"to keep it as a scenario, give the variables of the variation these values{with_seeds}:")
    written, usual = runs.written(kept, fresh), runs.written(nominal, fresh)
    for one, value, base in zip(study.content.ranges, written, usual, strict=True):
        print_line(
            printable(f"    var <{one.variable.text}>: {{ {value} }}{'' if value != base else '  // as nominal'}")
        )
    _print_unknown(runs)
    if options.json is not None:
        document = _document(study, runs, nominal, found, (often, len(fresh)), sure)
        replace_file(options.json, f"{printable_json(document, indent=2)}\n")
    return FINDINGS


def _rows(study: Study, runs: PointRuns, nominal: Point, found: Failure) -> Iterator[str]:
    """Yield a table of the points, one line for each variable."""
    assert found.first is not None
    assert found.nearest is not None
    points = (nominal, found.passing, found.nearest.point, found.first.point)
    columns = [runs.values(point) for point in points]
    rows: list[tuple[str, ...]] = [("", "nominal", "still holds", "nearest failure", "first failure")]
    for index, one in enumerate(study.content.ranges):
        shown = [f"{column[index]:g} {one.unit}".rstrip() for column in columns]
        shown = [shown[0], *(word if word != shown[0] else "=" for word in shown[1:])]
        rows.append((one.variable.text, *shown))
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    for row in rows:
        yield "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()


def _sure_failure(again: PointRuns, nominal: Point, found: Failure) -> Point | None:
    """Return a point near to the nearest failure at which executions with all other seeds fail, ``None`` if unknown.

    It is on the way from the nearest failure to the first one, along the variables that matter.
    """
    assert found.first is not None
    assert found.nearest is not None
    near = found.nearest.point
    far = tuple(
        there if here != base else base for here, there, base in zip(near, found.first.point, nominal, strict=True)
    )

    def all_fail(point: Point) -> bool:
        failing, group = again.failing(point, FRESH_SEED)
        return failing == len(group)

    if not all_fail(far):
        return None
    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = (low + high) / 2.0
        low, high = (low, middle) if all_fail(between(near, far, middle)) else (middle, high)
    return between(near, far, high)


def _document(
    study: Study, runs: PointRuns, nominal: Point, found: Failure, fresh: tuple[int, int], sure: Point | None
) -> dict[str, object]:
    assert found.first is not None
    assert found.nearest is not None
    names = [one.variable.text for one in study.content.ranges]

    def values(point: Point) -> dict[str, float]:
        return dict(zip(names, runs.values(point), strict=True))

    return {
        "nominal": values(nominal),
        "passing": values(found.passing),
        "nearest": values(found.nearest.point),
        "first": values(found.first.point),
        "sure": None if sure is None else values(sure),
        "points": found.searched,
        "executions": runs.executions,
        "unknown": runs.unknown,
        "failing_with_other_seeds": {"failing": fresh[0], "total": fresh[1]},
    }


def _print_failures(group: list[ScenarioResult]) -> None:
    for scenario in [one for one in group if fails(one)][:MOST_SHOWN]:
        for clause in scenario.spec.clauses:
            judged = scenario.judged.get(clause.line)
            if judged is not None and judged.verdict == "violated":
                print_line(printable(f"{clause_title(clause)}: {failure_words(judged, clause)} ({scenario.spec.name})"))
                break


def _print_unknown(runs: PointRuns) -> None:
    if runs.unknown:
        print_line(f"{runs.unknown} executions have an unknown verdict; they count as no failure. The first one:")
        print_line(printable(f"    {runs.reason}"))


def _nominal(study: Study, stated: Mapping[str, float]) -> Point:
    """Return the point of the nominal values in the unit box. Raises ``RobbddError``."""
    names = [one.variable.text for one in study.content.ranges]
    for name in stated:
        if name not in names:
            raise RobbddError(f"the study has no range of '{name}'; it has {', '.join(names)}")
    point: list[float] = []
    for one in study.content.ranges:
        value = stated.get(one.variable.text, (one.low + one.high) / 2.0)
        if not one.low <= value <= one.high:
            raise RobbddError(
                f"the nominal value {value:g} of '{one.variable.text}' is not from {one.low:g} to {one.high:g}"
            )
        point.append((value - one.low) / (one.high - one.low))
    return tuple(point)


class _Notes:
    """Prints the number of executions every ``PAUSE`` seconds."""

    def __init__(self) -> None:
        self._shown = monotonic()

    def __call__(self, executions: int) -> None:
        if monotonic() - self._shown >= PAUSE:
            self._shown = monotonic()
            print_note(f"{executions:,} executions")
