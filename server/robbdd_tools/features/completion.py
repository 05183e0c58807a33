"""Completion: what the grammar accepts at the cursor, with the names that may stand there."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

from robbdd_tools.base.files import uri_to_path
from robbdd_tools.features.cursor import Cursor, cursor_at
from robbdd_tools.features.value_types import fits, kinds_in_text, slot_wanted, values_wanted
from robbdd_tools.names.index import language_of
from robbdd_tools.names.roles import ROLE_KINDS
from robbdd_tools.names.uses import ANYTHING
from robbdd_tools.syntax.chunk import Expectation, Parsed, grammar_text, parse_chunk
from robbdd_tools.syntax.parse import LANGUAGES

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.names.project import Snapshot


_VALUE_RULES = {f"{role}Path" for role in ("Element", "ObjectSet", "WorkspaceSet", "AgentSet", "ConstantSet", "AnySet")}


@dataclass(frozen=True, slots=True)
class Completion:
    """One proposal: ``kind`` is ``keyword``, ``file`` or the kind of a symbol; ``text`` replaces ``span``.

    Of two proposals the one with the smaller ``rank`` fits better.
    """

    label: str
    kind: str
    detail: str
    text: str
    span: Span
    rank: int = 0


def complete(snapshot: Snapshot, uri: str, offset: int) -> list[Completion]:
    """Return the proposals at a cursor, keywords first, each group in alphabetical order.

    Variables that cannot stand in a slot of a phrase come last; values that their variable cannot take, not at all.
    """
    analysis = snapshot.file(uri)
    if analysis is None:
        return []
    cursor = cursor_at(analysis, offset)
    if cursor.quoted is not None:
        return list(_import_paths(uri, cursor))
    language = language_of(uri)
    expected = _expected(language, cursor.before)
    if expected is None:
        return []
    found = [Completion(phrase, "keyword", "", phrase, cursor.span) for phrase in _phrases(language, cursor, expected)]
    found += _names(snapshot, uri, cursor, expected.rules, bracket="")
    if "<" in expected.literals:
        inside = _expected(language, cursor.before + "<")
        if inside is not None:
            found += _names(snapshot, uri, cursor, inside.rules, bracket="<")
    return found


def _expected(language: str, before: str) -> Expectation | None:
    """Return what may follow a text; ``None`` when the text itself is broken before its end."""
    parsed = parse_chunk(language, before)
    if isinstance(parsed, Parsed):
        # Behind a whole declaration another one begins, of which some words may be typed already.
        return _expected(language, before[parsed.trailing :] if parsed.trailing is not None else "")
    return None if before[parsed.offset :].strip() else parsed.expected


def _phrases(language: str, cursor: Cursor, expected: Expectation) -> list[str]:
    """Return the accepted keywords, each continued by the keywords that must follow it."""
    found: set[str] = set()
    for literal in expected.literals:
        if not literal[:1].isalpha():
            continue
        runs = _keyword_runs(language).get(literal, ())
        fitting = [run for run in runs if _follows(language, cursor.before, run)]
        found.update(fitting or [literal])
    return sorted(found)


def _follows(language: str, before: str, run: str) -> bool:
    text = f"{before}{run} "
    parsed = parse_chunk(language, text)
    return isinstance(parsed, Parsed) or not text[parsed.offset :].strip()


@cache
def _keyword_runs(language: str) -> dict[str, tuple[str, ...]]:
    """Map each keyword to the runs of keywords in the grammar that begin with it (``is`` → ``is located at`` …)."""
    runs: dict[str, dict[str, None]] = {}
    for match in re.finditer(r"'[^\W\d]\w*'(?:\s+'[^\W\d]\w*')+", grammar_text(language)):
        words = re.findall(r"\w+", match[0])
        runs.setdefault(words[0], {})[" ".join(words)] = None
    return {word: tuple(found) for word, found in runs.items()}


def _names(snapshot: Snapshot, uri: str, cursor: Cursor, rules: Iterable[str], bracket: str) -> Iterator[Completion]:
    scope = snapshot.scope(uri)
    wanted = values_wanted(snapshot, uri, cursor.before) if not _VALUE_RULES.isdisjoint(rules) else ANYTHING
    roles = sorted(rule.removesuffix("Path") for rule in rules if rule.endswith("Path"))
    closing = _needs_closing(scope.files[0].document.text, cursor)
    for role in roles:
        visible = scope.visible(ROLE_KINDS[role], cursor.scopes)
        misfits = _misfits(cursor) if role == "Variable" else frozenset[str]()
        for name in sorted(visible, key=lambda name: (name in misfits, name)):
            file, declared = visible[name]
            if wanted != ANYTHING and not fits(snapshot, scope.define(file, declared), wanted):
                continue
            inserted = f"{bracket}{name}>" if closing and role != "Namespace" else f"{bracket}{name}"
            yield Completion(
                name, str(declared.symbol.kind), str(declared.symbol.kind), inserted, cursor.span, int(name in misfits)
            )


def _misfits(cursor: Cursor) -> frozenset[str]:
    """Return the variables of the declaration at the cursor that other phrases take for something else."""
    wanted = slot_wanted(cursor.before)
    if cursor.placed is None or wanted == ANYTHING:
        return frozenset()
    return frozenset(
        name for name, kinds in kinds_in_text(cursor.placed.declaration.text).items() if not kinds & wanted
    )


def _needs_closing(text: str, cursor: Cursor) -> bool:
    """Tell whether a reference at the cursor still lacks its ``>``."""
    return re.compile(r"[\w\-.]*\s*>").match(text, cursor.span.end) is None


def _import_paths(uri: str, cursor: Cursor) -> Iterator[Completion]:
    """Propose model files beside the importing one, inside the quotes of an import."""
    own = uri_to_path(uri)
    if own is None or not re.match(r"import\s*[\"'][^\"']*\Z", f"{cursor.before}{cursor.word}"):
        return
    try:
        beside = sorted(path.name for path in own.parent.iterdir() if path.suffix[1:] in LANGUAGES and path != own)
    except OSError:
        return
    for name in beside:
        yield Completion(name, "file", "model", name, cursor.span)
