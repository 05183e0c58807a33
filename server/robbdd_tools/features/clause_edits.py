"""Text edits that remove clauses from a conjunction or add clauses to one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.names.elements import Site

Change = tuple[Span, str]
"""A span and its replacement text (empty span: insertion)."""
_STEP = 4


def operands(expression: tree.Expression) -> tuple[tree.Expression, ...]:
    """Return the operands of a conjunction."""
    bare = tree.bare(expression)
    return bare.operands if isinstance(bare, tree.Conjunction) else (bare,)


def removals(spans: Sequence[Span], gone: Sequence[bool]) -> Iterator[Span]:
    """Yield the spans to delete in order to remove some operands of a conjunction.

    ``gone`` marks the operands to remove. At least one operand must remain. Each span includes the ``and`` that is no
    longer needed.
    """
    first_kept = gone.index(False)
    for position, span in enumerate(spans):
        if gone[position] and position < first_kept:
            yield Span(span.start, spans[position + 1].start)
        elif gone[position]:
            yield Span(spans[position - 1].end, span.end)


def additions(site: Site, body: tree.Body, label: str, texts: Sequence[str]) -> Iterator[Change]:
    """Yield the changes that add clauses to the end of the first ``Given`` or the last ``Then`` of a template.

    Spans count from the start of the template's declaration. In ``texts``, all lines but the first must have no
    indentation of their own.
    """
    part = body.parts[0 if label == "Given" else -1]
    there = part.given if label == "Given" else part.then
    if there is None:
        yield _new_label(site, part, label, texts)
        return
    every = operands(there)
    inner = column(site, every[0].span.start)
    in_a_row = isinstance(there, tree.Conjunction) and there.span.start == there.operands[0].span.start
    if in_a_row or len(every) > 1:
        end = every[-1].span.end
        yield Span(end, end), _behind(texts, inner, "" if in_a_row else "and")
        return
    outer, inner = inner, inner + _STEP
    yield Span(there.span.start, there.span.start), f"({_line(inner)}"
    yield Span(there.span.end, there.span.end), f"{_behind(texts, inner, 'and')}{_line(outer)})"


def changed(text: str, span: Span, changes: Iterable[Change]) -> str:
    """Return the place of a span after some changes of the text. Their spans count from the start of the text."""
    piece = text[: span.end]
    for place, new in sorted(changes, key=lambda change: change[0], reverse=True):
        piece = piece[: place.start] + new + piece[place.end :]
    return piece[span.start :]


def column(site: Site, offset: int) -> int:
    """Return the column at which further clauses are indented.

    This is the column of the offset if nothing precedes it on its line. Otherwise it is one step more than the line's
    indentation.
    """
    document = site.file.document
    place = document.position(site.placed.offset + offset)
    line = document.line_text(place.line)
    indent = len(line) - len(line.lstrip())
    return indent if indent == place.column else indent + _STEP


def unindented(text: str, by: int) -> str:
    """Return a text in which the indentation of all lines but the first is reduced by ``by`` columns."""
    first, *rest = text.splitlines(keepends=True)
    return "".join((first, *(line[min(by, len(line) - len(line.lstrip(" "))) :] for line in rest)))


def _new_label(site: Site, part: tree.Part, label: str, texts: Sequence[str]) -> Change:
    """Return the change that adds a new ``Given`` at the start of a part, or a new ``Then`` at its end."""
    middle = part.when or part.for_all
    assert middle is not None
    outer = column(site, middle.span.start)
    inner = outer + _STEP
    first, *rest = texts
    clauses = _indented(first, inner)
    if rest:
        deeper = inner + _STEP
        clauses = f"({_line(deeper)}{_indented(first, deeper)}{_behind(rest, deeper, 'and')}{_line(inner)})"
    text = f"{label}:{_line(inner)}{clauses}"
    if label == "Given":
        return Span(middle.span.start, middle.span.start), f"{text}{_line(outer)}"
    return Span(middle.span.end, middle.span.end), f"{_line(outer)}{text}"


def _behind(texts: Iterable[str], indent: int, link: str) -> str:
    linked = f"{_line(indent)}{link}" if link else ""
    return "".join(f"{linked}{_line(indent)}{_indented(text, indent)}" for text in texts)


def _indented(text: str, by: int) -> str:
    return text.replace("\n", _line(by))


def _line(indent: int) -> str:
    return "\n" + " " * indent
