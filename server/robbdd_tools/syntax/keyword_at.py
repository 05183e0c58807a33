"""Find the keyword at an offset, and the grammar rule that it belongs to."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import TYPE_CHECKING, Any, cast

from robbdd_tools.base.document import Span
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.chunk import parse_chunk
from robbdd_tools.syntax.constructs import literals, read_rules, uses
from robbdd_tools.syntax.grammar_files import grammar_name
from robbdd_tools.syntax.parsed import Parsed, RawNode
from robbdd_tools.syntax.recover import recover
from robbdd_tools.syntax.story import STAND_IN

if TYPE_CHECKING:
    from robbdd_tools.syntax.declaration import Declaration

CACHED = 4
"""Number of texts whose parsed objects are cached: a reader usually hovers over nearby places."""
PHRASE_WORD = "PhraseWord"
"""The rule of the words in a named predicate's phrase. Such a word may be spelt like a keyword."""
_STORY = re.compile(r"\s*User\b")


@dataclass(frozen=True, slots=True)
class Keyword:
    """A keyword in a chunk, and the rule that contains it. The rule is empty if errors hide the chunk's structure."""

    word: str
    rule: str
    span: Span


def keyword_in_part(language: str, part: Declaration, offset: int) -> Keyword | None:
    """Return the keyword at an offset of a declaration or of a part of a story."""
    if offset < 0 or offset >= len(part.text):
        return None
    if isinstance(part.tree, tree.Variant):
        return keyword_at("scenario", part.text, offset)
    # The text before the scenarios of a story is not a declaration by itself.
    begins_story = part.tree is None and _STORY.match(part.text)
    return keyword_at(language, f"{part.text}{STAND_IN}}}" if begins_story else part.text, offset)


def keyword_at(language: str, text: str, offset: int) -> Keyword | None:
    """Return the keyword of a chunk at an offset, ``None`` if there is none."""
    for match in keyword_tokens(language).finditer(text):
        if match.end() > offset:
            break
    else:
        return None
    if match.start() > offset or match["word"] is None:
        return None
    span = Span(*match.span())
    declaration = _declaration(language, text)
    if declaration is None:
        return Keyword(match["word"], "", span)
    innermost = type(_around(declaration, offset)[-1]).__name__
    rule = PHRASE_WORD if innermost == PHRASE_WORD else _rule_of(language, innermost, match["word"])
    return None if rule is None else Keyword(match["word"], rule, span)


@cache
def keyword_tokens(language: str) -> re.Pattern[str]:
    """Return a regular expression that matches tokens. Only keywords are in its group ``word``."""
    every = {
        text for rule in read_rules(grammar_name(language)).values() for text in literals(rule) if text[0].isalpha()
    }
    words = "|".join(re.escape(word) for word in sorted(every, key=lambda word: (-len(word), word)))
    return re.compile(
        r"//[^\n]*|\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])*'|<[^<>\n]*>"
        rf"|(?P<word>(?<![\w\-.])(?:{words})(?![\w\-]))|[^\W\d][\w\-]*|\S"
    )


@lru_cache(maxsize=CACHED)
def _declaration(language: str, text: str) -> RawNode | None:
    parsed = parse_chunk(language, text)
    if not isinstance(parsed, Parsed):
        parsed = recover(language, text, parsed).parsed
    return None if parsed is None else parsed.declaration


def _around(root: RawNode, offset: int) -> list[RawNode]:
    """Return the objects that contain an offset, the outermost first."""
    found: list[RawNode] = []
    node: RawNode | None = root
    while node is not None:
        found.append(node)
        node = next((child for child in children(node) if _contains(child, offset)), None)
    return found


def children(node: RawNode) -> Iterator[RawNode]:
    """Yield the objects that are parts of an object."""
    for name, value in cast("dict[str, Any]", vars(node)).items():
        if name.startswith("_") or name == "parent":  # textX's own attributes
            continue
        for one in cast("list[Any]", value) if isinstance(value, list) else (value,):
            if hasattr(one, "_tx_position"):
                yield one


def _contains(node: RawNode, offset: int) -> bool:
    return bool(node._tx_position <= offset < node._tx_position_end)


@cache
def _rule_of(language: str, rule: str, word: str) -> str | None:
    """Return the rule that contains a keyword: ``rule`` itself, or a text rule that it uses."""
    rules = read_rules(grammar_name(language))
    waiting, seen = [rule], {rule}
    while waiting:
        name = waiting.pop(0)
        if word in literals(rules[name]):
            return name
        inner = [used for used in uses(rules[name]) if used not in seen and _is_text(rules, used)]
        seen.update(inner)
        waiting += inner
    return None


def _is_text(rules: Any, rule: str) -> bool:
    return not any(True for _ in uses(rules[rule])) and any(True for _ in literals(rules[rule]))
