"""Completion: propose the keywords that the grammar accepts at the cursor, and the names in scope."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit
from robbdd_tools.base.document import Span
from robbdd_tools.features.coordination_nodes import typed_nodes
from robbdd_tools.features.cursor import Cursor, cursor_at
from robbdd_tools.features.expected_words import Place, is_accepted, keyword_phrases, place_after
from robbdd_tools.features.literals import literal_choices, unit_choices
from robbdd_tools.features.log_help import log_choices
from robbdd_tools.features.model_parts_help import part_choices
from robbdd_tools.features.name_completion import Completion, Names
from robbdd_tools.features.part_snippets import PART_SNIPPETS
from robbdd_tools.features.python_code import code_choices
from robbdd_tools.features.quoted_completion import quoted
from robbdd_tools.features.snippets import declaration_snippets
from robbdd_tools.features.studies import is_study
from robbdd_tools.features.study_completion import complete_study
from robbdd_tools.names.index import language_of

if TYPE_CHECKING:
    from robbdd_tools.features.unimported import Elsewhere
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.parsed import Expectation

_STARTS = frozenset({"import", "ns"})
_CLAUSE = frozenset({"(", "<", "holds"})
"""At a place where the grammar accepts all of these, it accepts a clause."""


def complete(snapshot: Snapshot, uri: str, offset: int, elsewhere: Elsewhere | None = None) -> list[Completion]:
    """Return the proposals at a cursor: first keywords, then names, each group in alphabetical order.

    Variables whose type does not fit the slot are last. Values are left out if their type does not fit the variable, or
    if the scene of the variant does not contain them. Names in files that are not yet imported are proposed together
    with the import.
    """
    analysis = snapshot.file(uri)
    if analysis is None:
        return []
    if is_study(uri):
        return complete_study(snapshot, uri, offset)
    cursor = cursor_at(analysis, offset)
    if cursor.quoted is not None:
        return list(_in_quotes(snapshot, analysis, offset))
    language = language_of(uri)
    end = _word_end(analysis.document.text, offset)
    named = list(_code(uri, cursor, end))
    if named:
        return named
    names = Names(snapshot, analysis, cursor, Span(cursor.span.start, end), elsewhere)
    units = list(names.literals(unit_choices(language, cursor.before, names.facts())))
    place = place_after(language, cursor.before)
    if units or place.expected is None:
        return units
    found = [*_words(names, language, place), *_connectives(names, language, place), *names.of(language, place)]
    opening = tuple(
        Edit(uri, Span(start, start), "(") for start in (cursor.span.start - distance for distance in place.opened)
    )
    return [replace(one, edits=(*opening, *one.edits)) for one in found] if opening else found


def _words(names: Names, language: str, place: Place) -> Iterator[Completion]:
    """Yield keywords, snippets and literals."""
    assert place.expected is not None
    expected, span, whole = place.expected, names.cursor.span, names.whole
    misfits = names.misfitting_phrases()
    for phrase in keyword_phrases(language, place.before, expected):
        yield Completion(phrase, "keyword", "", phrase, span, whole, rank=int(phrase in misfits))
    if expected.literals >= _STARTS:
        for snippet in declaration_snippets(language):
            yield Completion(f"{snippet.label} …", "snippet", "whole declaration", snippet.body, span, whole)
    for snippet in PART_SNIPPETS.get(language, ()):
        if _may_begin(snippet.plain, expected) and is_accepted(language, place.before, snippet.plain):
            yield Completion(snippet.label, "snippet", "form", snippet.body, span, whole)
    yield from names.literals(literal_choices(language, place, names.facts()))


def _connectives(names: Names, language: str, place: Place) -> Iterator[Completion]:
    """Yield 'and', 'or' and 'not' at clauses without parentheses, together with the missing opening parenthesis."""
    assert place.expected is not None
    before, span, uri = names.cursor.before, names.cursor.span, names.file.document.uri
    if not place.expected.literals >= _CLAUSE:
        return
    for word in ("and", "or", "not") if place.before.rstrip().endswith((")", ">", "}", '"', "'")) else ("not",):
        if word in place.expected.literals:
            continue
        joined = place_after(language, f"{before}{word} ")
        for distance in joined.opened[-1:] if joined.expected is not None else ():
            start = span.start + len(word) + 1 - distance
            if start == span.start:
                yield Completion(word, "keyword", "", f"({word}", span, names.whole)
            elif len(joined.opened) > len(place.opened):
                opening = Edit(uri, Span(start, start), "(")
                yield Completion(word, "keyword", "", word, span, names.whole, edits=(opening,))


def _may_begin(text: str, expected: Expectation) -> bool:
    """Return whether the first word or symbol of a text is expected."""
    word = re.match(r"\w+|\W", text)
    return word is not None and (word[0] in expected.literals or ("NameText" in expected.rules and word[0].isalpha()))


def _word_end(text: str, offset: int) -> int:
    match = re.compile(r"[\w\-.]*").match(text, offset)
    return offset if match is None else match.end()


def _code(uri: str, cursor: Cursor, end: int) -> Iterator[Completion]:
    """Yield the modules or the attributes of Python code that may be named at a cursor."""
    whole = Span(cursor.span.start, end)
    for label, kind, detail, rank, name in code_choices(uri, cursor.before, cursor.word):
        yield Completion(label, kind, detail, label, cursor.span, whole, rank, origin=(uri, name))


def _in_quotes(snapshot: Snapshot, file: FileAnalysis, offset: int) -> Iterator[Completion]:
    """Yield proposals for the contents of quotes."""
    uri, text = file.document.uri, file.document.text
    rest = re.compile(r"[^\"'\n/]*").match(text, offset)
    for name, kind, facts, typed in part_choices(uri, text, offset):
        start = offset - len(typed)
        whole = Span(start, offset if rest is None else rest.end())
        yield Completion(name, kind, facts, name, Span(start, offset), whole, origin=(uri, ""))
    closed = re.compile(r"[^\"'\n]*").match(text, offset)
    for name, kind, facts, typed in log_choices(uri, text, offset):
        start = offset - len(typed)
        # A name of a signal is followed by its condition.
        end = offset if closed is None or kind in ("field", "joint") else closed.end()
        yield Completion(name, kind, facts, name, Span(start, offset), Span(start, end), origin=(uri, ""))
    line = text[text.rfind("\n", 0, offset) + 1 : offset]
    for name, kind, typed, target in (*quoted(uri, line), *typed_nodes(snapshot, uri, line)):
        start = offset - len(typed)
        whole = Span(start, offset if rest is None else rest.end())
        yield Completion(name, kind, "", name, Span(start, offset), whole, origin=(target, "") if target else None)
