"""Aggregate results of runs over variations, and map them to clauses and table rows."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.diagnostic import Diagnostic, Related, Severity
from robbdd_tools.features.pass_rates import (
    STALE,
    ExpectedExecutions,
    Missing,
    PassRate,
    extent,
    missing_executions,
    outcome_of_all,
)
from robbdd_tools.features.rejudged_results import BADNESS, MARK, SIGNS, RejudgedResult, rejudged_result
from robbdd_tools.features.run_verdicts import digest
from robbdd_tools.names.clause_places import clauses_in
from robbdd_tools.names.variant_places import variants_of

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.features.run_verdicts import Findings, Judged, JudgedScenario
    from robbdd_tools.names.clause_places import PlacedClause
    from robbdd_tools.names.project import Snapshot

VACUOUS = "(vacuous)"
_REJUDGED = "Re-judged on stored traces, not executed: run it to be sure."
_CHANGED = "The text has changed since this was judged: run it again."
MAX_LINES = 20
"""Maximum number of variations in a tooltip."""
MAX_LINES_OF_FAILURES = 5
"""Maximum number of variations in a diagnostic."""


@dataclass(frozen=True, slots=True)
class ResultHint:
    """The hint to show after ``head`` (absolute), for the clause or table row at ``span``.

    - ``outcome``: the worst outcome of all variations; ``unknown`` if only some were executed, and these hold.
    - ``lines``: descriptions of the variations, the worst first.
    - ``stale``: true if the text has changed since the run.
    - ``failing``: the verdicts on a clause that did not hold, the worst first.
    - ``worst``: the worst of all verdicts.
    - ``vacuous``: the reason why the clause could not have failed.
    - ``substitutions``: the catalog behaviours that were executed instead of the model's, and the chosen
      scene instances.
    - ``rejudged``: the result of stored traces on the edited clause. No execution has judged the edited clause yet.
    - ``iri``: the IRI of the clause; empty for a table row.
    """

    span: Span
    head: Span
    label: str
    outcome: str
    lines: tuple[str, ...]
    stale: bool = False
    failing: tuple[Judged, ...] = ()
    worst: Judged | None = None
    vacuous: str = ""
    substitutions: tuple[str, ...] = ()
    rejudged: RejudgedResult | None = None
    iri: str = ""

    @property
    def is_consequence(self) -> bool:
        """Whether the clause is unknown in some executions, and in each of them only because of another clause."""
        return bool(self.failing) and all(judgement.because for _, judgement in self.failing)

    @property
    def reason(self) -> str:
        """Why the clause does not hold in its worst execution; empty if the margin or another clause is the reason."""
        if self.worst is None or self.rejudged is not None or self.is_consequence:
            return ""
        # The verdict follows in brackets.
        return self.worst[1].failure.rpartition(" (")[0]

    @property
    def tooltip(self) -> str:
        """The full text of the hint. It is shortened if there are many variations."""
        remarks = [_CHANGED] * self.stale if self.rejudged is None else [_REJUDGED] * self.rejudged.usable
        remarks += [f"It proves little: {self.vacuous}."] * bool(self.vacuous)
        remarks += self.substitutions
        return "\n".join((*remarks, *_shortened(self.lines, MAX_LINES)))


def appearance(shown: ResultHint | PassRate) -> dict[str, Any]:
    """Return the data that clients need to colour a result."""
    found: dict[str, Any] = {"verdict": verdict_of(shown.outcome), "stale": shown.stale}
    if isinstance(shown, ResultHint):
        found |= {"rejudged": True} if shown.rejudged is not None else {}
        found |= {"consequence": True} if shown.is_consequence else {}
        found |= {"reason": shown.reason} if shown.reason else {}
    return found


def verdict_of(outcome: str) -> str:
    """Return the verdict for an outcome. A clause that no step can judge has the verdict *unknown*."""
    return "unknown" if outcome == "undefined" else outcome


def clause_hints(snapshot: Snapshot, uri: str, findings: Findings) -> list[ResultHint]:
    """Return a hint for each clause of a file with results."""
    hints: list[ResultHint] = []
    expected = ExpectedExecutions(snapshot, uri)
    for clause in clauses_in(snapshot, uri) if findings.variants else ():
        judged, edited = findings.clauses.get(clause.iri, ()), findings.rejudged.get(clause.iri, ())
        now = digest(snapshot, uri, clause.span) if judged or edited else ""
        rejudged = [one for one in edited if one.judgement is None or one.judgement.digest == now]
        fresh = [entry for entry in judged if entry[1].digest == now]
        if rejudged:
            hints.append(_rejudged_hint(clause, rejudged_result(rejudged, judged, now)))
        elif judged:
            shown = fresh or judged
            total = expected.of((scenario for scenario, _ in shown), findings)
            hints.append(clause_hint(clause, shown, total, stale=not fresh))
    return hints


def row_hints(snapshot: Snapshot, uri: str, findings: Findings) -> list[ResultHint]:
    """Return a hint for each table row whose scenario was run. The hint lists the clauses that failed."""
    hints: list[ResultHint] = []
    for variant in variants_of(snapshot, uri) if findings.variants else ():
        scenarios = findings.variants.get(variant.iri, ())
        for number, row in enumerate(variant.rows if scenarios else (), start=1):
            now = digest(snapshot, uri, row)
            fresh = [scenario for scenario in scenarios if scenario.row == now]
            shown = fresh or [scenario for scenario in scenarios if scenario.variation == number]
            if shown:
                hints.append(_row_hint(row, shown, stale=not fresh))
    return hints


def clause_diagnostics(snapshot: Snapshot, uri: str, findings: Findings, *, brief: bool = False) -> list[Diagnostic]:
    """Return a diagnostic for each clause that did not hold in some variation.

    Clauses whose text has changed since the run have none. A clause that is unknown only because of other clauses has
    none either. Instead, the diagnostics of these clauses state the number of their consequences and link to them.

    A diagnostic begins with the worst reason. Then it lists the worst variations with their instants and links to their
    table rows. If it is ``brief``, it names only the worst variation, because a hover below it shows the full list.
    """
    rows = _rows(snapshot, uri) if findings.clauses else {}
    found: list[Diagnostic] = []
    hints = clause_hints(snapshot, uri, findings)
    followers = _followers(hints)
    folded = {one.iri for several in followers.values() for one in several}
    for hint in hints:
        if hint.rejudged is not None:
            found += _rejudged_diagnostic(uri, hint, hint.rejudged, 0 if brief else MAX_LINES_OF_FAILURES)
        if hint.vacuous and not hint.stale:
            message = f"This clause proved little in the last run: {hint.vacuous}."
            found.append(Diagnostic(uri, hint.head, Severity.HINT, "clause-vacuous", message))
        # An error in users' code is reported at the code's name, not at every clause that is unknown because of it.
        failing = sorted(_without_faults(hint), key=lambda judged: judged[1].because != "")
        others = followers.get(hint.iri, [])
        if failing and not hint.stale and hint.iri not in folded:
            severity = Severity.ERROR if hint.outcome == "violated" else Severity.WARNING
            related = tuple(
                Related(uri, rows[scenario.variant, scenario.row], _line((scenario, judgement)))
                for scenario, judgement in failing[:MAX_LINES_OF_FAILURES]
                if (scenario.variant, scenario.row) in rows
            )
            message = _failure_message(hint, failing, 1 if brief else MAX_LINES_OF_FAILURES, len(others))
            related += tuple(Related(uri, one.head, one.failing[0][1].because_words) for one in others)
            found.append(Diagnostic(uri, hint.head, severity, f"clause-{hint.outcome}", message, related))
    return found


def _without_faults(hint: ResultHint) -> list[Judged]:
    return [judged for judged in hint.failing if not judged[1].fault]


def _rejudged_diagnostic(uri: str, hint: ResultHint, rejudged: RejudgedResult, most: int) -> Iterator[Diagnostic]:
    """Yield a diagnostic if stored traces do not all satisfy an edited clause, or if some of them flip.

    ``most`` is the maximum number of executions that it lists.
    """
    if not rejudged.usable or (rejudged.outcome == "holds" and not rejudged.flipped):
        return
    first = f"{' · '.join(filter(None, (rejudged.reason, rejudged.counts)))} {MARK}"
    message = "\n".join((first, *_shortened(rejudged.lines, most))) if most else first
    yield Diagnostic(uri, hint.head, Severity.INFORMATION, "clause-rejudged", message)


def _followers(hints: Sequence[ResultHint]) -> dict[str, list[ResultHint]]:
    """Return, by the IRI of each cause, the clauses that are unknown only because of clauses with shown results."""
    shown = {hint.iri for hint in hints if not hint.stale}
    found: dict[str, list[ResultHint]] = {}
    for hint in hints:
        causes = dict.fromkeys(judgement.because for _, judgement in _without_faults(hint))
        if not hint.stale and causes.keys() <= shown:
            for cause in causes:
                found.setdefault(cause, []).append(hint)
    return found


def _failure_message(hint: ResultHint, failing: Sequence[Judged], most: int, others: int) -> str:
    """Return the text of a clause's failures. Clients may show only the first line, so it has the worst reason.

    ``most`` is the maximum number of listed variations. ``others`` clauses are unknown because of this one.
    """
    scenario, worst = failing[0]
    reason = worst.failure or worst.said
    if others:
        reason += f", and so {others} more clause{'s' * (others > 1)}"
    count = len(hint.lines)
    if count == 1:
        return f"{reason} [{scenario.values}]" if scenario.values else reason
    lines = list(map(_line, failing))
    shown = lines[:1] if most == 1 else _shortened(lines, most)
    return "\n".join((f"{reason} · {count - len(hint.failing)} of {count} hold", *shown))


def _rows(snapshot: Snapshot, uri: str) -> dict[tuple[str, str], Span]:
    """Return the table rows of a file by the variant's IRI and the digest of the row."""
    return {
        (variant.iri, digest(snapshot, uri, row)): row for variant in variants_of(snapshot, uri) for row in variant.rows
    }


