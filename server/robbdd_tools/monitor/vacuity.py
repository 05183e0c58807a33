"""The range of a predicate's margin.

If the margin is constant, the clause could not have failed (docs/semantics.md).
"""

from __future__ import annotations

Range = tuple[float, float]
"""Smallest and largest margin."""
SAME = 1e-9
"""Differences of margins up to this are attributed to floating-point rounding."""


def joined(ranges: list[Range]) -> Range:
    """Return the smallest range that contains one or more ranges."""
    return min(low for low, _ in ranges), max(high for _, high in ranges)


def is_constant(found: Range) -> bool:
    """Return whether a margin never varied."""
    return found[1] - found[0] <= SAME
