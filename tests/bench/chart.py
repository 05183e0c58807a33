"""A scatter plot as SVG, for the studies in the documentation; legible on white and on black."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import ceil, floor, log10
from xml.sax.saxutils import escape

WIDTH, HEIGHT = 640, 400
LEFT, RIGHT, TOP, BOTTOM = 70, 190, 20, 50
"""Room around the plot for numbers and the legend, pixels."""
INK = "#8a8f98"
COLOURS = ("#3f8fd6", "#2ea043", "#e5534b", "#b877db", "#d29922", "#39c5cf")


@dataclass(frozen=True)
class Series:
    """Points (x, y) under one name; ``hollow`` ones share the colour of the series before."""

    name: str
    points: Sequence[tuple[float, float]]
    hollow: bool = False


def scatter(
    series: Sequence[Series],
    x_title: str,
    y_title: str,
    lines: Iterable[tuple[float, str]] = (),
    *,
    upright: bool = False,
) -> str:
    """Return a plot with a logarithmic y axis; ``lines`` are marked values of y, or of x where ``upright``."""
    xs = [x for one in series for x, _ in one.points]
    ys = [y for one in series for _, y in one.points]
    low, high = floor(log10(min(ys))), ceil(log10(max(ys)))
    step = _step(max(xs))
    right = step * ceil(max(xs) * 1.02 / step)

    def at(x: float, y: float) -> tuple[float, float]:
        across = LEFT + (WIDTH - LEFT - RIGHT) * x / right
        return across, HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * (log10(y) - low) / (high - low)

    found = [_line(at(0.0, 10.0**low), at(right, 10.0**low)), _line(at(0.0, 10.0**low), at(0.0, 10.0**high))]
    for power in range(low, high + 1):
        x, y = at(0.0, 10.0**power)
        found += [_text(x - 8, y + 4, f"{10.0**power:g}", "end"), _line((x, y), at(right, 10.0**power), faint=True)]
    for number in range(round(right / step) + 1):
        x, y = at(number * step, 10.0**low)
        found.append(_text(x, y + 18, f"{number * step:g}", "middle"))
    found.append(_text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 10, x_title, "middle"))
    found.append(
        f'<g transform="translate(16 {(TOP + HEIGHT - BOTTOM) / 2}) rotate(-90)">{_text(0, 0, y_title, "middle")}</g>'
    )
    for value, name in lines:
        ends = (at(value, 10.0**low), at(value, 10.0**high)) if upright else (at(0.0, value), at(right, value))
        found += [_line(*ends, dashed=True), _text(ends[1][0] + 6, ends[1][1] + 4, name, "start")]
    colour = -1
    for row, one in enumerate(series):
        colour += not one.hollow
        shade = COLOURS[colour % len(COLOURS)]
        found += [_dot(*at(*point), shade, hollow=one.hollow) for point in one.points]
        y = TOP + 30 + 18 * row
        found += [
            _dot(WIDTH - RIGHT + 16, y - 4, shade, hollow=one.hollow),
            _text(WIDTH - RIGHT + 26, y, one.name, "start"),
        ]
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif">'
    return "\n".join((head, *found, "</svg>", ""))


def _step(largest: float) -> float:
    """Return a round tick distance with at most six ticks up to the largest value."""
    power = 10.0 ** floor(log10(largest / 6))
    return next(factor * power for factor in (1, 2, 5, 10) if factor * power * 6 >= largest)


def _line(start: tuple[float, float], end: tuple[float, float], *, faint: bool = False, dashed: bool = False) -> str:
    dash = ' stroke-dasharray="6 4"' if dashed else ""
    place = f'x1="{start[0]:.1f}" y1="{start[1]:.1f}" x2="{end[0]:.1f}" y2="{end[1]:.1f}"'
    return f'<line {place} stroke="{INK}" stroke-opacity="{0.25 if faint else 1}"{dash}/>'


def _text(x: float, y: float, words: str, anchor: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" font-size="12" fill="{INK}" text-anchor="{anchor}">{escape(words)}</text>'


def _dot(x: float, y: float, colour: str, *, hollow: bool) -> str:
    fill = "none" if hollow else colour
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.5" fill="{fill}" stroke="{colour}"/>'
