"""Results of clauses, aggregated over the variations of a run and put where the clauses stand."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.names.analysis import Definition
    from robbdd_tools.names.project import Snapshot


@dataclass(frozen=True, slots=True)
class ClauseResult:
    """One judgement in words: ``outcome`` as in ``monitor.verdict.Outcome``, ``label`` its short form.

    ``rank`` orders results by badness, the worst being the smallest; ``detail`` names variation and instant.
    """

    outcome: str
    label: str
    detail: str
    rank: float


@dataclass(frozen=True, slots=True)
class JudgedClause:
    """The results of one clause and the text that they are about; edited text has no result."""

    text: str
    results: Sequence[ClauseResult]


@dataclass(frozen=True, slots=True)
class ClauseHint:
    """What to show behind a clause: ``offset`` is absolute, ``lines`` one per variation."""

    span: Span
    label: str
    outcome: str
    lines: tuple[str, ...]


def clause_text(snapshot: Snapshot, iri: str, uris: Sequence[str]) -> str | None:
    """Return the present text of the clause with an IRI, looked for in some files."""
    for uri in uris:
        for found in _clauses(snapshot, uri):
            if found.iri == iri:
                return _text(snapshot, found)
    return None


def clause_hints(snapshot: Snapshot, uri: str, judged: Mapping[str, JudgedClause]) -> list[ClauseHint]:
    """Return a hint for each clause of a file that has results and still says what they judged."""
    hints: list[ClauseHint] = []
    for found in _clauses(snapshot, uri):
        clause = judged.get(found.iri or "")
        if clause is not None and clause.results and clause.text == _text(snapshot, found):
            hints.append(_hint(found.extent, clause.results))
    return hints


def clause_diagnostics(snapshot: Snapshot, uri: str, judged: Mapping[str, JudgedClause]) -> list[Diagnostic]:
    """Return a diagnostic for each clause that was violated (error) or unknown (warning) in some variation."""
    found: list[Diagnostic] = []
    for hint in clause_hints(snapshot, uri, judged):
        if hint.outcome != "holds":
            severity = Severity.ERROR if hint.outcome == "violated" else Severity.WARNING
            message = f"{hint.label}\n" + "\n".join(hint.lines)
            found.append(Diagnostic(uri, hint.span, severity, f"clause-{hint.outcome}", message))
    return found


def _clauses(snapshot: Snapshot, uri: str) -> Iterator[Definition]:
    analysis = snapshot.file(uri)
    for found in analysis.definitions.values() if analysis is not None else ():
        if found.kind is SymbolKind.FLUENT:
            yield found


def _text(snapshot: Snapshot, found: Definition) -> str:
    analysis = snapshot.file(found.uri)
    return "" if analysis is None else analysis.document.text[found.extent.start : found.extent.end]


def _hint(span: Span, results: Sequence[ClauseResult]) -> ClauseHint:
    worst = min(results, key=lambda result: result.rank)
    lines = tuple(result.detail for result in sorted(results, key=lambda result: result.rank))
    if len(results) == 1:
        return ClauseHint(span, worst.label, worst.outcome, lines)
    sign, _, margin = worst.label.partition(" ")
    holding = sum(result.outcome == "holds" for result in results)
    label = f"{sign} {holding}/{len(results)}" + (f"  worst {margin}" if margin else "")
    return ClauseHint(span, label, worst.outcome, lines)
