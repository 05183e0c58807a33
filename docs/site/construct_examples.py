"""Finds an example of each construct of the language in the models of this repository."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from itertools import islice
from pathlib import Path
from typing import Any

from robbdd_tools.base.document import Span
from robbdd_tools.base.files import load_text
from robbdd_tools.syntax import grammar
from robbdd_tools.syntax.chunk import parse_chunk
from robbdd_tools.syntax.constructs import Construct, literals, read_rules
from robbdd_tools.syntax.grammar_files import grammar_name
from robbdd_tools.syntax.keyword_at import children, keyword_tokens
from robbdd_tools.syntax.parsed import Parsed
from robbdd_tools.syntax.split import split

ROOT = Path(__file__).parents[2]
FOLDERS = (ROOT / "docs" / "language" / "examples", ROOT / "examples")
"""Where examples are looked for: those written for the reference are preferred."""
MOST = 3
"""Examples of one construct."""


@dataclass(frozen=True, slots=True)
class Example:
    """A part of a model that has a construct."""

    path: Path
    span: Span

    @property
    def text(self) -> str:
        """The lines that have it, without the margin of the first one; a part of one line becomes the whole line."""
        whole = load_text(self.path)
        first = whole.rfind("\n", 0, self.span.start) + 1
        last = whole.find("\n", self.span.end - 1)
        begins = "" if "\n" not in whole[self.span.start : self.span.end] else whole[first : self.span.start]
        start = self.span.start if begins.strip() else first
        lines = whole[start : last if last >= 0 else len(whole)].splitlines()
        margin = len(whole[first:]) - len(whole[first:].lstrip())
        return "\n".join([lines[0].strip(), *(_without(line, margin) for line in lines[1:])]).rstrip()


def _without(line: str, margin: int) -> str:
    return line[min(margin, len(line) - len(line.lstrip())) :]


def examples(construct: Construct) -> list[Example]:
    """Return examples of a construct: one for each rule that its section names, or one of its keywords."""
    languages = LANGUAGES if construct.source == "base" else (construct.source,)
    found: list[Example] = []
    for rule in construct.rules:
        every = [one for language in languages for one in _written(language).get(rule, ())]
        best = min(every, key=_rank, default=None)
        if best is not None and not any(_has(one, best) for one in found):
            found.append(best)
    for word in () if found else construct.words:
        every = [one for language in languages for one in _after_keyword(language).get(word, ())]
        found += [min(every, key=_rank)] if every and not found else []
    if not found:
        words = {word for rule in construct.rules for word in _words_of(languages, rule)}
        found += list(islice(_with_words(languages, words), 1))
    return found[:MOST]


def _words_of(languages: tuple[str, ...], rule: str) -> Iterator[str]:
    for language in languages:
        if rule in read_rules(language):
            yield from literals(read_rules(language)[rule])


def _with_words(languages: tuple[str, ...], words: set[str]) -> Iterator[Example]:
    """Yield the places of some keywords: of rules such as units, which have no objects."""
    for language in languages:
        for path, text, start, _ in _nodes(language):
            for match in keyword_tokens(language).finditer(text):
                if match["word"] in words:
                    yield Example(path, Span(start + match.start(), start + match.end()))


def _has(whole: Example, part: Example) -> bool:
    return whole.path == part.path and whole.span.start <= part.span.start and part.span.end <= whole.span.end


LANGUAGES = ("bdd", "scene", "scenex", "bddx")


def _rank(example: Example) -> tuple[bool, bool, int, str, int]:
    """Prefer models of the reference to others, all to the published form, and then the shortest."""
    is_own = example.path.is_relative_to(FOLDERS[0])
    length = example.span.end - example.span.start
    return example.path.stem == "published", not is_own, length, example.path.as_posix(), example.span.start


def example_of_rule(language: str, rule: str) -> Example | None:
    """Return the best example of a rule."""
    return min(_written(language).get(rule, ()), key=_rank, default=None)


def models() -> Iterator[tuple[str, Path]]:
    """Yield all models with the names of their grammars."""
    for folder in FOLDERS:
        for path in sorted(folder.rglob("*")):
            language = grammar_name(path.suffix[1:])
            if language in LANGUAGES and path.is_file():
                yield language, path


@cache
def _nodes(language: str) -> tuple[tuple[Path, str, int, Any], ...]:
    """Return the objects of all declarations of a kind of file, with the text and the place of their chunks."""
    found: list[tuple[Path, str, int, Any]] = []
    for own, path in models():
        if own != language:
            continue
        for chunk in split(language, load_text(path)):
            parsed = parse_chunk(language, chunk.text)
            if isinstance(parsed, Parsed):
                found.append((path, chunk.text, chunk.offset, parsed.declaration))
    return tuple(found)


def _all_inside(node: Any) -> Iterator[Any]:
    yield node
    for child in children(node):
        yield from _all_inside(child)


@cache
def _written(language: str) -> Mapping[str, list[Example]]:
    """Return where each rule occurs; an occurrence of a rule is one of the rules that have it as an alternative."""
    found: dict[str, list[Example]] = {}
    above = _alternatives(language)
    for path, _, start, declaration in _nodes(language):
        for node in _all_inside(declaration):
            example = Example(path, Span(start + node._tx_position, start + node._tx_position_end))
            waiting = [type(node).__name__]
            while waiting:
                rule = waiting.pop()
                found.setdefault(rule, []).append(example)
                waiting += above.get(rule, ())
    return found


@cache
def _alternatives(language: str) -> Mapping[str, list[str]]:
    """Map each rule to the rules of which it is an alternative."""
    found: dict[str, list[str]] = {}
    for rule, body in read_rules(language).items():
        if isinstance(body, grammar.Choice) and all(isinstance(one, grammar.Use) for one in body.options):
            for option in body.options:
                if isinstance(option, grammar.Use):
                    found.setdefault(option.rule, []).append(rule)
    return found


@cache
def _after_keyword(language: str) -> Mapping[str, list[Example]]:
    """Return where each keyword is followed by a part of the same object: both are an example of it."""
    found: dict[str, list[Example]] = {}
    rules = read_rules(language)
    for path, text, start, declaration in _nodes(language):
        for node in _all_inside(declaration):
            own = set(literals(rules[type(node).__name__]))
            inner = [(one._tx_position, one._tx_position_end) for one in children(node)]
            for match in keyword_tokens(language).finditer(text, node._tx_position, node._tx_position_end):
                inside = any(first <= match.start() < last for first, last in inner)
                following = [last for first, last in inner if first > match.start()]
                if match["word"] in own and not inside and following:
                    span = Span(start + match.start(), start + min(following))
                    found.setdefault(match["word"], []).append(Example(path, span))
    return found
