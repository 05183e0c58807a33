"""Arrays as JSON."""

from __future__ import annotations

from base64 import b64encode
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


def array(values: NDArray[Any], kind: Literal["float32", "uint32"]) -> dict[str, Any]:
    """Return numbers as JSON: little-endian, last index fastest, in base64; ``kind`` is their type."""
    data = np.ascontiguousarray(values, dtype=np.dtype(kind).newbyteorder("<")).tobytes()
    return {"type": kind, "shape": list(values.shape), "data": b64encode(data).decode("ascii")}
