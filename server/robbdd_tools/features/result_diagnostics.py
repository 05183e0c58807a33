"""Diagnostics from the results of runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.features.clause_results import clause_diagnostics
from robbdd_tools.features.requirement_results import requirement_diagnostics

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.features.run_verdicts import Findings
    from robbdd_tools.names.project import Snapshot


def result_diagnostics(snapshot: Snapshot, uri: str, findings: Findings, *, brief: bool) -> list[Diagnostic]:
    """Return the diagnostics of the clauses and requirements of a file; see ``clause_diagnostics`` for ``brief``."""
    clauses = clause_diagnostics(snapshot, uri, findings, brief=brief)
    return [*clauses, *requirement_diagnostics(snapshot, uri, findings)]
