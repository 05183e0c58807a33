"""Find the behaviours of the catalog that are nearest to an unknown one in a When."""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.syntax.declaration import SyntaxFault, SyntaxFix
from robbdd_tools.syntax.unknown_phrases import nearest_phrases

if TYPE_CHECKING:
    from robbdd_tools.syntax.parsed import Rejected

LONGEST = 300
"""Maximum number of characters from the agent to an error."""
_REST = re.compile(r"[^{}()\n:]*?(?=\s*(?:[{}()\n]|\Z|(?<![\w\-])(?:emits|node|from)(?![\w\-])))")


def behaviour_fault(text: str, rejected: Rejected) -> SyntaxFault | None:
    """Return the fault of an unknown behaviour, or ``None`` if the parser stopped elsewhere."""
    offset, expected = rejected.offset, rejected.expected.literals
    if expected.isdisjoint(_verbs()) or not text[offset : offset + 1].isalpha():
        return None
    agent = _agent().search(text, max(0, offset - LONGEST), offset)
    rest = _REST.match(text, offset)
    if agent is None or rest is None:
        return None
    words = Span(agent.start("words"), max(rest.end(), offset))
    written = text[words.start : words.end]
    nearest = nearest_phrases(written, _phrases())
    every = [(phrase, None) for phrase, _ in _phrases()]
    listed = ", ".join(f"'{phrase}'" for phrase, _ in nearest or every)
    many = "are" if len(nearest) > 1 else "is"
    found = f"the nearest {many} {listed}" if nearest else f"there are {listed}"
    fix = next((fix for _, fix in nearest[:1] if fix), None)
    message = f"there is no behaviour '{' '.join(written.split())}': {found}"
    return SyntaxFault(words, message, None if fix is None else SyntaxFix(words, fix, f"Change to '{fix}'"))


@cache
def _agent() -> re.Pattern[str]:
    """Return the pattern of an agent, and of a behaviour that has begun: ``<robot>``, ``<robot> picks <part> and``."""
    begun = rf"(?:{'|'.join(map(re.escape, sorted(_verbs())))})\s[^{{}}():]*"
    return re.compile(rf"<[^<>\n]*>\s*(?P<words>(?:{begun})?)\Z")


@cache
def _phrases() -> tuple[tuple[str, tuple[str, ...]], ...]:
    behaviours = load_catalog().behaviours.values()
    return tuple((word.phrase, tuple(map(str, word.synonyms))) for word in behaviours)


@cache
def _verbs() -> frozenset[str]:
    """Return the first words of behaviours after the agent."""
    return frozenset(phrase.partition("> ")[2].partition(" ")[0] for phrase, _ in _phrases())
