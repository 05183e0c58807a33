"""Draws grammar rules as railroad diagrams: one picture of all rules of a construct."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from html import escape
from xml.etree import ElementTree

import railroad as rr  # pyright: ignore[reportMissingTypeStubs] -- it ships types without a marker

from robbdd_tools.syntax import grammar

STYLE = """
path { stroke-width: 2; stroke: #7a7f87; fill: none }
text { font: 14px monospace; text-anchor: middle; fill: #14181f }
.rule { font: bold 14px monospace; text-anchor: start; fill: #7a7f87 }
text.comment { font: italic 13px monospace; fill: #7a7f87 }
rect { stroke-width: 1; stroke: #7a7f87; fill: #dfe9f7 }
rect.terminal { fill: #d9f0dc }
text.terminal { font-weight: bold }
"""
WIDTH = 640
"""The width (in pixels) above which the parts of a rule are continued in the next row."""
HEADING = 26
"""The height of the name of a rule, in pixels."""
LEXICAL: Mapping[str, str] = {
    "Name": "name",
    "Text": '"text"',
    "Number": "number",
    "Quantity": "number unit",
    "PropertyName": "name",
    "ModuleName": "module",
    "PhraseWord": "word",
    "StudyText": '"text"',
    "StudyNumber": "number",
    "StudyName": "name",
    "StudyReference": "<name>",
    "StudyUnit": "unit",
}
"""Labels of rules that only match text."""
REFERENCE = re.compile(r"(\w+)Ref")
Rules = Mapping[str, grammar.Expression]


def drawing(shown: Iterable[tuple[str, grammar.Expression]], rules: Rules) -> str:
    """Return an SVG picture of some expressions below their names. ``rules`` are all rules of the grammar."""
    pictures: list[str] = []
    top, width = 0.0, 0.0
    for name, body in shown:
        diagram = rr.Diagram(_wrapped(body, rules)).format(8)
        pictures.append(f'<text class="rule" x="8" y="{top + HEADING - 8:g}">{escape(name)}</text>')
        pictures.append(f'<g transform="translate(0 {top + HEADING:g})">{"".join(_plain(diagram))}</g>')
        top += HEADING + float(diagram.attrs["height"])
        width = max(width, float(diagram.attrs["width"]))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:g}" height="{top:g}"'
        f' viewBox="0 0 {width:g} {top:g}">\n<style>{STYLE}</style>\n' + "\n".join(pictures) + "\n</svg>\n"
    )


def _plain(diagram: rr.Diagram) -> Iterator[str]:
    """Yield the lines of a diagram as one path, then its boxes and words, without the groups around them."""
    pieces: list[str] = []
    diagram.writeSvg(pieces.append)
    root = ElementTree.fromstring("".join(pieces))
    yield f'<path d="{"".join(path.attrib["d"] for path in root.iter("path"))}"/>'
    for group in root.iter("g"):
        kind = group.attrib.get("class", "").strip()
        for child in group:
            if child.tag == "rect":
                place = " ".join(f'{name}="{child.attrib[name]}"' for name in ("x", "y", "width", "height"))
                yield f'<rect class="{kind}" {place} rx="{child.attrib.get("rx", 0)}"/>'
            elif child.tag == "text":
                place = f'x="{child.attrib["x"]}" y="{child.attrib["y"]}"'
                yield f'<text class="{kind or "comment"}" {place}>{escape(child.text or "")}</text>'


def _wrapped(expression: grammar.Expression, rules: Rules) -> rr.DiagramItem:
    """Return the item of a rule; a long sequence is broken into rows."""
    parts = expression.parts if isinstance(expression, grammar.Sequence) else (expression,)
    rows: list[list[rr.DiagramItem]] = [[]]
    used = 0.0
    for part in parts:
        one = item(part, rules)
        if rows[-1] and used + one.width > WIDTH:
            rows.append([])
            used = 0.0
        rows[-1].append(one)
        used += one.width + 20
    drawn = [rr.Sequence(*row) if len(row) > 1 else row[0] for row in rows]
    return drawn[0] if len(drawn) == 1 else rr.Stack(*drawn)


def item(expression: grammar.Expression, rules: Rules) -> rr.DiagramItem:
    """Return the item of an expression."""
    match expression:
        case grammar.Literal(text):
            return rr.Terminal(text)
        case grammar.Pattern(pattern):
            return rr.Comment(pattern if len(pattern) < 40 else f"{pattern[:40]}…")
        case grammar.Use(rule):
            return _use(rule, rules)
        case grammar.Sequence(parts):
            return rr.Sequence(*(item(part, rules) for part in parts))
        case grammar.Choice(options):
            return rr.Choice(0, *(item(option, rules) for option in options))
        case grammar.Optional(part):
            return _optional(_wrapped(part, rules))
        case grammar.Assignment(operator=operator, value=value, separator=separator):
            one, between = item(value, rules), None if separator is None else item(separator, rules)
            if operator == "=":
                return one
            if operator == "?=":
                return _optional(one)
            several = rr.OneOrMore(one, between)
            return several if operator == "+=" else _optional(several)


def _optional(part: rr.DiagramItem) -> rr.DiagramItem:
    return rr.Choice(1, rr.Skip(), part)


def _use(rule: str, rules: Rules) -> rr.DiagramItem:
    reference = REFERENCE.fullmatch(rule)
    if rule == "NamespaceRef" or rule in LEXICAL:
        return rr.NonTerminal(LEXICAL.get(rule, "name"))
    if reference is not None:
        words = re.sub(r"(?<!^)(?=[A-Z])", " ", reference[1]).lower()
        return rr.NonTerminal(f"<{words}>")
    return item(rules[rule], rules) if is_words(rules[rule]) else rr.NonTerminal(rule)


def is_words(expression: grammar.Expression) -> bool:
    """Return whether an expression is a keyword or a choice of keywords."""
    options = expression.options if isinstance(expression, grammar.Choice) else (expression,)
    return all(isinstance(one, grammar.Literal) for one in options)
