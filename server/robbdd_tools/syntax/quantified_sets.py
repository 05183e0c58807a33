"""Explain a set that is written out in ``for all`` or ``exists``, which run over a named set."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.syntax.declaration import SyntaxFault, SyntaxFix

if TYPE_CHECKING:
    from robbdd_tools.syntax.parsed import Rejected

_QUANTIFIER = re.compile(r"\(\s*var\s+(?P<variable>[^\W\d][\w\-]*)\s+(?:exists\s+)?in\s*\Z")
_SET = re.compile(r"\{[^{}]*\}")
_TEMPLATE = re.compile(r"Scenario\s+Template\s*(?P<namespace>\(\s*ns\s*=\s*[\w\-]+\s*\)\s*)?")
_ADVICE = "a quantifier runs over a named set: declare '{0}', and write '<{1}>' here"
LONGEST = 120
"""Maximum number of characters from the parenthesis to the set."""


@dataclass(frozen=True, slots=True)
class WrittenSet:
    """A set that is written out: its span, and the variable of its quantifier."""

    span: Span
    variable: str


def written_set(text: str, offset: int) -> WrittenSet | None:
    """Return the set at an offset that is written out in a quantifier."""
    written = _SET.match(text, offset)
    quantifier = _QUANTIFIER.search(text, max(0, offset - LONGEST), offset)
    return None if written is None or quantifier is None else WrittenSet(Span(*written.span()), quantifier["variable"])


def set_in_quantifier(text: str, rejected: Rejected) -> SyntaxFault | None:
    """Return the fault of such a set; ``None`` if the parser stopped elsewhere.

    In a template, the fix declares the set above the template.
    """
    found = written_set(text, rejected.offset)
    if found is None:
        return None
    name, span = f"{found.variable}-values", found.span
    template = _TEMPLATE.match(text)
    namespace = "" if template is None else " ".join((template["namespace"] or "").split())
    declared = f"const set {namespace}{' ' if namespace else ''}{name} {' '.join(text[span.start : span.end].split())}"
    message = _ADVICE.format(declared, name)
    if template is None:
        return SyntaxFault(span, message)
    fixed = f"{declared}\n\n{text[: span.start]}<{name}>"
    return SyntaxFault(span, message, SyntaxFix(Span(0, span.end), fixed, f"Declare it as '{name}'"))
