"""Decide which of its observations of an element a simulated sensor makes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.catalog.geometry import into_frame

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.monitor.policy import Provider, View

    Codes = NDArray[np.int64]

SEEN, NEAR, FAR, ASIDE, MISSED = range(5)


def failures(
    provider: Provider, places: FloatArray, sensor: tuple[FloatArray, FloatArray] | None, chances: FloatArray
) -> Codes:
    """Return ``SEEN`` for each observation that is made, or else the code of its failure, shape (n,).

    ``places`` (n, 3) m are the positions of the element, ``sensor`` the positions (n, 3) m and orientations (n, 4) of
    the sensor's carrier, ``None`` without one, and ``chances`` (n,) random numbers from 0 to 1.
    """
    codes = np.where(chances < provider.misses, MISSED, SEEN)
    if provider.view is None or sensor is None:
        return codes
    local = into_frame(places, *sensor)
    distance = np.linalg.norm(local, axis=1)
    if provider.view.angle is not None:
        turned = np.arctan2(np.linalg.norm(local[:, :2], axis=1), local[:, 2])
        codes = np.where(turned > provider.view.angle / 2, ASIDE, codes)
    codes = np.where(distance < provider.view.nearest, NEAR, codes)
    return np.where(distance > provider.view.farthest, FAR, codes)


def last_seen(codes: Codes) -> Codes:
    """Return for each observation the index of the last one up to it that was made, -1 if there is none, (n,)."""
    return np.maximum.accumulate(np.where(codes == SEEN, np.arange(len(codes)), -1))


def words_of(code: int, view: View | None) -> str:
    """Return why an observation fails."""
    if view is None or code == MISSED:
        return "its sensor missed it"
    if code == ASIDE:
        return f"it was outside the field of view of {view.sensor}"
    than = f"nearer than {view.nearest:g} m to" if code == NEAR else f"farther than {view.farthest:g} m from"
    return f"it was {than} {view.sensor}"
