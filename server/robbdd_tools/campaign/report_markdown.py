"""The report of a run or a study as a Markdown summary: failures first, then requirements and clauses."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from robbdd_tools.base.printable import printable
from robbdd_tools.campaign.markdown_text import code, details, escaped, html_escaped, markdown_table
from robbdd_tools.campaign.report_data import MOST_SHOWN, clause_rows, counts, factors, failed_rows
from robbdd_tools.campaign.report_factors import confounding_words, effect_rows, flaky_scenarios, repeated
from robbdd_tools.campaign.requirement_rows import requirement_results, requirement_summary
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.report import SIGNS

if TYPE_CHECKING:
    from robbdd_tools.campaign.coverage import KindCoverage
    from robbdd_tools.campaign.report_data import ClauseRow, Counts, Factor, FailedRow
    from robbdd_tools.campaign.report_source import ReportSource
    from robbdd_tools.campaign.requirement_rows import RequirementResult
    from robbdd_tools.workbench.execution_rows import ExecutionResult

MOST_MISSING = 5
"""At most this many things of each kind that were not exercised are listed."""
MOST_CLAUSES = 200
"""At most this many clauses are listed. A summary of GitHub has at most 1 MiB."""
_BADGES = {"holds": "✅", "violated": "❌", "unknown": "❔"}
_NOT_SHOWN = "⚠️"


def report_markdown(source: ReportSource) -> str:
    """Return a summary as Markdown, with tables and parts to open. Raises ``StatisticsNotInstalled``."""
    parts = "\n\n".join(_parts(source))
    return "".join(f"{printable(line)}\n" for line in parts.split("\n"))


def _parts(source: ReportSource) -> Iterator[str]:
    results = source.results
    summary = counts(result.verdict for result in results)
    yield f"## {_badge(summary)} {escaped(source.title)}"
    yield (
        f"**{summary.holds} of {summary.total} executions hold**: {summary.words} · {summary.violated} violated · "
        f"{summary.unknown} unknown"
    )
    if source.state:
        yield f"{_NOT_SHOWN} The run is not complete: {escaped(source.state)}."
    yield from _failed(source, summary)
    yield from _requirements(requirement_results(source.requirements, results))
    yield from _coverage(source.coverage)
    yield from _clauses(clause_rows(results))
    yield from _factors(factors(results), results)
    rows = [(escaped(name), code(value)) for name, value in source.environment]
    yield details("Environment", markdown_table(("", ""), rows))
    yield "<sub>Brackets are 95 % confidence intervals (Wilson). An unknown execution does not count as held.</sub>"


def _badge(summary: Counts) -> str:
    name = "holds" if summary.holds == summary.total else "violated" if summary.violated else "unknown"
    return _BADGES[name]


def _failed(source: ReportSource, summary: Counts) -> Iterator[str]:
    failed = failed_rows(source)
    if not failed:
        return
    yield "### Executions that do not hold"
    rows = [cells for one in failed for cells in _failed_cells(one)]
    yield markdown_table(("", "execution", "clause", "margin", "reason"), rows, numbers=(3,))
    more = summary.violated + summary.unknown - len(failed)
    if more:
        yield f"{more} more do not hold; the {MOST_SHOWN} worst are listed."
    yield details("All clauses of these executions", "\n\n".join(map(_execution, failed)))


def _failed_cells(one: FailedRow) -> Iterator[Sequence[str]]:
    """Yield a row for each clause that does not hold; violated clauses come first."""
    failed = [clause for clause in one.clauses if clause.verdict is not Outcome.HOLDS]
    failed.sort(key=lambda clause: clause.verdict is not Outcome.VIOLATED)
    name = f"{escaped(one.name)}<br><sub>{escaped(one.values)}</sub>" if one.values else escaped(one.name)
    for place, clause in enumerate(failed):
        first = (_BADGES[str(one.verdict)], name) if not place else ("", "")
        named = f"{SIGNS[clause.verdict]} {escaped(clause.name)}"
        yield (*first, named, _unbroken(clause.margin), escaped(clause.reason))
    if not failed:
        yield (_BADGES[str(one.verdict)], name, "", "", "no clause was judged")


def _execution(one: FailedRow) -> str:
    rows = [
        (f"{SIGNS[clause.verdict]} {clause.verdict}", _named(clause.name, clause.sentence), clause.margin)
        for clause in one.clauses
    ]
    again = f": {code(one.command)}" if one.command else ""
    return "\n\n".join(
        (
            f"**{escaped(one.name)}**" + (f" {escaped(one.values)}" if one.values else ""),
            markdown_table(("verdict", "clause", "margin"), rows, numbers=(2,)),
            f"Seed {one.seed}{again}",
        )
    )


def _unbroken(words: str) -> str:
    """Return figures as text that is not broken into lines."""
    return words.replace(" ", "\u00a0")


def _named(name: str, sentence: str) -> str:
    """Return the name of a clause and its sentence. A clause without a name has its sentence instead, in quotes."""
    own = name.strip("'") != sentence
    return f"**{escaped(name)}**<br>{escaped(sentence)}" if own and sentence else f"**{escaped(sentence or name)}**"


def _requirements(found: Sequence[RequirementResult]) -> Iterator[str]:
    if not found:
        return
    yield "### Requirements"
    yield f"{requirement_summary(found)}."
    shown = [one for one in found if one.verdict == "holds"]
    others = [one for one in found if one.verdict != "holds"]
    if others:
        yield _requirement_table(others)
    if shown:
        yield details(f"{len(shown)} shown", _requirement_table(shown))


def _requirement_table(found: Sequence[RequirementResult]) -> str:
    rows = [
        (
            f"{_BADGES.get(one.verdict, _NOT_SHOWN)} {one.verdict}",
            f"**{escaped(one.label)}**<br>{escaped(one.text)}",
            "<br>".join(_scenario(scenario.name, scenario.held, scenario.total) for scenario in one.scenarios),
            "<br>".join(dict.fromkeys(escaped(clause.name) for each in one.scenarios for clause in each.clauses)),
        )
        for one in found
    ]
    return markdown_table(("verdict", "requirement", "scenarios", "clauses"), rows)


def _scenario(name: str, held: int, total: int) -> str:
    return f"{escaped(name)}: {f'{held} of {total} hold' if total else 'not run'}"


def _coverage(found: Sequence[KindCoverage]) -> Iterator[str]:
    """Yield the coverage: open if a goal is not met, closed otherwise."""
    if not found:
        return
    rows = [
        (
            ("" if one.goal is None else _BADGES["holds" if one.is_met else "violated"]),
            one.kind,
            _unbroken(f"{one.exercised:,} of {one.total:,}"),
            _unbroken(f"{one.share:.1f} %"),
            "" if one.goal is None else _unbroken(f"{one.goal:g} %"),
            _missing(one),
        )
        for one in found
    ]
    head = ("", "coverage", "exercised", "share", "goal", "not exercised")
    written = markdown_table(head, rows, numbers=(2, 3, 4))
    unmet = [one.kind for one in found if not one.is_met]
    if unmet:
        yield "### Coverage"
        yield f"Goals not met: {', '.join(unmet)}."
        yield written
    else:
        yield details("Coverage", written)


def _missing(one: KindCoverage) -> str:
    more = len(one.missing) - MOST_MISSING
    listed = [escaped(name) for name in one.missing[:MOST_MISSING]]
    return "<br>".join([*listed, *([f"… and {more:,} more"] if more > 0 else [])])


def _clauses(found: Sequence[ClauseRow]) -> Iterator[str]:
    if not found:
        return
    ordered = sorted(found, key=lambda row: row.counts.holds / max(row.counts.total, 1))[:MOST_CLAUSES]
    rows = [
        (
            "✔" if row.counts.holds == row.counts.total else "✗" if row.counts.violated else "?",
            _named(row.name, row.sentence)
            + (f"<br>{_NOT_SHOWN} proves little: {escaped(row.vacuous)}" if row.vacuous else ""),
            *map(_unbroken, (f"{row.counts.holds} of {row.counts.total}", row.counts.words, row.least, row.middle)),
        )
        for row in ordered
    ]
    head = ("", "clause", "hold", "pass rate", "smallest margin", "median")
    failing = sum(row.counts.holds < row.counts.total for row in found)
    words = f"{len(found)} clauses, {failing} of them not always held" if failing else f"{len(found)} clauses, all held"
    more = f"\n\n{len(found) - MOST_CLAUSES} more clauses are not listed." if len(found) > MOST_CLAUSES else ""
    written = markdown_table(head, rows, numbers=(2, 4, 5)) + more
    if failing:
        yield "### Clauses"
        yield f"{words}."
        yield written
    else:
        yield details(words, written)


def _factors(varied: Sequence[Factor], results: Sequence[ExecutionResult]) -> Iterator[str]:
    if not varied:
        return
    effects = effect_rows(varied, results)
    rows = [
        (
            escaped(row.factor),
            escaped(row.level),
            *map(_unbroken, (f"{row.holding} of {row.total}", row.rate, row.against)),
        )
        for row in effects
    ]
    head = ("factor", "level", "hold", "pass rate", "against the other levels")
    parts = [markdown_table(head, rows, numbers=(2,))] if rows else []
    parts += [f"- {escaped(words)}" for words in confounding_words(varied)]
    if parts:
        names = html_escaped(", ".join(dict.fromkeys(row.factor for row in effects)))
        yield details(f"Factors: {names}" if names else "Factors", "\n\n".join(parts))
    flaky = flaky_scenarios(results) if repeated(results) else []
    if flaky:
        words = f"{len(flaky)} scenario{'s' * (len(flaky) > 1)} hold{'s' * (len(flaky) == 1)} with some seeds only"
        yield details(words, "\n".join(f"- {escaped(one)}" for one in flaky[:MOST_CLAUSES]))
