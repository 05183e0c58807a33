"""Completion: propose the keywords that the grammar accepts at the cursor, and the names in scope."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cache
from itertools import islice
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.catalog.settings import SETTINGS
from robbdd_tools.checks.lines import import_edit
from robbdd_tools.features.cursor import Cursor, cursor_at
from robbdd_tools.features.model_parts_help import part_choices
from robbdd_tools.features.python_code import code_choices
from robbdd_tools.features.quoted_completion import quoted
from robbdd_tools.features.snippets import declaration_snippets
from robbdd_tools.features.unimported import Elsewhere, beside, loaded
from robbdd_tools.features.value_types import fits, kinds_in_text, may_be, scene_wanted, slot_wanted, values_wanted
from robbdd_tools.names.index import language_of
from robbdd_tools.names.roles import ROLE_KINDS
from robbdd_tools.names.uses import ANYTHING, Kinds
from robbdd_tools.syntax.chunk import parse_chunk
from robbdd_tools.syntax.declaration import SymbolKind
from robbdd_tools.syntax.grammar_files import grammar_text
from robbdd_tools.syntax.parsed import Expectation, Parsed

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Edit
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot

MAX_BROKEN_LINES = 50
"""Maximum number of unparsable lines skipped before a cursor."""
MAX_TO_IMPORT = 300
"""Maximum number of proposed names that need an import; loaded files and files in the same folder come first."""
_CONFIGURED = re.compile(r"\bhas\s+config\s+\Z")
_EMITTED = re.compile(r"\bemits\s+\Z")
_STARTS = frozenset({"import", "ns"})
_VALUE_RULES = {f"{role}Path" for role in ("Element", "ObjectSet", "WorkspaceSet", "AgentSet", "ConstantSet", "AnySet")}


@dataclass(frozen=True, slots=True)
class Completion:
    """One completion proposal.

    - ``kind``: ``keyword``, ``snippet``, ``file``, ``folder``, ``catalog``, ``setting``, one of ``CODE_KINDS``, or the
      kind of a symbol.
    - ``text``: the text to insert. The text of a snippet contains placeholders.
    - ``span``: the text that ``text`` replaces.
    - ``whole``: like ``span``, but including the rest of the word after the cursor.
    - ``rank``: a proposal with a smaller rank fits better.
    - ``edits``: additional edits, for example a new import.
    - ``origin``: the document and the qualified name of a proposed name, or the URI of a proposed file and ``""``.
    """

    label: str
    kind: str
    detail: str
    text: str
    span: Span
    whole: Span
    rank: int = 0
    edits: tuple[Edit, ...] = ()
    origin: tuple[str, str] | None = None


def complete(snapshot: Snapshot, uri: str, offset: int, elsewhere: Elsewhere | None = None) -> list[Completion]:
    """Return the proposals at a cursor: first keywords, then names, each group in alphabetical order.

    Variables whose type does not fit the slot are last. Values are left out if their type does not fit their variable,
    or if the scene of their variant does not contain them. Names in files that are not yet imported are proposed
    together with the import.
    """
    analysis = snapshot.file(uri)
    if analysis is None:
        return []
    cursor = cursor_at(analysis, offset)
    if cursor.quoted is not None:
        return list(_in_quotes(uri, analysis, offset))
    language = language_of(uri)
    named = list(_code(uri, cursor, _word_end(analysis.document.text, offset)))
    if named:
        return named
    before, expected = _expected(language, cursor.before)
    if expected is None:
        return []
    whole = Span(cursor.span.start, _word_end(analysis.document.text, offset))
    phrases = _phrases(language, before, expected)
    found = [Completion(phrase, "keyword", "", phrase, cursor.span, whole) for phrase in phrases]
    if expected.literals >= _STARTS:
        found += (
            Completion(f"{snippet.label} …", "snippet", "whole declaration", snippet.body, cursor.span, whole)
            for snippet in declaration_snippets(language)
        )
    names = _Names(snapshot, analysis, cursor, whole, elsewhere)
    if "NameText" in expected.rules:
        found += names.settings()
        found += names.moments()
    found += names.proposals(expected.rules, bracket="")
    if "<" in expected.literals:
        _, inside = _expected(language, before + "<")
        if inside is not None:
            found += names.proposals(inside.rules, bracket="<")
    return found


def _expected(language: str, before: str) -> tuple[str, Expectation | None]:
    """Return what the grammar expects after a text, and the text that was parsed.

    Lines that cannot be parsed are blanked.
    """
    for _ in range(MAX_BROKEN_LINES):
        parsed = parse_chunk(language, before)
        if isinstance(parsed, Parsed):
            # After a whole declaration another one starts, whose first words may already be typed.
            return _expected(language, before[parsed.trailing :] if parsed.trailing is not None else "")
        if not before[parsed.offset :].strip():
            return before, parsed.expected
        start = before.rfind("\n", 0, parsed.offset) + 1
        end = before.find("\n", parsed.offset)
        if end < 0 or not before[start:end].strip():
            break
        before = before[:start] + " " * (end - start) + before[end:]
    return before, None


def _phrases(language: str, before: str, expected: Expectation) -> list[str]:
    """Return each accepted keyword together with the keywords that must follow it."""
    found: set[str] = set()
    for literal in expected.literals:
        if not literal[:1].isalpha():
            continue
        runs = _keyword_runs(language).get(literal, ())
        fitting = [run for run in runs if _follows(language, before, run)]
        found.update(fitting or [literal])
    return sorted(found)


def _follows(language: str, before: str, run: str) -> bool:
    text = f"{before}{run} "
    parsed = parse_chunk(language, text)
    return isinstance(parsed, Parsed) or not text[parsed.offset :].strip()


@cache
def _keyword_runs(language: str) -> dict[str, tuple[str, ...]]:
    """Map each keyword to the keyword sequences in the grammar that start with it (``is`` → ``is located at`` …)."""
    runs: dict[str, dict[str, None]] = {}
    for match in re.finditer(r"'[^\W\d]\w*'(?:\s+'[^\W\d]\w*')+", grammar_text(language)):
        words = re.findall(r"\w+", match[0])
        runs.setdefault(words[0], {})[" ".join(words)] = None
    return {word: tuple(found) for word, found in runs.items()}


@dataclass(frozen=True, slots=True)
class _Names:
    """Names to propose at a cursor."""

    snapshot: Snapshot
    file: FileAnalysis
    cursor: Cursor
    whole: Span
    elsewhere: Elsewhere | None

    def settings(self) -> Iterator[Completion]:
        """Yield the configurations that ``has config`` can set."""
        if _CONFIGURED.search(self.cursor.before):
            for name, setting in SETTINGS.items():
                detail = f"of {setting.target}" + (f", {setting.unit}" if setting.unit else "")
                yield Completion(name, "setting", detail, name, self.cursor.span, self.whole)

    def moments(self) -> Iterator[Completion]:
        """Yield the events of the catalog's behaviours, for ``emits``."""
        if _EMITTED.search(self.cursor.before):
            emitting: dict[str, list[str]] = {}
            for behaviour in load_catalog().behaviours.values():
                for event in behaviour.events:
                    emitting.setdefault(event, []).append(behaviour.name)
            for event, names in emitting.items():
                yield Completion(event, "event", f"of {', '.join(names)}", event, self.cursor.span, self.whole)

    def proposals(self, rules: Iterable[str], bracket: str) -> Iterator[Completion]:
        """Yield the names that match some rules: first the names in scope, then the names in importable files."""
        uri = self.file.document.uri
        roles = sorted(rule.removesuffix("Path") for rule in rules if rule.endswith("Path"))
        wanted, members = ANYTHING, None
        if not _VALUE_RULES.isdisjoint(rules):
            wanted = values_wanted(self.snapshot, uri, self.cursor.before)
            members = scene_wanted(self.snapshot, uri, self.cursor.before)
        for role in roles:
            known = set[str]()
            for name, definition, rank in self._in_scope(role):
                known.add(name)
                if fits(self.snapshot, definition, wanted, members):
                    yield self._proposal(name, definition.kind, (definition.uri, definition.symbol.path), bracket, rank)
            if role != "Namespace" and members is None:
                yield from islice(self._to_import(role, known, bracket, wanted), MAX_TO_IMPORT)

    def _in_scope(self, role: str) -> Iterator[tuple[str, Definition, int]]:
        scope = self.snapshot.scope(self.file.document.uri)
        visible = scope.visible(ROLE_KINDS[role], self.cursor.scopes)
        misfits = _misfits(self.cursor) if role == "Variable" else frozenset[str]()
        for name in sorted(visible, key=lambda name: (name in misfits, name)):
            definition = scope.define(*visible[name])
            yield self._written(name, definition), definition, int(name in misfits)

    def _written(self, name: str, definition: Definition) -> str:
        """Return the shortest form of a name that starts with the qualifier that the user typed."""
        qualifier, dot, _ = self.cursor.word.rpartition(".")
        path = definition.symbol.path
        if not dot or definition.uri != self.file.document.uri or not path.endswith(name):
            return name
        forms = (path.removeprefix(f"{scope}.") for scope in (*self.cursor.scopes, ""))
        return next((form for form in forms if form.startswith(qualifier + dot)), name)

    def _to_import(self, role: str, known: set[str], bracket: str, wanted: Kinds) -> Iterator[Completion]:
        uri = self.file.document.uri
        others = [] if self.elsewhere is None else self.elsewhere.importable(self.snapshot, uri)
        for other in [*loaded(self.snapshot, uri), *beside(self.snapshot, uri), *others]:
            for name in sorted(other.names):
                kind = next((kind for kind in other.names[name] if kind in ROLE_KINDS[role]), None)
                if kind is not None and name not in known and may_be(kind, wanted):
                    known.add(name)
                    found = self._proposal(name, kind, (other.uri, name), bracket, rank=2)
                    detail = f"{found.detail}, imports '{other.path}'"
                    yield replace(found, detail=detail, edits=(import_edit(self.file, other.path),))

    def _proposal(self, name: str, kind: SymbolKind, origin: tuple[str, str], bracket: str, rank: int) -> Completion:
        closing = kind is not SymbolKind.NAMESPACE and _needs_closing(self.file.document.text, self.cursor)
        text = f"{bracket}{name}>" if closing else f"{bracket}{name}"
        return Completion(name, kind, kind, text, self.cursor.span, self.whole, rank, origin=origin)