def _line(judged: Judged) -> str:
    scenario, judgement = judged
    return f"{scenario.values}: {judgement.said}"


def clause_hint(clause: PlacedClause, judged: Sequence[Judged], total: int | None, *, stale: bool) -> ResultHint:
    """Return the hint of a clause with some verdicts, of the ``total`` that it should have."""
    ranked = sorted(judged, key=lambda entry: entry[1].rank)
    worst = ranked[0][1]
    failing = tuple(entry for entry in ranked if entry[1].outcome != "holds")
    missing: Missing = None if total is None else max(0, total - len(judged))
    outcome = outcome_of_all(worst.outcome, missing)
    sign = SIGNS[outcome]
    if outcome != worst.outcome:
        margin = f"worst {worst.margin}" if len(judged) > 1 and worst.margin else worst.margin
        label = f"{sign} {extent(len(judged), missing)}" + (f"  {margin}" if margin else "")
    elif len(judged) == 1:
        label = worst.said.partition(":")[0]
    else:
        holding = sum(judgement.outcome == "holds" for _, judgement in judged)
        label = f"{sign} {holding}/{len(judged)}" + (f"  worst {worst.margin}" if worst.margin else "")
    if worst.outcome == "undefined":
        label += " no step definition"
    if failing and len({judgement.because_words for _, judgement in failing}) == 1 and worst.because_words:
        words = worst.because_words.removeprefix("unknown ")
        label = f"{sign} {words}" if len(judged) == 1 else f"{label}  {words}"
    if worst.fault:
        label += " error in code"
    vacuous = worst.vacuous if all(judgement.vacuous for _, judgement in judged) else ""
    shown = " ".join((label, *[VACUOUS] * bool(vacuous), *[STALE] * stale))
    lines, substituted = tuple(map(_line, ranked)), substitutions(scenario for scenario, _ in judged)
    return ResultHint(
        clause.span,
        clause.head,
        shown,
        outcome,
        lines,
        stale,
        failing,
        ranked[0],
        vacuous,
        substituted,
        iri=clause.iri,
    )


