"""Propose names at a cursor: names in scope, names in importable files, configurations and events."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import islice
from typing import TYPE_CHECKING

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.catalog.settings import SETTINGS
from robbdd_tools.checks.lines import import_edit
from robbdd_tools.checks.property_condition import properties_in
from robbdd_tools.checks.setting import may_have
from robbdd_tools.features.element_properties import (
    COLUMNS,
    CONDITION,
    column_choices,
    name_choices,
    value_choices,
)
from robbdd_tools.features.expected_words import place_after
from robbdd_tools.features.literals import facts_in_clause, facts_of_variable, without_number
from robbdd_tools.features.predicate_phrases import phrase_form
from robbdd_tools.features.unimported import Elsewhere, beside, loaded
from robbdd_tools.features.value_types import (
    fits,
    kinds_in_text,
    leading_kinds,
    may_be,
    reference_before,
    scene_wanted,
    slot_wanted,
    values_wanted,
    variable_of_value,
)
from robbdd_tools.names.elements import Site, site_of
from robbdd_tools.names.roles import ROLE_KINDS
from robbdd_tools.names.types import variable_type
from robbdd_tools.names.uses import ANYTHING, ELEMENTS, Kinds
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Edit
    from robbdd_tools.base.document import Span
    from robbdd_tools.features.cursor import Cursor
    from robbdd_tools.features.expected_words import Place
    from robbdd_tools.features.literals import Literal, ValueFacts
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import Symbol

MAX_TO_IMPORT = 300
"""Maximum number of proposed names that need an import; loaded files and files in the same folder come first."""
_CONFIGURED = re.compile(r"\bhas\s+config\s+\Z")
_EMITTED = re.compile(r"\bemits\s+\Z")
_SET_ROLES = {"obj": "ObjectSet", "ws": "WorkspaceSet", "agn": "AgentSet"}
_VALUE_RULES = {f"{role}Path" for role in ("Element", "ObjectSet", "WorkspaceSet", "AgentSet", "ConstantSet", "AnySet")}


@dataclass(frozen=True, slots=True)
class Completion:
    """One completion proposal.

    - ``kind``: ``keyword``, ``snippet``, ``file``, ``folder``, ``catalog``, ``setting``, ``property``, one of
      ``CODE_KINDS``, or the kind of a symbol.
    - ``text``: the text to insert. The text of a snippet contains placeholders.
    - ``span``: the text that ``text`` replaces.
    - ``whole``: like ``span``, but with the rest of the word after the cursor.
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


