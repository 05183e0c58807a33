"""Rules for models that are graphs. They report, before a run, the causes of clauses that would stay unknown.

The findings have the codes and messages of the rules for text. Each one is placed at the node that causes it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, sort_key
from robbdd_tools.checks.graph_clauses import clause_findings
from robbdd_tools.checks.graph_correct_places import place_findings
from robbdd_tools.checks.graph_executions import execution_findings
from robbdd_tools.checks.graph_scenes import scene_findings
from robbdd_tools.checks.graph_site import GraphSite

if TYPE_CHECKING:
    from robbdd_tools.graph.write.built import BuiltGraph


def graph_findings(built: BuiltGraph) -> list[Diagnostic]:
    """Return the findings on the acceptance criteria of a graph file. Incomplete variants are skipped."""
    site = GraphSite.of(built)
    found = dict.fromkeys(
        (*scene_findings(site), *place_findings(site), *clause_findings(site), *execution_findings(site))
    )
    return sorted(found, key=sort_key)