def _rejudged_hint(clause: PlacedClause, found: RejudgedResult) -> ResultHint:
    return ResultHint(
        clause.span, clause.head, found.label, found.outcome, found.lines, stale=not found.usable, rejudged=found
    )


def _row_hint(span: Span, scenarios: Sequence[JudgedScenario], *, stale: bool) -> ResultHint:
    worst = _worst(scenario.outcome for scenario in scenarios)
    missing = missing_executions(scenarios, len({scenario.variation for scenario in scenarios}))
    outcome = outcome_of_all(worst, missing)
    failed = dict.fromkeys(
        judgement.name
        for scenario in scenarios
        for judgement in scenario.clauses.values()
        if judgement.outcome != "holds"
    )
    partial = [extent(sum(scenario.finished for scenario in scenarios), missing)] * (outcome != worst)
    label = " ".join((SIGNS[outcome], *partial, ", ".join(failed))).strip()
    lines = tuple(
        f"{scenario.values}: {judgement.name} {judgement.said}"
        for scenario in scenarios
        for judgement in sorted(scenario.clauses.values(), key=lambda judgement: judgement.rank)
    )
    shown = f"{label} {STALE}" if stale else label
    return ResultHint(span, span, shown, outcome, lines, stale, substitutions=substitutions(scenarios))


def substitutions(scenarios: Iterable[JudgedScenario]) -> tuple[str, ...]:
    """Return a text for each distinct choice of the user: substituted behaviours, chosen scene instances and worlds."""
    found = (one for scenario in scenarios for one in (scenario.substitution, scenario.scene_instance, scenario.world))
    return tuple(map(str, dict.fromkeys(one for one in found if one is not None)))


def _worst(outcomes: Iterable[str]) -> str:
    return min(outcomes, key=BADNESS.index)


def _shortened(lines: Sequence[str], most: int) -> tuple[str, ...]:
    kept = tuple(lines[:most])
    return (*kept, f"… and {len(lines) - most} more") if len(lines) > most else kept
