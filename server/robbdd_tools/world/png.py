"""Write PNG files with the standard library alone."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from robbdd_tools.base.writing import replace_file

SIGNATURE = b"\x89PNG\r\n\x1a\n"
RGB_8 = bytes((8, 2, 0, 0, 0))
"""Eight bits per channel, true colour, no interlacing."""


def write_png(path: Path, pixels: NDArray[np.uint8]) -> None:
    """Write pixels (height, width, 3); equal pixels give equal bytes. Raises ``OSError``."""
    height, width, _ = pixels.shape
    # Each row begins with the number of its filter: 0, none.
    rows = np.concatenate([np.zeros((height, 1), np.uint8), pixels.reshape(height, 3 * width)], axis=1)
    header = struct.pack(">II", width, height) + RGB_8
    pixel_data = _chunk(b"IDAT", zlib.compress(rows.tobytes(), 6))
    replace_file(path, SIGNATURE + _chunk(b"IHDR", header) + pixel_data + _chunk(b"IEND", b""))


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
