"""Compare two runs: the public function of the package."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from robbdd_tools.campaign.aligned_sources import aligned
from robbdd_tools.campaign.gate import parse_gate
from robbdd_tools.campaign.rates import LEVEL
from robbdd_tools.campaign.run_comparison import ComparisonOptions, RunComparison, compare_results
from robbdd_tools.campaign.run_sources import run_source, stored_source
from robbdd_tools.workbench.stored import PastRun


def compare(
    before: PastRun | str | os.PathLike[str],
    after: PastRun | str | os.PathLike[str],
    *,
    gate: str | Sequence[str] = (),
    level: float = LEVEL,
    by_margin: bool = False,
    path: str | os.PathLike[str] = ".",
) -> RunComparison:
    """Decide clause by clause whether a run is worse than another one (docs/comparing.md).

    Each run is a stored run, its number or folder, ``latest``, a results file of ``robbdd run --json``, or a study with
    results (``FILE.study``, ``FILE.study:FACTOR=LEVEL``). ``gate`` is
    the accepted change, for example ``no clause worse than 2 points``; ``level`` is the confidence level; with
    ``by_margin``, mean margins decide, too. ``path`` is in the project. Raises ``NoSuchRun``, ``NotAGate``,
    ``NothingShared`` and ``StatisticsNotInstalled``.
    """
    sources = (
        stored_source(run) if isinstance(run, PastRun) else run_source(os.fspath(run), Path(path))
        for run in (before, after)
    )
    one, other, _ = aligned(*sources)
    texts = (gate,) if isinstance(gate, str) else gate
    return compare_results(one.results, other.results, ComparisonOptions(parse_gate(texts), level, by_margin=by_margin))
