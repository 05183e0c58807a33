"""How far a predicate's margin ever varied: one that never did could not have failed (docs/semantics.md)."""

from __future__ import annotations

Range = tuple[float, float]
"""Smallest and largest margin."""
SAME = 1e-9
"""Difference of margins that is put down to floating-point numbers."""


def joined(ranges: list[Range]) -> Range:
    """Return the range that holds all of one or more ranges."""
    return min(low for low, _ in ranges), max(high for _, high in ranges)


def is_constant(found: Range) -> bool:
    """Tell whether a margin never varied."""
    return found[1] - found[0] <= SAME
