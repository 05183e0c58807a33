"""Arrays that do not fit into memory: large ones are in temporary files, and the system keeps the used parts in memory.

The directory of temporary files is the system's (``TMPDIR``). The files have no name and vanish with the arrays.
"""

from __future__ import annotations

import mmap
import tempfile
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

IN_MEMORY = 1 << 21
"""Arrays up to this size (bytes) are kept in memory."""


def large_array(shape: tuple[int, ...], kind: npt.DTypeLike = np.float64) -> npt.NDArray[Any]:
    """Return an array with undefined values, in memory or, if it is large, in a temporary file. Raises ``OSError``."""
    size = int(np.prod(shape)) * np.dtype(kind).itemsize
    if size <= IN_MEMORY:
        return np.empty(shape, kind)
    with tempfile.TemporaryFile() as file:
        file.truncate(size)
        # The map keeps the file after it has been closed.
        return np.frombuffer(mmap.mmap(file.fileno(), size), kind).reshape(shape)
