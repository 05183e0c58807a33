"""A comparison as a document that follows ``docs/schemas/comparison.schema.json``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from robbdd_tools.campaign.run_comparison import ClauseEffect, RunComparison


def comparison_json(before: str, after: str, found: RunComparison, remarks: Sequence[str]) -> dict[str, Any]:
    """Return a comparison as JSON data. ``before`` and ``after`` name the runs."""
    matched = found.matched
    return {
        "before": before,
        "after": after,
        "decision": str(found.decision),
        "level": found.level,
        "paired": matched.paired,
        "shared": matched.shared,
        "before_only": matched.before_only,
        "after_only": matched.after_only,
        "removed": list(matched.removed),
        "added": list(matched.added),
        "remarks": list(remarks),
        "clauses": [_clause(effect) for effect in found.effects],
    }


def _clause(effect: ClauseEffect) -> dict[str, Any]:
    return {**asdict(effect), "change": str(effect.change)}
