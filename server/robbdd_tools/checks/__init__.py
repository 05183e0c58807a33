"""Semantic rules, one file per diagnostic code, beyond syntax, names and shapes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.checks.namespace_iri import namespace_iri
from robbdd_tools.checks.no_scenario import no_scenario

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.analysis import FileAnalysis

CHECKS = (namespace_iri, no_scenario)


def run_checks(analysis: FileAnalysis) -> list[Diagnostic]:
    """Return the findings of every rule on one file."""
    return [diagnostic for check in CHECKS for diagnostic in check(analysis)]
