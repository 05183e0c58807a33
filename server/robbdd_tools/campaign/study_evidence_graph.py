"""The graph in the evidence of a study: from requirements over scenarios and clauses to executions and their traces."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.files import load_bytes
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.campaign.evidence_parts import Check, sha256
from robbdd_tools.campaign.study_graph import study_graph
from robbdd_tools.campaign.study_traces import kept_trace, traces_in

if TYPE_CHECKING:
    from robbdd_tools.campaign.study_file import Study
    from robbdd_tools.run.study_reader import StudyReader

GRAPH = "graph.ttl"
MOST_EXECUTIONS = 2000
"""A bundle of more executions has no graph: each clause of an execution needs about 26 kB of memory and 4 ms."""


def evidence_graph(study: Study, store: StudyReader, folder: Path) -> bytes | None:
    """Return the graph of a study with its results, and with the traces in ``folder``, as Turtle.

    Returns ``None`` if there are too many executions. Raises the errors of ``study_graph``, and ``OSError``.
    """
    from robbdd_tools.graph.rdf.serialize import serialize

    if sum(store.verdicts().values()) > MOST_EXECUTIONS:
        return None
    digests = {number - 1: sha256(load_bytes(kept_trace(folder, number), RESULT_SIZE)) for number in traces_in(folder)}
    return serialize(study_graph(study, store, digests).graph, "ttl").encode()


def graph_check(study: Study, store: StudyReader, folder: Path, stored: Path) -> Check:
    """Build the graph of an unpacked bundle again, with the traces in ``folder``, and compare it with ``stored``."""
    from robbdd_tools.graph.write.run_results import BadResults

    detail = f"{GRAPH} is that of the study, its results and its traces"
    try:
        same = evidence_graph(study, store, folder) == load_bytes(stored, RESULT_SIZE)
    except (BadResults, OSError) as error:
        return Check("graph", "", (str(error),))
    return Check("graph", detail, () if same else (f"{GRAPH} is not the graph of the study with these results",))
