"""Evaluators of this example's observation policies; docs/semantics.md describes their interface."""

from __future__ import annotations

from typing import Any

import numpy as np

CLEARANCE = 0.1
"""Distance (m) from the goal's centre beyond which the object is certainly not at the goal."""


def apart(evidence: Any, arguments: Any) -> Any:
    """Return the distance (m) from the goal beyond the clearance, at each sample."""
    between = evidence.position(arguments["thing"]) - evidence.position(arguments["goal"])
    return np.linalg.norm(between, axis=1) - CLEARANCE
