"""Draw a clause's margin over time as a small SVG with its time window and events, for light and dark themes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

from robbdd_tools.run.report import MINUS, margin

WIDTH, HEIGHT = 320, 180
LEFT, RIGHT, TOP, BOTTOM = 64, 12, 34, 20
"""Margins of the plot for numbers and event names, pixels."""
INK, LINE, GOOD, BAD = "#8a8f98", "#3f8fd6", "#2ea043", "#e5534b"
"""Colours that are legible on white and on black."""
LETTER = 5.6
"""Approximate width of a letter of the event names, pixels."""
LEVELS = 2
"""Number of rows for event names, which would overlap in a single row."""


@dataclass(frozen=True, slots=True)
class _Frame:
    """Mapping of times (s) and margins to pixels."""

    duration: float
    low: float
    high: float

    def x(self, time: float) -> float:
        return round(LEFT + (WIDTH - LEFT - RIGHT) * time / self.duration, 1)

    def y(self, value: float) -> float:
        return round(TOP + (HEIGHT - TOP - BOTTOM) * (self.high - value) / (self.high - self.low), 1)


def plot(kept: Mapping[str, Any], line: int, operand: int | None = None) -> str | None:
    """Return the plot of the clause at a feature line as SVG, or ``None`` if there is nothing to plot.

    ``kept`` has the curves that are stored with a trace. If the clause has several fluents, the deciding one, number
    ``operand``, is plotted.
    """
    parts: Sequence[Mapping[str, Any]] = kept["clauses"].get(str(line), ())
    number = operand or 0
    if number >= len(parts) or not parts[number]["times"]:
        return None
    part = parts[number]
    low, high = min(0.0, *part["margins"]), max(0.0, *part["margins"])
    room = 0.08 * ((high - low) or 1.0)
    frame = _Frame(max(kept["duration"], part["times"][-1]) or 1.0, low - room, high + room)
    body = "".join(
        (*_window(frame, part), *_axes(frame, part, (low, high)), *_events(frame, kept["events"]), _curve(frame, part))
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}" '
        f'font-family="sans-serif" font-size="10" fill="{INK}">{body}{"".join(_decisive(frame, part))}</svg>'
    )


def _window(frame: _Frame, part: Mapping[str, Any]) -> Iterator[str]:
    if part["start"] is None:
        return
    start, end = frame.x(part["start"]), frame.x(part["end"])
    left, width = (start, end - start) if end - start >= 2 else (start - 1, 2)
    yield (
        f'<rect x="{left}" y="{TOP}" width="{width:.1f}" height="{HEIGHT - TOP - BOTTOM}" '
        f'fill="{LINE}" fill-opacity="0.22"/>'
    )


def _axes(frame: _Frame, part: Mapping[str, Any], bounds: tuple[float, float]) -> Iterator[str]:
    zero, bottom = frame.y(0.0), HEIGHT - BOTTOM
    yield f'<line x1="{LEFT}" y1="{zero}" x2="{WIDTH - RIGHT}" y2="{zero}" stroke="{INK}" stroke-dasharray="4 3"/>'
    yield f'<text x="{LEFT - 6}" y="{zero + 3}" text-anchor="end">0</text>'
    for value in bounds:
        # Leave out a number that would overlap the zero line's number.
        if abs(frame.y(value) - zero) > 11:
            words = margin(value, part["unit"]) or f"{value:+.0f}".replace("-", MINUS)
            yield f'<text x="{LEFT - 6}" y="{frame.y(value) + 3}" text-anchor="end">{escape(words, quote=False)}</text>'
    yield f'<text x="{LEFT}" y="{bottom + 13}">0 s</text>'
    yield f'<text x="{WIDTH - RIGHT}" y="{bottom + 13}" text-anchor="end">{frame.duration:.2f} s</text>'


def _events(frame: _Frame, events: Iterable[Mapping[str, Any]]) -> Iterator[str]:
    ends = [0.0] * LEVELS
    for event in events:
        name = event["name"].rpartition(":")[2].removeprefix("evt-")
        x, width = frame.x(event["time"]), LETTER * len(name)
        yield f'<line x1="{x}" y1="{TOP}" x2="{x}" y2="{HEIGHT - BOTTOM}" stroke="{INK}" stroke-opacity="0.55"/>'
        left = min(max(x - width / 2, 2.0), WIDTH - width - 2)
        level = next((level for level in range(LEVELS) if ends[level] < left), None)
        if level is not None:
            ends[level] = left + width + 4
            yield f'<text x="{left:.1f}" y="{TOP - 5 - 13 * level}">{escape(name, quote=False)}</text>'


def _curve(frame: _Frame, part: Mapping[str, Any]) -> str:
    points: Sequence[tuple[float, float]] = list(zip(part["times"], part["margins"], strict=True))
    path = " ".join(f"{frame.x(time)},{frame.y(value)}" for time, value in points)
    return f'<polyline points="{path}" fill="none" stroke="{LINE}" stroke-width="1.6" stroke-linejoin="round"/>'


def _decisive(frame: _Frame, part: Mapping[str, Any]) -> Iterator[str]:
    """Yield the deciding point in the window: the smallest margin, or the largest one if it needs to hold only once."""
    if part["start"] is None:
        return
    inside = [
        (value, time)
        for time, value in zip(part["times"], part["margins"], strict=True)
        if part["start"] - 1e-6 <= time <= part["end"] + 1e-6
    ]
    if inside:
        # Earlier versions did not store which margin decides.
        value, time = max(inside, key=lambda point: point[0]) if part.get("some_time", False) else min(inside)
        color = GOOD if (value >= 0) != part["negated"] else BAD
        yield f'<circle cx="{frame.x(time)}" cy="{frame.y(value)}" r="4" fill="{color}"/>'
