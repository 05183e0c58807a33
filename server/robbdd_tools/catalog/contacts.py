"""Contact forces between any two elements, for the predicates about touching."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.geometry import carriers_of

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Arguments, Evidence, FloatArray

TOUCH = "touch"
"""Name of the quantity of the predicates about touching: contact forces, which are recorded on demand."""
FAINTEST = 0.01
"""Two elements touch from this contact force (N) on, the weight of one gram. Weaker forces are noise of the solver."""


def contact_force(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Return the largest contact force (N) between the elements ``one`` and ``other`` since the previous sample, (n,).

    The objects that carry a workspace represent it. Objects that an agent grips are no part of the agent. Raises
    ``KeyError`` if the forces of some pair were not recorded.
    """
    import numpy as np

    one, other = str(arguments["one"]), str(arguments["other"])
    pairs = [(a, b) for a in carriers_of(evidence, one) for b in carriers_of(evidence, other) if a != b]
    if not pairs:
        raise KeyError(f"contact forces of {one} on itself")
    return np.max([evidence.touch(*pair) for pair in pairs], axis=0)
