"""Rows of numbers with times, as many as a log has: all but the newest are in a temporary file."""

from __future__ import annotations

import tempfile
from array import array
from collections.abc import Callable, Iterator, Sequence
from typing import IO, TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from robbdd_tools.base.large_arrays import large_array

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

    Nanoseconds = npt.NDArray[np.int64]
    Block = tuple[Nanoseconds, FloatArray]
    """The times (n,) of rows in ns, and their numbers (n, width)."""

BLOCK = 16384
"""This many rows are kept in memory."""


class StoredRows:
    """Rows of ``width`` numbers with times in ns, in the order in which they were added.

    Rows that are in the file are never changed, so copies share it.
    """

    def __init__(self, width: int) -> None:
        self._width = width
        self._times: array[int] = array("q")
        self._values: array[float] = array("d")
        self._file: IO[bytes] | None = None
        self._blocks: list[tuple[int, int]] = []
        """Place in the file and number of rows of each block."""

    def __deepcopy__(self, memo: dict[int, object]) -> StoredRows:
        found = StoredRows(self._width)
        found._times, found._values = self._times[:], self._values[:]
        found._file, found._blocks = self._file, list(self._blocks)
        return found

    def __len__(self) -> int:
        return sum(count for _, count in self._blocks) + len(self._times)

    def append(self, time: int, values: Sequence[float]) -> None:
        """Add a row."""
        self._times.append(time)
        self._values.extend(values)
        if len(self._times) >= BLOCK:
            self._store()

    def extend(self, times: Nanoseconds, values: FloatArray) -> None:
        """Add rows: times (n,) in ns and numbers (n, width)."""
        self._times.frombytes(times.astype(np.int64).tobytes())
        self._values.frombytes(values.astype(np.float64).tobytes())
        if len(self._times) >= BLOCK:
            self._store()

    def absorb(self, other: StoredRows) -> None:
        """Add the rows of another object."""
        for times, values in other.blocks():
            self.extend(times, values)

    def blocks(self) -> Iterator[Block]:
        """Yield the rows in the order in which they were added, in blocks. There is at least one block."""
        for place, count in self._blocks:
            assert self._file is not None
            self._file.seek(place)
            times = np.frombuffer(self._file.read(8 * count), np.int64)
            values = np.frombuffer(self._file.read(8 * count * self._width), np.float64)
            yield times, values.reshape(-1, self._width)
        yield np.array(self._times, dtype=np.int64), np.array(self._values).reshape(-1, self._width)

    def retimed(self, convert: Callable[[Nanoseconds], Nanoseconds]) -> StoredRows:
        """Return the rows with other times."""
        found = StoredRows(self._width)
        for times, values in self.blocks():
            found.extend(convert(times), values)
        return found

    def bounds(self) -> list[int]:
        """Return the earliest and the latest time, ns; empty without rows."""
        found = [int(time) for times, _ in self.blocks() if len(times) for time in (times.min(), times.max())]
        return [min(found), max(found)] if found else []

    def in_order(self, usable: Callable[[FloatArray], npt.NDArray[np.bool_]], *, same: bool = False) -> Block:
        """Return the usable rows in the order of their times. Of rows with one time, the last one is kept.

        ``usable`` says of numbers (n, width) which rows are. With ``same``, only the last row of all is kept.
        """
        count = sum(int(usable(values).sum()) for _, values in self.blocks())
        stamps, rows = large_array((count,), np.int64), large_array((count, self._width))
        end = 0
        for times, values in self.blocks():
            chosen = usable(values)
            begin, end = end, end + int(chosen.sum())
            stamps[begin:end], rows[begin:end] = times[chosen], values[chosen]
        if (stamps[1:] < stamps[:-1]).any():
            # The sort is stable: of equal times, the row that was recorded last stays last.
            order = np.argsort(stamps, kind="stable")
            stamps, rows = stamps[order], rows[order]
        last = np.ones(count, bool)
        last[:-1] = False if same else stamps[1:] != stamps[:-1]
        return (stamps, rows) if last.all() else (stamps[last], rows[last])

    def _store(self) -> None:
        if self._file is None:
            self._file = tempfile.TemporaryFile()  # noqa: SIM115 - it is closed with this object
        self._blocks.append((self._file.seek(0, 2), len(self._times)))
        self._file.write(self._times.tobytes())
        self._file.write(self._values.tobytes())
        self._times, self._values = array("q"), array("d")
