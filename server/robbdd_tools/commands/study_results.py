"""``robbdd study outcomes`` and ``robbdd study margins``: print and draw the outcomes of the executions of a study."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.printable import printable
from robbdd_tools.campaign.study_outcomes import margins, outcome_table
from robbdd_tools.campaign.study_place import open_results, study_folder
from robbdd_tools.campaign.study_plots import FORMATS, draw_margins, draw_outcomes
from robbdd_tools.commands import OK
from robbdd_tools.commands.output import fail, print_line
from robbdd_tools.run.report import margin

if TYPE_CHECKING:
    from robbdd_tools.campaign.study_outcomes import Margins, OutcomeTable, Row

QUANTILES = (0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0)


def print_outcomes(path: Path, store: Path | None, by: Sequence[str], plot: Path | None) -> int:
    """Print the counts of outcomes by the levels of factors, and draw them if asked to; return the exit code."""

    def show(rows: Iterable[Row]) -> None:
        table = outcome_table(rows, by)
        _print(_lines(table))
        if plot is not None:
            draw_outcomes(table, plot)

    return _shown(path, store, plot, show)


def print_margins(path: Path, store: Path | None, clause: str, by: str, plot: Path | None) -> int:
    """Print quantiles of a clause's margins by the levels of a factor, and draw them if asked to."""

    def show(rows: Iterable[Row]) -> None:
        found = margins(rows, clause, by)
        _print(_quantiles(found))
        if plot is not None:
            draw_margins(found, plot)

    return _shown(path, store, plot, show)


def _shown(path: Path, store: Path | None, plot: Path | None, show: Callable[[Iterable[Row]], None]) -> int:
    if plot is not None and plot.suffix not in FORMATS:
        return fail(f"'{plot}' must end in one of {', '.join(FORMATS)}")
    try:
        with open_results(study_folder(path, store)) as results:
            show(results.rows())
    except RobbddError as error:
        return fail(str(error))
    except OSError as error:
        return fail(f"{error.filename}: {error.strerror or error}" if error.filename else str(error))
    return OK


def _lines(table: OutcomeTable) -> list[tuple[str, ...]]:
    heading = (*table.factors, *table.outcomes)
    return [heading, *((*row, *map(str, counts)) for row, counts in zip(table.rows, table.counts, strict=True))]


def _quantiles(found: Margins) -> list[tuple[str, ...]]:
    lines: list[tuple[str, ...]] = [(found.factor, "executions", *(f"{100 * share:g} %" for share in QUANTILES))]
    for level, values in found.levels.items():
        ordered = sorted(values)
        shown = (margin(ordered[round(share * (len(ordered) - 1))], found.unit) for share in QUANTILES)
        lines.append((level, str(len(ordered)), *shown))
    return lines


def _print(lines: Sequence[tuple[str, ...]]) -> None:
    widths = [max(len(line[column]) for line in lines) for column in range(len(lines[0]))]
    for line in lines:
        words = (word.ljust(width) for word, width in zip(line, widths, strict=True))
        print_line(printable("  ".join(words).rstrip()))
