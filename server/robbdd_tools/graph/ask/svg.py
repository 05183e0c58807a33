"""Draw the structure of a graph with one column each for stories, variants, templates, clauses and events.

Below the events are the nodes of behaviour trees, each one below its parent. Every link leads from a column to
a column further right, so the layout only chooses heights. Clauses are stacked in written order, and every other node
is centred on the nodes that it links to. A library for layered layout would have nothing left to decide.
"""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from xml.sax.saxutils import escape, quoteattr

from robbdd_tools.base.printable import printable
from robbdd_tools.graph.ask.structure import Node, Structure
from robbdd_tools.graph.write.source_map import Location

COLOURS = {
    "story": "#cfe3f5",
    "variant": "#fbe3b0",
    "template": "#e4d7ee",
    "given": "#cdeadf",
    "when": "#f9d3bd",
    "then": "#d5dde8",
    "event": "#f6f2c4",
    "node": "#e3e3e3",
}
"""Fill of each concept. The tints are distinguishable with any colour vision, and each concept has its own shape."""
STROKES = {
    "story": "#0060a0",
    "variant": "#a06a00",
    "template": "#6b3f8f",
    "given": "#00735a",
    "when": "#b04a00",
    "then": "#44546a",
    "event": "#7a7000",
    "node": "#4d4d4d",
}
WORDS = {
    "story": "User story",
    "variant": "Scenario variant",
    "template": "Scenario template",
    "event": "Event",
    "node": "Tree node",
}
COLUMNS = (("story", 210), ("variant", 180), ("template", 190), ("clause", 300), ("event", 170))
"""Columns from left to right with their widths in px."""
SPACE, MARGIN, LINE, PADDING, GAP, INDENT = 70, 24, 16, 8, 12, 18
LETTER = 6.4
"""Mean width (px) of a letter at 12 px. Text is wrapped by this width, because font metrics are not available."""
STYLE = (
    "text{font:12px 'DejaVu Sans',Verdana,Arial,sans-serif;fill:#1b1b1b}"
    ".name{font-weight:bold}.role{font-size:10px;letter-spacing:.04em}"
    ".link{fill:none;stroke:#8a8f98;stroke-width:1.2}.duration{stroke-dasharray:3 4;opacity:.7}"
)


@dataclass(frozen=True, slots=True)
class _Box:
    node: Node
    x: float
    y: float
    width: float
    height: float
    lines: tuple[tuple[str, str], ...]

    @property
    def middle(self) -> float:
        return self.y + self.height / 2

    @property
    def bottom(self) -> float:
        return self.y + self.height


def draw(structure: Structure, source: Callable[[Location], str]) -> str:
    """Return a structure as SVG. ``source`` converts the location of a node to a text such as ``model.bdd:3:7``."""
    boxes = _laid_out(structure)
    right = MARGIN * 2 + sum(width for _, width in COLUMNS) + SPACE * (len(COLUMNS) - 1)
    bottom = max((box.bottom for box in boxes.values()), default=MARGIN) + 70
    drawn = [
        _link(boxes[start], boxes[end], kind) for start, end, kind in structure.links if {start, end} <= boxes.keys()
    ]
    shapes = [_shape(box, source) for box in boxes.values()]
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {right} {bottom:g}" width="{right}" '
            f'height="{bottom:g}">',
            f"<style>{STYLE}</style>",
            '<defs><marker id="tip" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7" orient="auto">'
            '<path d="M0 0L8 4L0 8z" fill="#8a8f98"/></marker></defs>',
            f'<rect width="{right}" height="{bottom:g}" fill="#ffffff"/>',
            *dict.fromkeys(drawn),
            *shapes,
            '<g class="legend">',
            *_legend(bottom - 34),
            "</g>",
            "</svg>",
            "",
        ]
    )


