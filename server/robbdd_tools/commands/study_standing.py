"""Print how a study stands: its pass rate so far, with its interval, and the clause that fails most often."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.campaign.study_rates import study_rates
from robbdd_tools.commands.rate_lines import level_line

if TYPE_CHECKING:
    from robbdd_tools.run.study_store import StudyStore


def standing(store: StudyStore) -> Iterator[str]:
    """Yield the lines about the stored batches; nothing before the first one. Raises ``DatabaseProblem``."""
    counts = store.counts()
    if not counts:
        return
    (overall,), *_ = study_rates(counts)
    yield level_line(overall)
    failing = {one: one.violated + one.unknown for one in store.clauses()}
    worst = max(failing, key=lambda one: failing[one] / (one.holds + failing[one]))
    if failing[worst]:
        total = worst.holds + failing[worst]
        yield f"worst clause: {worst.name}, {worst.violated} violated and {worst.unknown} unknown of {total}"
