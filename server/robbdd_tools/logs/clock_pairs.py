"""The times of reception and in the headers of one source of a log, and jumps of the headers' clock."""

from __future__ import annotations

from array import array
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    Nanoseconds = npt.NDArray[np.int64]

MIN_OFFSET = 1_000_000_000
"""Two clocks count as different if they differ by more than this (ns). Smaller differences may be delays."""
MIN_DRIFT = 100_000_000
"""If the difference of two clocks changes by more than this (ns) during a log, it counts as a drift."""
MIN_STEP = 20_000_000
"""A clock that is set back by less than this (ns) is not noticed."""
ORDERED = 20
"""A source is ordered after this many messages in order. A jump is looked for between so many pairs on each side."""
FEW = 3
"""After a step back, at least this many messages follow in order before the newest time is reached again. A jump ahead
or back has at least this many pairs on each side."""
EVERY = 50_000_000
"""Pairs of times are kept at intervals of at least this long (ns of reception)."""


@dataclass
class _Step:
    """Headers that went back by ``back`` from ``newest`` (ns), and how many messages have followed in order."""

    newest: int
    back: int
    count: int = 1


@dataclass
class ClockPairs:
    """Times of reception and of headers (ns) for a part of a source's messages, in the order of reception."""

    received: array[int] = field(default_factory=lambda: array("q"))
    stamps: array[int] = field(default_factory=lambda: array("q"))
    last: tuple[int, int] = (0, 0)
    jump: int = 0
    """By how much (ns) the clock of the headers jumped back; 0 if it never did."""
    ordered: int = 0
    """How many messages in a row had no earlier time than the one before."""
    step: _Step | None = None

    def add(self, received: int, stamp: int) -> None:
        """Add a message; messages must be added in the order of their reception."""
        before, newest = self.last
        if received > before and newest - stamp > MIN_OFFSET:
            self.jump = max(self.jump, newest - stamp)
        self._look_for_step(received > before, newest, stamp)
        self.ordered = self.ordered + 1 if stamp >= newest else 0
        self.last = received, stamp
        if (
            not self.received
            or received - self.received[-1] >= EVERY
            or abs((received - stamp) - (self.received[-1] - self.stamps[-1])) > MIN_DRIFT
        ):
            self.received.append(received)
            self.stamps.append(stamp)

    def _look_for_step(self, is_later: bool, newest: int, stamp: int) -> None:
        """Find a clock that is set back: the messages of an ordered source go back once, and go on in order there.

        A message that is late is a single one, or the source is not ordered.
        """
        if self.step is None:
            if is_later and newest - stamp > MIN_STEP and self.ordered >= ORDERED:
                self.step = _Step(newest, newest - stamp)
        elif newest < stamp <= self.step.newest:
            self.step.count += 1
            if self.step.count == FEW:
                self.jump, self.step = max(self.jump, self.step.back), None
        else:
            self.step = None

    def extend(self, received: Nanoseconds, stamps: Nanoseconds) -> None:
        """Add messages (n,): the same as ``add`` for each of them."""
        before = np.concatenate([[self.last[1]], stamps[:-1]])
        if self.step is not None or (stamps < before).any():
            for one, stamp in zip(received.tolist(), stamps.tolist(), strict=True):
                self.add(one, stamp)
            return
        self.ordered += len(stamps)
        self.last = int(received[-1]), int(stamps[-1])
        row = 0
        while row < len(received):
            if self.received:
                # The loop visits only rows that may be kept.
                offset = self.received[-1] - self.stamps[-1]
                kept = (received[row:] - self.received[-1] >= EVERY) | (
                    np.abs(received[row:] - stamps[row:] - offset) > MIN_DRIFT
                )
                if not kept.any():
                    return
                row += int(np.argmax(kept))
            self.received.append(int(received[row]))
            self.stamps.append(int(stamps[row]))
            row += 1

    def leap(self) -> int:
        """Return by how much (ns) the headers jumped while messages came as before: back, negative ahead; else 0.

        A delayed message is received later than usual, and so are those after a pause of a simulator. A simulator that
        runs faster or slower than before does not jump.
        """
        received, stamps = self.arrays()
        waited, passed = np.diff(received), np.diff(stamps)
        if len(passed) < 2 * FEW:
            return 0
        usual, apart = float(np.median(passed)), float(np.median(waited))
        steady = waited < 2 * apart + MIN_STEP
        ahead = (passed - waited > MIN_DRIFT) & (passed > 2 * usual)
        back = (waited - passed > MIN_DRIFT) & (passed < usual / 2)
        for row in np.flatnonzero(steady & (ahead | back)).tolist():
            before, after = slice(max(0, row + 1 - ORDERED), row + 1), slice(row + 1, row + 1 + ORDERED)
            if len(received[before]) < FEW or len(received[after]) < FEW:
                continue
            speeds = [_speed(received[part], stamps[part]) for part in (before, after)]
            jumps = [_jump(received, stamps, row, speed) for speed in speeds]
            if min(jumps) > 0 or max(jumps) < 0:
                return min(jumps, key=abs)
        return 0

    def arrays(self) -> tuple[Nanoseconds, Nanoseconds]:
        """Return the kept times of reception and in headers, (n,) ns, with those of the last message."""
        pairs = [*zip(self.received, self.stamps, strict=True)]
        # Beyond the last pair, the clocks count as equally fast, so the last message belongs to them.
        found = np.array([*pairs, self.last] if self.last[0] > pairs[-1][0] else pairs, dtype=np.int64)
        return found[:, 0], found[:, 1]


def _speed(received: Nanoseconds, stamps: Nanoseconds) -> float:
    """Return how fast headers run, compared with reception: the median, so that a jump does not count."""
    apart = max(1, len(received) // 4)
    return float(np.median((stamps[apart:] - stamps[:-apart]) / np.maximum(received[apart:] - received[:-apart], 1)))


def _jump(received: Nanoseconds, stamps: Nanoseconds, row: int, speed: float) -> int:
    """Return by how much (ns) headers that run at ``speed`` jump after a row: back, negative ahead; else 0.

    The messages before and after it differ by more than their delays.
    """
    offsets = speed * (received - received[row]) - (stamps - stamps[row])
    before, after = offsets[max(0, row + 1 - ORDERED) : row + 1], offsets[row + 1 : row + 1 + FEW]
    least = max(after.min() - before.max(), before.min() - after.max())
    return int(np.median(after) - np.median(before)) if least > MIN_DRIFT * max(1.0, speed) else 0
