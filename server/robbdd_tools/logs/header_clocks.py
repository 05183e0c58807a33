"""Compare the clocks of headers with the clock of reception, and convert times of reception to the headers' clock."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.logs.clock_pairs import MIN_DRIFT, MIN_OFFSET, ClockPairs

if TYPE_CHECKING:
    from robbdd_tools.logs.clock_pairs import Nanoseconds

LONG_DELAY = 100_000_000
"""A remark names a difference of two clocks of more than this (ns) that may be a delay."""
PARTS = 10
"""To find a drift, a log is divided into this many parts."""
MAX_RATIO = 100
"""If headers run more than this many times as fast as reception, times of reception are not times of arrival."""
MAX_LISTED = 4

Source = tuple[str, str]
"""A topic and, for topics of transforms, a frame. One program publishes each source."""


@dataclass(frozen=True, slots=True)
class HeaderTime:
    """The clock of the headers as a function of the time of reception.

    - ``received``, ``stamps``: (n,) ns, increasing; times are interpolated between these pairs. Without pairs, the
      clocks differ by ``offset``.
    - ``offset``: by how much (ns) the clock of reception is ahead.
    - ``unusable``: sources whose headers have a different clock, or a clock that jumps back.
    - ``timeless``: true if the times of reception do not say when messages without headers were published.
    """

    offset: int = 0
    received: Nanoseconds = field(default_factory=lambda: np.empty(0, np.int64))
    stamps: Nanoseconds = field(default_factory=lambda: np.empty(0, np.int64))
    unusable: frozenset[Source] = frozenset()
    timeless: bool = False
    remarks: tuple[str, ...] = ()

    def of(self, received: Nanoseconds) -> Nanoseconds:
        """Convert times of reception (n,) to the headers' clock, ns. Beyond the pairs, the last difference is used."""
        if not len(self.received):
            return received - self.offset
        inside = np.clip(received, self.received[0], self.received[-1])
        begin, base = self.received[0], self.stamps[0]
        # Floating-point numbers of 53 bits hold a hundred days in ns, but not the time since 1970.
        asked, known, stamps = (
            one.astype(float) for one in (inside - begin, self.received - begin, self.stamps - base)
        )
        moved = np.asarray(np.interp(asked, known, stamps), dtype=float)
        return base + np.rint(moved).astype(np.int64) + (received - inside)


@dataclass
class HeaderClocks:
    """Collects the times at which messages were received, and the times in their headers, in ns."""

    stated: Collection[str] = ()
    """Topics whose clocks the user has stated: they count as corrected."""
    _sources: dict[Source, ClockPairs] = field(default_factory=dict[Source, ClockPairs])

    def seen(self, topic: str, frame: str, received: int, stamp: int) -> None:
        """Add a message. Messages must be added in the order of their reception."""
        pairs = self._sources.get((topic, frame))
        if pairs is None:
            pairs = self._sources[topic, frame] = ClockPairs()
        pairs.add(received, stamp)

    def seen_many(self, topic: str, frame: str, received: Nanoseconds, stamps: Nanoseconds) -> None:
        """Add messages (n,), in the order of their reception."""
        self._sources.setdefault((topic, frame), ClockPairs()).extend(received, stamps)

    def header_time(self) -> HeaderTime:
        """Return the headers' clock that counts, and the sources that have a different one."""
        jumps = {source: float(jump) for source, pairs in self._sources.items() if (jump := pairs.jump or pairs.leap())}
        remarks = [_jump_words(*one) for one in _grouped(jumps)]
        known = {source: pairs.arrays() for source, pairs in self._sources.items() if source not in jumps}
        if not known:
            return HeaderTime(unusable=frozenset(jumps), remarks=tuple(remarks))
        reference = _reference(known)
        received, stamps = known[reference]
        if _ratio(received, stamps) > MAX_RATIO:
            words = "the times of reception do not say when messages arrived, so those without a header are not used"
            return HeaderTime(unusable=frozenset(jumps), timeless=True, remarks=(*remarks, words))
        clock = HeaderTime(received=received, stamps=np.maximum.accumulate(stamps))
        aheads = {source: _ahead(*one, clock) for source, one in known.items() if source[0] not in self.stated}
        others = {source: ahead for source, ahead in aheads.items() if abs(ahead) > MIN_OFFSET}
        remarks += [_other_words(*one, reference[0]) for one in _grouped(others)]
        late = {source: ahead for source, ahead in aheads.items() if LONG_DELAY < abs(ahead) <= MIN_OFFSET}
        remarks += [_late_words(*one, reference[0]) for one in _grouped(late)]
        unusable = frozenset((*jumps, *others))
        if (drift := _drift(received, stamps)) > MIN_DRIFT:
            words = "the difference of the clocks of headers and of reception changes"
            words += f" by {drift / 1e9:.3f} s: times of reception were converted by the headers of '{reference[0]}'"
            return HeaderTime(0, received, clock.stamps, unusable, remarks=(words, *remarks))
        every = [times - headers for source, (times, headers) in known.items() if source not in others]
        offset = int(np.median(np.concatenate(every)))
        if abs(offset) <= MIN_OFFSET:
            remarks += [_delay_words(offset, reference[0])] if abs(offset) > LONG_DELAY else []
            return HeaderTime(unusable=unusable, remarks=tuple(remarks))
        words = f"the time of reception is {offset / 1e9:.3f} s ahead of the headers, and was corrected"
        return HeaderTime(offset, unusable=unusable, remarks=(words, *remarks))


