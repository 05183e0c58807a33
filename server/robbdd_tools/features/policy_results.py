"""Results at the observation policies of a ``.bddx``, and at their uses in its executions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.features.clause_results import clause_hint
from robbdd_tools.features.executions import executions_of
from robbdd_tools.features.pass_rates import expected_executions
from robbdd_tools.features.run_verdicts import digest, execution_digest
from robbdd_tools.features.scenarios import number_of_scenarios
from robbdd_tools.names.clause_places import PlacedClause, clauses_in
from robbdd_tools.names.elements import Site
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.features.clause_results import ResultHint
    from robbdd_tools.features.executions import PlacedExecution
    from robbdd_tools.features.run_verdicts import Findings, Judged
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot


def policy_hints(snapshot: Snapshot, uri: str, findings: Findings) -> list[ResultHint]:
    """Return a hint for each policy of a file with results, and for each use of a policy in an execution.

    A policy has the results of its clause in all executions that use the policy. A use has the results of its
    execution. Results are stale if the text of the clause, of an execution, or of one of its dependencies has changed.
    """
    file = snapshot.file(uri)
    if file is None or not findings.clauses:
        return []
    return [*_at_policies(snapshot, file, findings), *_at_uses(snapshot, uri, findings)]


def _at_policies(snapshot: Snapshot, file: FileAnalysis, findings: Findings) -> Iterator[ResultHint]:
    uri, text = file.document.uri, file.document.text
    users: list[PlacedExecution] | None = None
    for placed in file.declarations:
        root = placed.declaration.tree
        own = file.definitions.get(root.name.text) if isinstance(root, tree.Policy) else None
        if not isinstance(root, tree.Policy) or own is None:
            continue
        site = Site(snapshot, file, placed)
        if users is None:
            users = [one for other in (uri, *snapshot.importers(uri)) for one in executions_of(snapshot, other)]
        using = [one for one in users if any(_is(target, own) for _, target in _policies_of(one))]
        # The hint follows "for <clause>".
        end = site.span(root.fluent).end
        head = Span(site.span(root.name).start, text.find(">", end, end + 2) + 1 or end)
        yield from _hint(snapshot, site.target(root.fluent), using, site.span(root), head, findings)


def _at_uses(snapshot: Snapshot, uri: str, findings: Findings) -> Iterator[ResultHint]:
    for execution in executions_of(snapshot, uri):
        for ref, policy in _policies_of(execution):
            span = execution.site.span(ref)
            whole = Span(span.start - 1, span.end + 1)
            yield from _hint(snapshot, _clause_of(snapshot, policy), [execution], whole, whole, findings)


def _policies_of(execution: PlacedExecution) -> Iterator[tuple[tree.Ref, Definition]]:
    for ref in execution.node.policies:
        target = execution.site.target(ref)
        if target is not None:
            yield ref, target


def _clause_of(snapshot: Snapshot, policy: Definition) -> Definition | None:
    """Return the clause that a policy judges."""
    file = snapshot.file(policy.uri)
    for placed in file.declarations if file is not None else ():
        root = placed.declaration.tree
        if file is not None and isinstance(root, tree.Policy) and root.name.text == policy.symbol.path:
            return Site(snapshot, file, placed).target(root.fluent)
    return None


def _hint(
    snapshot: Snapshot,
    clause: Definition | None,
    executions: Sequence[PlacedExecution],
    span: Span,
    head: Span,
    findings: Findings,
) -> Iterator[ResultHint]:
    known = findings.clauses.get(clause.iri, ()) if clause is not None and clause.iri is not None else ()
    now = {one.iri: execution_digest(snapshot, one) for one in executions} if known else {}
    judged = [entry for entry in known if entry[0].execution in now]
    if clause is None or clause.iri is None or not judged:
        return
    text = _clause_digest(snapshot, clause)
    fresh = [entry for entry in judged if _is_fresh(entry, now, text)]
    placed = PlacedClause(clause.iri, clause.symbol.name, span, head)
    shown = fresh or judged
    running = {scenario.execution for scenario, _ in shown}
    totals = [_expected(one, findings) for one in executions if one.iri in running]
    total = sum(one for one in totals if one is not None) if None not in totals else None
    yield clause_hint(placed, shown, total, stale=not fresh)


def _expected(execution: PlacedExecution, findings: Findings) -> int | None:
    known = findings.variants.get(execution.variant.iri, ())
    own = (scenario for scenario in known if scenario.execution == execution.iri)
    return expected_executions(own, number_of_scenarios(execution.variant))


def _is_fresh(judged: Judged, now: dict[str, str], clause: str) -> bool:
    scenario, judgement = judged
    return judgement.digest == clause and scenario.execution_digest == now[scenario.execution]


def _clause_digest(snapshot: Snapshot, clause: Definition) -> str:
    places = (one for one in clauses_in(snapshot, clause.uri) if one.iri == clause.iri)
    return next((digest(snapshot, clause.uri, one.span) for one in places), "")


def _is(one: Definition, other: Definition) -> bool:
    return (one.uri, one.symbol.path) == (other.uri, other.symbol.path)