def _laid_out(structure: Structure) -> dict[str, _Box]:
    """Place all nodes: first clauses, then the nodes that link to them, and last the events.

    Events are placed next to the clauses that name them.
    """
    boxes: dict[str, _Box] = {}
    lefts = _lefts()
    owners = {end: start for start, end, _ in structure.links}
    y, before = float(MARGIN), ""
    for clause in structure.clauses:
        top = _owner(clause.iri, owners, {node.iri for node in structure.clauses})
        y += GAP if before and top != before else 0
        left, width = lefts["clause"]
        indent = INDENT * min(clause.depth, 5)
        boxes[clause.iri] = box = _box(clause, left + indent, y, width - indent)
        y, before = box.bottom + GAP, top
    targets: dict[str, list[str]] = {}
    sources: dict[str, list[str]] = {}
    for start, end, _ in structure.links:
        targets.setdefault(start, []).append(end)
        sources.setdefault(end, []).append(start)
    layers = (structure.templates, targets), (structure.variants, targets), (structure.stories, targets)
    for nodes, beside in (*layers, (structure.events, sources)):
        _stack(nodes, beside, boxes, lefts)
    left, width = lefts["event"]
    y = max((boxes[event.iri].bottom for event in structure.events), default=float(MARGIN)) + 2 * GAP
    for node in structure.tree_nodes:
        indent = INDENT * min(node.depth, 5)
        boxes[node.iri] = box = _box(node, left + indent, y, width - indent)
        y = box.bottom + GAP
    return boxes


def _owner(clause: str, owners: Mapping[str, str], clauses: set[str]) -> str:
    """Return the template or variant of a clause. The clause may be inside groups."""
    owner = owners.get(clause, "")
    while owner in clauses:
        owner = owners[owner]
    return owner


def _stack(
    nodes: Sequence[Node],
    beside: Mapping[str, Sequence[str]],
    boxes: dict[str, _Box],
    lefts: Mapping[str, tuple[float, float]],
) -> None:
    """Place the nodes of a layer. If there is room, each node is centred on the nodes to which it is linked."""
    wanted: list[tuple[float, int, _Box]] = []
    for number, node in enumerate(nodes):
        middles = [boxes[other].middle for other in beside.get(node.iri, ()) if other in boxes]
        box = _box(node, *lefts[node.concept][:1], 0.0, lefts[node.concept][1])
        middle = sum(middles) / len(middles) if middles else float("inf")
        wanted.append((middle - box.height / 2, number, box))
    y = float(MARGIN)
    for top, _, box in sorted(wanted, key=lambda entry: entry[:2]):
        y = max(y, top) if top != float("inf") else y
        boxes[box.node.iri] = _Box(box.node, box.x, y, box.width, box.height, box.lines)
        y += box.height + GAP


def _lefts() -> dict[str, tuple[float, float]]:
    """Return left edge and width of each column."""
    found: dict[str, tuple[float, float]] = {}
    x = float(MARGIN)
    for name, width in COLUMNS:
        found[name] = (x, float(width))
        x += width + SPACE
    return found


def _box(node: Node, x: float, y: float, width: float) -> _Box:
    letters = max(8, int((width - 3 * PADDING) / LETTER))
    lines: list[tuple[str, str]] = []
    if node.concept in ("given", "when", "then"):
        lines.append(("role", node.concept.capitalize()))
    if node.name:
        lines += [("name", line) for line in _wrapped(node.name, int(letters * 0.88))]
    lines += [("text", line) for text in node.lines for line in _wrapped(text, letters)]
    return _Box(node, x, y, width, len(lines) * LINE + 2 * PADDING, tuple(lines))


def _wrapped(text: str, letters: int) -> list[str]:
    return textwrap.wrap(text, letters, break_on_hyphens=False) or [""]


