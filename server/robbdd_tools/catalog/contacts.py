"""Contact forces between any two elements, for the predicates about touching."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.geometry import carriers_of

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Arguments, Evidence, FloatArray

TOUCH = "touch"
"""The quantity that the predicates about touching need: contact forces, which are recorded on demand."""
FAINTEST = 0.01
"""Contact force (N) from which two elements touch: the weight of one gram. Weaker forces are noise of the solver."""


def contact_force(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Return the largest contact force (N) between the elements ``one`` and ``other`` since the previous sample, (n,).

    A workspace is represented by the objects that carry it. What an agent grips is not part of it.
    Raises ``KeyError`` if the forces of some pair were not recorded.
    """
    import numpy as np

    one, other = str(arguments["one"]), str(arguments["other"])
    pairs = [(a, b) for a in carriers_of(evidence, one) for b in carriers_of(evidence, other) if a != b]
    if not pairs:
        raise KeyError(f"contact forces of {one} on itself")
    return np.max([evidence.touch(*pair) for pair in pairs], axis=0)