def _reference(known: dict[Source, tuple[Nanoseconds, Nanoseconds]]) -> Source:
    """Return the source whose clock counts: the one with most messages, preferably with the clock of reception."""
    offsets = {source: float(np.median(received - stamps)) for source, (received, stamps) in known.items()}
    near = [source for source, offset in offsets.items() if abs(offset) <= MIN_OFFSET]
    return max(near or known, key=lambda source: len(known[source][0]))


def _drift(received: Nanoseconds, stamps: Nanoseconds) -> float:
    """Return the largest difference of the clocks' offsets (ns) between parts of a log."""
    parts = np.array_split(received - stamps, min(PARTS, len(received)))
    medians = [float(np.median(one)) for one in parts]
    return max(medians) - min(medians)


def _ratio(received: Nanoseconds, stamps: Nanoseconds) -> float:
    span, headers = float(np.ptp(received)), float(np.ptp(stamps))
    return headers / max(span, 1.0) if headers > MIN_OFFSET else 1.0


def _ahead(received: Nanoseconds, stamps: Nanoseconds, clock: HeaderTime) -> float:
    """Return how far (ns) a source's headers are ahead of a clock, if possible only where both have messages."""
    inside = (received >= clock.received[0]) & (received <= clock.received[-1])
    chosen = inside if inside.any() else np.ones(len(received), bool)
    return float(np.median(stamps[chosen] - clock.of(received[chosen])))


def _grouped(found: Mapping[Source, float]) -> list[tuple[str, str, float]]:
    """Return each topic with a text that names it and its frames, and the largest of their values."""
    topics: dict[str, list[tuple[str, float]]] = {}
    for (topic, frame), value in found.items():
        topics.setdefault(topic, []).append((frame, value))
    rows: list[tuple[str, str, float]] = []
    for topic, entries in topics.items():
        frames = [f"'{frame}'" for frame, _ in entries if frame not in ("", topic.strip("/"))]
        listed = ", ".join(frames[:MAX_LISTED])
        listed += f" and {len(frames) - MAX_LISTED} more" if len(frames) > MAX_LISTED else ""
        largest = max((value for _, value in entries), key=abs)
        rows.append((topic, f"{listed} on '{topic}'" if frames else f"'{topic}'", largest))
    return rows


def _jump_words(_: str, called: str, back: float) -> str:
    way = "back" if back > 0 else "ahead"
    words = f"the headers of {called} jump {way} by {abs(back) / 1e9:.3f} s, so they are not used"
    return f"{words}: cut the log where a simulator was reset or a clock was set, and judge the parts"


def _delay_words(offset: int, topic: str) -> str:
    side = "after" if offset > 0 else "before"
    words = f"messages were received {abs(offset) / 1e9:.3f} s {side} the times in their headers"
    words += ", and those without a header, such as events, count when they were received"
    return f"{words}: if this is no delay but a wrong clock, pass --clock {topic}={-offset / 1e9:.3f} (seconds)"


def _late_words(topic: str, called: str, ahead: float, reference: str) -> str:
    side = "ahead of" if ahead > 0 else "behind"
    words = f"the headers of {called} are {abs(ahead) / 1e9:.3f} s {side} those of '{reference}', compared at reception"
    return f"{words}: if this is no delay but a wrong clock, pass --clock {topic}={ahead / 1e9:.3f} (seconds)"


def _other_words(topic: str, called: str, ahead: float, reference: str) -> str:
    side = "ahead of" if ahead > 0 else "behind"
    words = f"the headers of {called} are {abs(ahead) / 1e9:.3f} s {side} those of '{reference}'"
    hint = (
        f"pass --clock {topic}={ahead / 1e9:.3f} (seconds) if their clock is wrong, or --clock {topic}=0 if it is right"
    )
    return f"{words}, so they are not used: {hint}"
