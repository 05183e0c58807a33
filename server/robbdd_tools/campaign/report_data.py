"""Plain data of a run's report: counts, clauses, factors and the executions that do not hold."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from statistics import median
from typing import TYPE_CHECKING

from robbdd_tools.campaign.rates import Interval, rate_interval
from robbdd_tools.campaign.value_bins import bins_of, in_order
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.plot import plot
from robbdd_tools.run.readable import title
from robbdd_tools.run.report import contact_words, margin, plain_sentence, value_words

if TYPE_CHECKING:
    from robbdd_tools.campaign.report_moments import Moment
    from robbdd_tools.campaign.report_source import ReportSource
    from robbdd_tools.campaign.value_bins import Bins
    from robbdd_tools.workbench.execution_rows import ClauseResult, ExecutionResult

MOST_SHOWN = 20
"""At most this many executions that do not hold are shown in full."""
MOST_NAMED = 3
"""At most this many clauses are named in the summary."""
MISSING = "—"
"""Shown as the level of an execution that does not have the variable."""
_BADNESS = (Outcome.VIOLATED, Outcome.UNKNOWN, Outcome.HOLDS)


@dataclass(frozen=True, slots=True)
class Counts:
    """Executions by verdict, and the interval of the pass rate; an unknown execution does not pass."""

    holds: int
    violated: int
    unknown: int
    interval: Interval

    @property
    def total(self) -> int:
        """The number of executions."""
        return self.holds + self.violated + self.unknown

    @property
    def words(self) -> str:
        """The pass rate in percent with its interval."""
        if not self.total:
            return "no executions"
        low, high = 100 * self.interval.low, 100 * self.interval.high
        return f"{100 * self.holds / self.total:.1f} % [{low:.1f} %, {high:.1f} %]"


@dataclass(frozen=True, slots=True)
class ClauseRow:
    """A clause over all executions. ``least`` and ``middle`` are the smallest and the median margin in words.

    ``vacuous`` is the reason why the clause could not have failed in any execution; empty if it could.
    """

    name: str
    role: str
    sentence: str
    counts: Counts
    least: str
    middle: str
    vacuous: str


@dataclass(frozen=True, slots=True)
class JudgedRow:
    """A clause of one execution: its verdict, margin and reason in words, and the plot of its margin as SVG.

    The reason of a violation begins with its instant.
    """

    name: str
    sentence: str
    verdict: Outcome
    margin: str
    reason: str
    plot: str


@dataclass(frozen=True, slots=True)
class FailedRow:
    """An execution that does not hold.

    ``command`` simulates it again; empty if there is none. ``contacts`` are contacts that no clause is about.
    """

    name: str
    values: str
    verdict: Outcome
    seed: int
    command: str
    clauses: tuple[JudgedRow, ...]
    moment: Moment | None
    contacts: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Factor:
    """A variable, or the variant, with its levels in words. ``of`` has the number of the level of each execution."""

    name: str
    levels: tuple[str, ...]
    of: tuple[int, ...]


def counts(verdicts: Iterable[Outcome]) -> Counts:
    """Count verdicts. Raises ``StatisticsNotInstalled``."""
    found = Counter(verdicts)
    total = found.total()
    return Counts(
        found[Outcome.HOLDS],
        found[Outcome.VIOLATED],
        found[Outcome.UNKNOWN],
        rate_interval(found[Outcome.HOLDS], total),
    )


def clause_rows(results: Sequence[ExecutionResult]) -> list[ClauseRow]:
    """Return the clauses of a run in the order of judgement."""
    judged: dict[str, list[tuple[ExecutionResult, ClauseResult]]] = {}
    for result in results:
        for clause in result.clauses:
            judged.setdefault(clause.iri, []).append((result, clause))
    return [_clause_row(pairs) for pairs in judged.values()]


def factors(results: Sequence[ExecutionResult]) -> list[Factor]:
    """Return the factors with several levels, in the order of the executions."""
    names = ["variant", *dict.fromkeys(name for result in results for name in result.values)]
    bins = bins_of(result.values for result in results)
    found = (_factor(name, results, bins.get(name)) for name in names)
    return [factor for factor in found if len(factor.levels) > 1]


def worst(results: Iterable[ExecutionResult]) -> list[ExecutionResult]:
    """Return the executions to show in full, worst first: violated before unknown, then the smallest margins."""
    return sorted((one for one in results if one.verdict is not Outcome.HOLDS), key=_rank)[:MOST_SHOWN]


def failed_rows(source: ReportSource) -> list[FailedRow]:
    """Return the worst executions that do not hold."""
    is_repeated = any(result.repetition > 1 for result in source.results)
    return [_failed_row(source, one, is_repeated=is_repeated) for one in worst(source.results)]


def failing_clauses(rows: Iterable[ClauseRow]) -> list[str]:
    """Return the clauses that are violated most often, in words; at most ``MOST_NAMED``."""
    failing = sorted((row for row in rows if row.counts.violated), key=lambda row: -row.counts.violated)
    return [f"{row.name} in {row.counts.violated} of {row.counts.total}" for row in failing[:MOST_NAMED]]


def _clause_row(pairs: Sequence[tuple[ExecutionResult, ClauseResult]]) -> ClauseRow:
    first = pairs[0][1]
    margins = [clause.margin for _, clause in pairs if clause.margin is not None]
    # An unknown verdict has no unit.
    unit = next((clause.unit for _, clause in pairs if clause.unit), "")
    least, middle = (margin(value(margins), unit) if margins else "" for value in (min, median))
    found = counts(clause.verdict for _, clause in pairs)
    sentences = dict.fromkeys(plain_sentence(clause.sentence) for _, clause in pairs)
    sentence = next(iter(sentences)) if len(sentences) == 1 else _with_variables(next(iter(sentences)), pairs[0][0])
    vacuous = first.vacuous if all(clause.vacuous for _, clause in pairs) else ""
    return ClauseRow(title(first.name, first.sentence), first.role, sentence, found, least, middle, vacuous)


def _with_variables(sentence: str, result: ExecutionResult) -> str:
    """Replace the values in a sentence by the names of their variables."""
    for name, value in result.values.items():
        variable, _, words = value_words(name, value).partition(" = ")
        sentence = re.sub(rf"(?<![\w<-]){re.escape(words)}(?![\w>-])", f"<{variable}>", sentence)
    return sentence


def _factor(name: str, results: Sequence[ExecutionResult], bins: Bins | None) -> Factor:
    words = [_level(name, result, bins) for result in results]
    known = in_order(dict.fromkeys(word for word in words if word != MISSING), bins)
    levels = {level: number for number, level in enumerate([*known, *({MISSING} & set(words))])}
    shown = value_words(name, "").removesuffix(" = ")
    return Factor(shown, tuple(levels), tuple(levels[level] for level in words))


def _level(name: str, result: ExecutionResult, bins: Bins | None) -> str:
    if name == "variant":
        return result.name.rpartition(" -- ")[0]
    if name not in result.values:
        return MISSING
    value = result.values[name]
    return value_words(name, value).partition(" = ")[2] if bins is None else bins.word(value)


def _rank(result: ExecutionResult) -> tuple[int, float, int]:
    margins = [clause.margin for clause in result.clauses if clause.margin is not None]
    return _BADNESS.index(result.verdict), min(margins, default=0.0), result.index


def _failed_row(source: ReportSource, result: ExecutionResult, *, is_repeated: bool) -> FailedRow:
    curves, lines = source.curves(result)
    clauses = tuple(_judged_rows(result, lines or (0,) * len(result.clauses), curves))
    values = ", ".join(value_words(name, value) for name, value in result.values.items())
    moment = source.moments.get(result.index)
    # The names in a study have no repetition.
    name = (
        f"{result.name.partition(' (repetition ')[0]} (repetition {result.repetition})" if is_repeated else result.name
    )
    contacts = tuple(map(contact_words, result.contacts))
    return FailedRow(name, values, result.verdict, result.seed, source.command(result), clauses, moment, contacts)


def _reason(clause: ClauseResult) -> str:
    at = "" if clause.at is None or clause.verdict is not Outcome.VIOLATED else f"at {clause.at:.2f}\u00a0s"
    return ": ".join(filter(None, (at, clause.reason)))


def _judged_rows(result: ExecutionResult, lines: Sequence[int], curves: Mapping[str, object]) -> Iterator[JudgedRow]:
    for clause, line in zip(result.clauses, lines, strict=False):
        drawn = ""
        if curves and clause.verdict is Outcome.VIOLATED:
            drawn = plot(curves, line, clause.operand) or ""
        yield JudgedRow(
            title(clause.name, clause.sentence),
            plain_sentence(clause.sentence),
            clause.verdict,
            margin(clause.margin, clause.unit),
            _reason(clause),
            drawn,
        )
