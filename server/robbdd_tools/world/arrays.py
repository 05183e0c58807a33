"""Convert arrays to JSON."""

from __future__ import annotations

from base64 import b64encode
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


def array(values: NDArray[Any], kind: Literal["float32", "uint32"]) -> dict[str, Any]:
    """Return numbers as base64 for JSON: little-endian, last index fastest. ``kind`` is the type of the numbers."""
    data = np.ascontiguousarray(values, dtype=np.dtype(kind).newbyteorder("<")).tobytes()
    return {"type": kind, "shape": list(values.shape), "data": b64encode(data).decode("ascii")}