@dataclass(frozen=True, slots=True)
class Names:
    """Names to propose at a cursor."""

    snapshot: Snapshot
    file: FileAnalysis
    cursor: Cursor
    whole: Span
    elsewhere: Elsewhere | None

    def of(self, language: str, place: Place) -> Iterator[Completion]:
        """Yield the names that the grammar accepts at a place."""
        if place.expected is None:
            return
        if "PropertyNameText" in place.expected.rules:
            yield from self.properties()
        if "ColumnNameText" in place.expected.rules:
            yield from self.columns()
        if "WordText" in place.expected.rules:
            yield from self.property_values()
        if "NameText" in place.expected.rules:
            yield from self.settings()
            yield from self.moments()
        yield from self.proposals(place.expected.rules, bracket="")
        if "<" in place.expected.literals:
            inside = place_after(language, place.before + "<").expected
            if inside is not None:
                yield from self.proposals(inside.rules, bracket="<")

    def facts(self) -> ValueFacts:
        """Return the known facts about the value at the cursor."""
        uri, before = self.file.document.uri, without_number(self.cursor.before)
        variable = variable_of_value(self.snapshot, uri, before)
        if variable is None:
            return facts_in_clause(before)
        return facts_of_variable(self.snapshot, variable, values_wanted(self.snapshot, uri, before))

    def literals(self, choices: Iterable[Literal]) -> Iterator[Completion]:
        """Yield the proposals of literals."""
        for one in choices:
            origin = (self.file.document.uri, one.described)
            yield Completion(one.label, one.kind, one.detail, one.text, self.cursor.span, self.whole, origin=origin)

    def misfitting_phrases(self) -> frozenset[str]:
        """Return the beginnings of phrases that do not fit the type of the variable before the cursor."""
        kinds = self._reference_kinds(self.cursor.before)
        return frozenset(words for words, fitting in leading_kinds().items() if not fitting & kinds)

    def _reference_kinds(self, before: str) -> Kinds:
        """Return the kinds of the element or variable at the end of a text, if any."""
        name = reference_before(before)
        if name is None or self.cursor.placed is None:
            return ANYTHING
        return kinds_in_text(self._other_lines()).get(name) or self._kinds_of(name)

    def _other_lines(self) -> str:
        """Return the text of the declaration at the cursor without the cursor's line."""
        assert self.cursor.placed is not None
        text, place = self.cursor.placed.declaration.text, self.cursor.span.start - self.cursor.placed.offset
        end = text.find("\n", place)
        return text[: text.rfind("\n", 0, place) + 1] + (text[end:] if end >= 0 else "")

    def _kinds_of(self, name: str) -> Kinds:
        """Return the kinds of an element, or of a variable by its values if no phrase narrows its type."""
        scope = self.snapshot.scope(self.file.document.uri)
        visible = scope.visible(ROLE_KINDS["Term"], self.cursor.scopes)
        if name not in visible:
            return ANYTHING
        definition = scope.define(*visible[name])
        if definition.kind not in ROLE_KINDS["Variable"]:
            return frozenset(kind for kind in ELEMENTS if may_be(definition.kind, frozenset({kind}))) or ANYTHING
        return variable_type(self.snapshot, definition).kinds or ANYTHING

    def properties(self) -> Iterator[Completion]:
        """Yield the properties that elements of the model have."""
        uri = self.file.document.uri
        ending = "" if CONDITION.search(self.cursor.before) else ": "
        for name, values in name_choices(self.snapshot, uri, self.cursor):
            yield Completion(
                name, "property", values, f"{name}{ending}", self.cursor.span, self.whole, origin=(uri, name)
            )

    def columns(self) -> Iterator[Completion]:
        """Yield the properties of a set's elements that the tables of features can show."""
        match, placed = COLUMNS.search(self.cursor.before), self.cursor.placed
        if match is None:
            return
        kind, name, chosen = match.groups()
        uri = self.file.document.uri
        scope = self.snapshot.scope(uri)
        found = scope.visible(ROLE_KINDS[_SET_ROLES[kind]], self.cursor.scopes).get(name)
        if found is None or placed is None:
            return
        known = properties_in(Site(self.snapshot, self.file, placed), site_of(self.snapshot, scope.define(*found)))
        for choice, values in column_choices(known, chosen):
            yield Completion(choice, "property", values, choice, self.cursor.span, self.whole, origin=(uri, choice))

    def property_values(self) -> Iterator[Completion]:
        """Yield the values that the property at the cursor has elsewhere in the model."""
        for value in value_choices(self.snapshot, self.file.document.uri, self.cursor):
            yield Completion(value, "value", "", value, self.cursor.span, self.whole)

    def settings(self) -> Iterator[Completion]:
        """Yield the configurations that ``has config`` can set."""
        if _CONFIGURED.search(self.cursor.before):
            configured = _CONFIGURED.sub("", self.cursor.before)
            kinds = self._reference_kinds(configured) & ELEMENTS or ELEMENTS
            for name, setting in SETTINGS.items():
                detail = f"of {setting.target}" + (f", {setting.unit}" if setting.unit else "")
                misfits = not any(may_have(kind, None, name) for kind in kinds)
                yield Completion(name, "setting", detail, name, self.cursor.span, self.whole, rank=int(misfits))

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
            wanted = self.facts().kinds
            members = scene_wanted(self.snapshot, uri, self.cursor.before)
        for role in roles:
            known = set[str]()
            own = slot_wanted(self.cursor.before) if role == "Term" else wanted
            for name, definition, rank in self._in_scope(role):
                known.add(name)
                if fits(self.snapshot, definition, own, members):
                    yield self._proposal(name, definition.kind, (definition.uri, definition.symbol.path), bracket, rank)
                    if role == "Predicate":
                        yield from self._whole_phrase(definition)
            if role not in ("Namespace", "Term") and members is None:
                yield from islice(self._to_import(role, known, bracket, wanted), MAX_TO_IMPORT)

    def _whole_phrase(self, definition: Definition) -> Iterator[Completion]:
        """Yield the phrase of a named predicate with its parameters as placeholders."""
        form = phrase_form(self.snapshot, definition, is_after_subject=self.cursor.before.rstrip().endswith(">"))
        if form is not None:
            origin = definition.uri, definition.symbol.path
            yield Completion(form[0], "snippet", "phrase", form[1], self.cursor.span, self.whole, origin=origin)

    def _in_scope(self, role: str) -> Iterator[tuple[str, Definition, int]]:
        scope = self.snapshot.scope(self.file.document.uri)
        visible = scope.visible(ROLE_KINDS[role], self.cursor.scopes)
        visible = {name: found for name, found in visible.items() if self._may_be_named(name, found[1].symbol)}
        misfits = _misfits(self.cursor) if role in ("Variable", "Term") else frozenset[str]()
        ranks = dict.fromkeys(misfits, 1)
        if role == "Term":
            # A clause about an element fits only one scene, so variables are proposed first.
            variables = ROLE_KINDS["Variable"]
            ranks |= {name: 2 for name, (_, found) in visible.items() if found.symbol.kind not in variables}
        for name in sorted(visible, key=lambda name: (ranks.get(name, 0), name)):
            definition = scope.define(*visible[name])
            yield self._written(name, definition), definition, ranks.get(name, 0)

    @staticmethod
    def _may_be_named(name: str, symbol: Symbol) -> bool:
        """Return whether a name may be written here: a predicate needs a hyphen, a parameter its own definition."""
        match symbol.kind:
            case SymbolKind.PARAMETER:
                return "." not in name
            case SymbolKind.PREDICATE:
                return "-" in name
            case _:
                return True

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
        bare = kind in (SymbolKind.NAMESPACE, SymbolKind.PREDICATE)
        closing = not bare and _needs_closing(self.file.document.text, self.cursor)
        text = f"{bracket}{name}>" if closing else f"{bracket}{name}"
        return Completion(name, kind, kind, text, self.cursor.span, self.whole, rank, origin=origin)


def _misfits(cursor: Cursor) -> frozenset[str]:
    """Return the variables in the declaration at the cursor whose type does not fit the slot at the cursor.

    The type of a variable is inferred from the other phrases that use it.
    """
    wanted = slot_wanted(cursor.before)
    if wanted == ANYTHING:
        wanted = facts_in_clause(cursor.before).kinds
    if cursor.placed is None or wanted == ANYTHING:
        return frozenset()
    return frozenset(
        name for name, kinds in kinds_in_text(cursor.placed.declaration.text).items() if not kinds & wanted
    )


def _needs_closing(text: str, cursor: Cursor) -> bool:
    """Return whether the reference at the cursor still lacks its closing ``>``."""
    return re.compile(r"[\w\-.]*\s*>").match(text, cursor.span.end) is None
