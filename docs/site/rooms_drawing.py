"""Writes ``docs/images/rooms.svg``, the packages and their layers: ``.venv/bin/python docs/site/rooms_drawing.py``.

The layers are those that ``tests/test_architecture.py`` enforces.
"""

from __future__ import annotations

import runpy
from collections.abc import Iterator, Sequence
from pathlib import Path

ROOT = Path(__file__).parents[2]
PICTURE = ROOT / "docs" / "images" / "rooms.svg"
RULES = ROOT / "tests" / "test_architecture.py"
WIDTH, ROW, GAP, TOP, LEFT, MAIN, AGENT = 820, 34, 6, 34, 10, 550, 574
"""Pixels: width of the picture, height of a layer, space between boxes and above them, left edge and width of the main
process, left edge of the agent processes."""
INK, BOX, EDGE = "#57606a", "#ddf4ff", "#3f8fd6"
PURPOSE = {
    "start": "entry points",
    "lsp": "language server",
    "dap": "debug adapter",
    "cli": "arguments",
    "commands": "command line",
    "pytest_plugin": "pytest",
    "campaign": "decisions from many executions",
    "workbench": "load, check, plan, run, judge",
    "run": "run folders, agents, results",
    "checks": "rules",
    "features": "of editors",
    "gherkin": "for behave",
    "graph": "knowledge graph: RDF, SHACL, SPARQL",
    "names": "symbols, scopes, imports",
    "syntax": "text to trees",
    "logs": "recordings of real robots",
    "traces": "stored traces",
    "protocol": "what a run and its agents exchange",
    "catalog": "predicates, behaviours, robots, objects",
    "monitor": "windows, margins, verdicts",
    "catalog.api": "types of the catalog",
    "base": "documents, spans, files, processes",
    "agent": "executes scenarios",
    "judging": "clauses",
    "world": "MuJoCo",
    "user_code": "calls of users' code",
}


Rows = Sequence[Sequence[str]]
Box = tuple[str, float, float, float]
"""A package, its left and upper edge, and its width, pixels."""


def drawing(shared: Rows, main: Rows, branch: Rows) -> str:
    """Return the picture as SVG: what both kinds of processes use, and what each has. The lowest row is first."""
    floor = TOP + len(main) * (ROW + GAP)
    height = floor + len(shared) * (ROW + GAP) + GAP
    boxes = [*column(shared, LEFT, WIDTH - 2 * LEFT, height - GAP), *column(main, LEFT, MAIN, floor)]
    boxes += column(branch, AGENT, WIDTH - LEFT - AGENT, floor)
    (start,) = (top for name, _, top, _ in boxes if name == "run")
    highest = min(top for name, _, top, _ in boxes if name in branch[-1])
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" '
            f'font-family="sans-serif" font-size="12" fill="{INK}">',
            f'<rect width="{WIDTH}" height="{height}" fill="white"/>',
            text(LEFT, TOP - 12, "robbdd, robbdd-lsp"),
            text(AGENT, highest - 12, "agent processes"),
            *(box(*one) for one in boxes),
            arrow(LEFT + MAIN, start + ROW / 2, WIDTH - LEFT - 60, highest),
            "</svg>\n",
        ]
    )


def column(rows: Sequence[Sequence[str]], left: float, width: float, bottom: float) -> Iterator[Box]:
    """Yield the boxes of layers that stand on each other."""
    for number, names in enumerate(rows, start=1):
        each = (width - GAP * (len(names) - 1)) / len(names)
        for place, name in enumerate(sorted(names)):
            yield name, left + place * (each + GAP), bottom - number * (ROW + GAP), each


def box(name: str, left: float, top: float, width: float) -> str:
    """Return a package as a box with its name and, if there is room, its purpose."""
    wide = width > 110
    title = f'<tspan font-weight="bold">{name}</tspan>' + (f" {PURPOSE[name]}" if wide else "")
    return (
        f'<rect x="{left:.0f}" y="{top:.0f}" width="{width:.0f}" height="{ROW}" rx="4" fill="{BOX}" stroke="{EDGE}"/>'
        f'<text x="{left + 8:.0f}" y="{top + 21:.0f}">{title}</text>'
    )


def text(left: float, top: float, words: str) -> str:
    """Return a title."""
    return f'<text x="{left}" y="{top}" font-size="14">{words}</text>'


def arrow(left: float, top: float, right: float, bottom: float) -> str:
    """Return an arrow to the right and down: from the package that starts processes to these processes."""
    point = f"M{right - 4} {bottom - 8} h8 l-4 7 z"
    return (
        f'<path d="M{left} {top} H{right} V{bottom - 8}" stroke="{INK}" stroke-dasharray="4 3" fill="none"/>'
        f'<path d="{point}"/>{text(left + 12, top - 8, "starts, talks to")}'
    )


def rows_of_the_rules() -> tuple[Rows, Rows, Rows]:
    """Return the layers as the tests enforce them: those of both kinds of processes, then those of each."""
    rules = runpy.run_path(str(RULES))
    shared: set[str] = rules["EVIDENCE"]
    layers: list[list[str]] = [sorted(names) for names in rules["LAYERS"]]
    branch: dict[str, set[str]] = rules["BRANCH"]
    heights = sorted({len(allowed) for allowed in branch.values()})
    return (
        [names for names in layers if names[0] in shared],
        [names for names in layers if names[0] not in shared],
        [sorted(name for name, allowed in branch.items() if len(allowed) == height) for height in heights],
    )


if __name__ == "__main__":
    PICTURE.write_text(drawing(*rows_of_the_rules()), encoding="utf-8")
