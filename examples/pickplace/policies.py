"""Evaluators of this example's observation policies; docs/semantics.md says how they are called."""

from __future__ import annotations

from typing import Any

import numpy as np

CLEARANCE = 0.1
"""Distance (m) of the thing from the middle of the goal at which it certainly has to be carried there."""


def apart(evidence: Any, arguments: Any) -> Any:
    """Return by how much (m) the thing is further from the goal than the clearance, at each sample."""
    between = evidence.position(arguments["thing"]) - evidence.position(arguments["goal"])
    return np.linalg.norm(between, axis=1) - CLEARANCE