def _misfits(cursor: Cursor) -> frozenset[str]:
    """Return the variables in the declaration at the cursor whose type does not fit the slot at the cursor.

    The type of a variable is inferred from the other phrases that use it.
    """
    wanted = slot_wanted(cursor.before)
    if cursor.placed is None or wanted == ANYTHING:
        return frozenset()
    return frozenset(
        name for name, kinds in kinds_in_text(cursor.placed.declaration.text).items() if not kinds & wanted
    )


def _needs_closing(text: str, cursor: Cursor) -> bool:
    """Return whether the reference at the cursor still lacks its closing ``>``."""
    return re.compile(r"[\w\-.]*\s*>").match(text, cursor.span.end) is None


def _word_end(text: str, offset: int) -> int:
    match = re.compile(r"[\w\-.]*").match(text, offset)
    return offset if match is None else match.end()


def _code(uri: str, cursor: Cursor, end: int) -> Iterator[Completion]:
    """Yield the modules or the attributes of Python code that may be named at a cursor."""
    whole = Span(cursor.span.start, end)
    for label, kind, detail, rank, name in code_choices(uri, cursor.before, cursor.word):
        yield Completion(label, kind, detail, label, cursor.span, whole, rank, origin=(uri, name))


def _in_quotes(uri: str, file: FileAnalysis, offset: int) -> Iterator[Completion]:
    """Yield proposals for the contents of quotes."""
    text = file.document.text
    rest = re.compile(r"[^\"'\n/]*").match(text, offset)
    for name, kind, facts, typed in part_choices(uri, text, offset):
        start = offset - len(typed)
        whole = Span(start, offset if rest is None else rest.end())
        yield Completion(name, kind, facts, name, Span(start, offset), whole, origin=(uri, ""))
    for name, kind, typed, target in quoted(uri, text[text.rfind("\n", 0, offset) + 1 : offset]):
        start = offset - len(typed)
        whole = Span(start, offset if rest is None else rest.end())
        yield Completion(name, kind, "", name, Span(start, offset), whole, origin=(target, "") if target else None)