def _shape(box: _Box, source: Callable[[Location], str]) -> str:
    node = box.node
    place = "" if node.location is None else source(node.location)
    said = WORDS.get(node.concept, node.concept.capitalize())
    title = f"{said} {node.name or ' '.join(node.lines)}" + (f" ({place})" if place else "")
    attributes = f"data-concept={_attribute(node.concept)} data-iri={_attribute(node.iri)}"
    if place:
        attributes += f" data-source={_attribute(place)}"
    x = box.x + PADDING * (2 if node.concept in ("event", "variant") else 1.5)
    text = "".join(
        f'<text class="{kind}" x="{x:g}" y="{box.y + PADDING + LINE * number + 12:g}">{_text(line)}</text>'
        for number, (kind, line) in enumerate(box.lines)
    )
    return f"<g {attributes}><title>{_text(title)}</title>{_outline(box)}{text}</g>"


def _outline(box: _Box) -> str:
    """Return the outline of a box.

    Each concept has its shape: a page, a pill, a framed box, a box with a bar, a hexagon.
    """
    x, y, width, height = box.x, box.y, box.width, box.height
    stroke = STROKES[box.node.concept]
    paint = f'fill="{COLOURS[box.node.concept]}" stroke="{stroke}" stroke-width="1.5"'
    match box.node.concept:
        case "story":
            fold = 12
            points = [(x, y), (x + width - fold, y), (x + width, y + fold), (x + width, y + height), (x, y + height)]
            return _polygon(points, paint)
        case "variant":
            return _rectangle(x, y, width, height, f'rx="{min(16, height / 2):g}" {paint}')
        case "template":
            line = f'fill="none" stroke="{stroke}" stroke-width=".6"'
            return _rectangle(x, y, width, height, paint) + _rectangle(x + 3, y + 3, width - 6, height - 6, line)
        case "event":
            tip = 10
            points = [(x + tip, y), (x + width - tip, y), (x + width, box.middle), (x + width - tip, y + height)]
            return _polygon([*points, (x + tip, y + height), (x, box.middle)], paint)
        case "node":
            return _rectangle(x, y, width, height, f'rx="4" {paint}')
        case _:
            return _rectangle(x, y, width, height, paint) + _rectangle(x, y, 5, height, f'fill="{stroke}"')


def _rectangle(x: float, y: float, width: float, height: float, paint: str) -> str:
    return f'<rect x="{x:g}" y="{y:g}" width="{width:g}" height="{height:g}" {paint}/>'


def _polygon(points: Iterable[tuple[float, float]], paint: str) -> str:
    return f'<polygon points="{" ".join(f"{x:g},{y:g}" for x, y in points)}" {paint}/>'


def _link(start: _Box, end: _Box, kind: str) -> str:
    """Draw a link as a curve from one box to another.

    It leads to the next column, or from a group down along its left side to its members.
    """
    style = "link duration" if kind == "duration" else "link"
    if end.x < start.x + start.width:
        x = start.x + 5
        path = f"M{x:g} {start.bottom:g}V{end.middle:g}H{end.x:g}"
    else:
        bend = (end.x - start.x - start.width) / 2
        x, top, bottom = start.x + start.width, start.middle, end.middle
        path = f"M{x:g} {top:g}C{x + bend:g} {top:g} {end.x - bend:g} {bottom:g} {end.x:g} {bottom:g}"
    ends = f"data-from={_attribute(start.node.iri)} data-to={_attribute(end.node.iri)}"
    return f'<path class="{style}" {ends} d="{path}" marker-end="url(#tip)"/>'


def _legend(y: float) -> Iterable[str]:
    samples = [
        (_outline(_Box(Node("", concept, ""), 0, 0, 26, 18, ())), WORDS.get(concept, concept.capitalize()))
        for concept in COLOURS
    ]
    samples += [
        (f'<path class="{style}" d="M0 9h26" marker-end="url(#tip)"/>', word)
        for style, word in (("link", "leads to"), ("link duration", "lasts from and until"))
    ]
    x = float(MARGIN)
    for sample, word in samples:
        yield f'<g transform="translate({x:g} {y:g})">{sample}<text x="32" y="13">{word}</text></g>'
        x += 64 + len(word) * LETTER


def _text(text: str) -> str:
    return escape(printable(text))


def _attribute(text: str) -> str:
    return quoteattr(printable(text))
