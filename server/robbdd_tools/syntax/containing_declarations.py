"""Find the declaration that may contain a word, for words that are written outside of it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from itertools import zip_longest

from robbdd_tools.syntax.grammar import Assignment, Choice, Expression, Literal, Optional, Sequence, Use, read_grammar
from robbdd_tools.syntax.grammar_files import grammar_name, grammar_text

_WORD = re.compile(r"[^\W\d][\w\-]*")
_KINDS = ("bdd", "scene", "scenex", "bddx")


def misplaced_part(language: str, text: str, offset: int) -> str | None:
    """Return the message on a word that is a part of another declaration than the one before it, or ``None``.

    The first word of ``text`` begins a declaration, which has ended at ``offset``.
    """
    word = _WORD.match(text, offset)
    if word is None:
        return None
    own = grammar_name(language)
    for kind in (own, *(kind for kind in _KINDS if kind != own)):
        owners = _owners(kind).get(word[0], ())
        if not owners:
            begun = next((title for title in _titles(kind) if title.startswith(f"{word[0]} ")), None)
            if begun is not None:
                return f"'{word[0]}' does not begin a declaration here: write '{begun}'"
            continue
        ended = next((owner for owner in owners if re.match(rf"{owner}\b", text)), None)
        if ended is not None:
            return f"'{word[0]}' belongs inside the '{ended}', which ends before it: check the braces"
        shown = " or ".join(f"'{owner} … {{ … }}'" for owner in owners[:2])
        file = "" if kind == own else f" of a .{kind} file"
        return f"'{word[0]}' belongs inside {shown}{file}: move it there"
    return None


@cache
def _titles(kind: str) -> tuple[str, ...]:
    """Return the first words of the named declarations of a file kind."""
    rules = read_grammar(grammar_text(kind))
    return tuple(dict.fromkeys(title for rule in rules if (title := _title(rules, rule))))


@cache
def _owners(kind: str) -> dict[str, tuple[str, ...]]:
    """Return the first words of the named declarations of a file kind in which each word may begin a part."""
    rules = read_grammar(grammar_text(kind))
    found: dict[str, dict[str, None]] = {}
    for rule, expression in rules.items():
        title = _title(rules, rule)
        if title:
            for word in _parts(rules, expression, {rule}):
                found.setdefault(word, {})[title] = None
    return {word: tuple(titles) for word, titles in found.items()}


def _title(rules: dict[str, Expression], rule: str) -> str:
    """Return the words before the name of a declaration in braces, ``""`` for any other rule."""
    expression = rules.get(rule)
    if not isinstance(expression, Sequence) or Literal("{") not in expression.parts:
        return ""
    words: list[str] = []
    for part in expression.parts:
        if isinstance(part, Literal):
            words.append(part.text)
        elif isinstance(part, Assignment) and part.attribute in ("name", "namespace"):
            return " ".join(words)
        elif not isinstance(part, Optional):
            return ""
    return ""


def _parts(rules: dict[str, Expression], expression: Expression, seen: set[str]) -> Iterator[str]:
    """Yield the words with which parts of a declaration begin, without the insides of other declarations."""
    match expression:
        case Sequence(parts):
            for part, following in zip_longest(parts, parts[1:]):
                if isinstance(part, Literal) and following == Literal(":"):
                    yield part.text
                yield from _parts(rules, part, seen)
        case Choice(options):
            for option in options:
                yield from _parts(rules, option, seen)
        case Optional(part):
            yield from _parts(rules, part, seen)
        case Assignment(value=value, operator=operator):
            if operator in ("*=", "+="):
                yield from _first_words(rules, value)
            yield from _parts(rules, value, seen)
        case Use(rule) if rule in rules and rule not in seen:
            seen.add(rule)
            title = _title(rules, rule)
            if title:
                yield title.split()[0]
            else:
                yield from _parts(rules, rules[rule], seen)
        case _:
            pass


def _first_words(rules: dict[str, Expression], expression: Expression) -> Iterator[str]:
    match expression:
        case Literal(text):
            if _WORD.fullmatch(text):
                yield text
        case Sequence(parts):
            yield from _first_words(rules, parts[0])
        case Choice(options):
            for option in options:
                yield from _first_words(rules, option)
        case Assignment(value=value):
            yield from _first_words(rules, value)
        case Use(rule) if rule in rules:
            yield from _first_words(rules, rules[rule])
        case _:
            pass
