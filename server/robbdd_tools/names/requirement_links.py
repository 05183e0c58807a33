"""Find the scenarios and clauses that verify the requirements of a file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

from robbdd_tools.names.clause_places import FOR_ALL, clauses_in
from robbdd_tools.names.elements import site_of
from robbdd_tools.names.variant_places import variants_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.clause_places import PlacedClause
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.names.variant_places import PlacedVariant

Key = tuple[str, str]
"""The document and the qualified name of a definition."""
_Named = dict[Key, "dict[str, PlacedClause] | None"]
"""Requirements, each with the clauses that name it; ``None`` if a whole declaration names the requirement."""


@dataclass(frozen=True, slots=True)
class Verifier:
    """A scenario variant that verifies a requirement.

    ``clauses`` are the IRIs of the clauses that verify it. These are the clauses that name the requirement (or the
    groups around them). If ``whole`` is true, they are all ``Then`` clauses, because the scenario itself, its story or
    its template names the requirement.
    """

    variant: PlacedVariant
    clauses: Mapping[str, PlacedClause]
    whole: bool


def key_of(definition: Definition) -> Key:
    """Return the key of a definition."""
    return definition.uri, definition.symbol.path


def requirements_of(file: FileAnalysis) -> list[Definition]:
    """Return the requirements that a file declares, in text order."""
    found = (
        file.definitions[symbol.path]
        for placed in file.declarations
        for symbol in placed.declaration.symbols[:1]
        if symbol.kind is SymbolKind.REQUIREMENT
    )
    return list(dict.fromkeys(one for one in found if one.kind is SymbolKind.REQUIREMENT))


def verifiers(snapshot: Snapshot, requirements: Sequence[Definition]) -> dict[Key, list[Verifier]]:
    """Return the scenarios that verify each requirement, sorted by file and text. All requirements are in one file."""
    found: dict[Key, list[Verifier]] = {key_of(one): [] for one in requirements}
    uris = {one.uri for one in requirements}
    files = sorted(uris.union(*(snapshot.importers(uri) for uri in uris)))
    links = _Links(snapshot, frozenset(found))
    for uri in files:
        links.read(uri)
    for uri in files if links.owners else ():
        for variant in variants_of(snapshot, uri):
            for key, verifier in links.of(variant):
                found[key].append(verifier)
    return found


@dataclass(slots=True)
class _Links:
    """The requirements that stories, variants and templates name, by the key of the declaration."""

    snapshot: Snapshot
    wanted: frozenset[Key]
    owners: dict[Key, _Named] = field(default_factory=dict["Key", "_Named"])
    _then: dict[Key, dict[str, PlacedClause]] = field(default_factory=dict["Key", "dict[str, PlacedClause]"])

    def read(self, uri: str) -> None:
        file = self.snapshot.file(uri)
        if file is None:
            return
        places = _Places(self.snapshot, uri)
        for placed in file.parts():
            for reference in placed.declaration.references:
                target = placed.targets.get(reference.ref) if reference.ref.role == "Requirement" else None
                key = None if target is None else key_of(target)
                if key is not None and key in self.wanted and reference.scopes:
                    clause = places.clause(reference.ref.span.shifted(placed.offset))
                    self._add((uri, reference.scopes[0]), key, clause)

    def _add(self, owner: Key, requirement: Key, clause: PlacedClause | None) -> None:
        known = self.owners.setdefault(owner, {})
        if clause is None:
            known[requirement] = None
        else:
            named = known.setdefault(requirement, {})
            if named is not None:
                named[clause.iri] = clause

    def of(self, variant: PlacedVariant) -> Iterator[tuple[Key, Verifier]]:
        uri, path = key_of(variant.definition)
        template = None if variant.template is None else key_of(variant.template)
        own = [one for one in ((uri, path), (uri, path.partition(".")[0]), template) if one in self.owners]
        for requirement in dict.fromkeys(key for owner in own for key in self.owners[owner]):
            named: dict[str, PlacedClause] = {}
            whole = False
            for owner in own:
                clauses = self.owners[owner].get(requirement, {})
                whole = whole or clauses is None
                named |= clauses or {}
            if whole:
                named = {**self._under_then(variant.definition), **self._under_then(variant.template)}
            yield requirement, Verifier(variant, named, whole)

    def _under_then(self, owner: Definition | None) -> dict[str, PlacedClause]:
        if owner is None:
            return {}
        key = key_of(owner)
        if key not in self._then:
            site = site_of(self.snapshot, owner)
            spans = [] if site is None else [site.span(node) for node in _then_of(site.tree, owner.symbol.name)]
            around = clauses_in(self.snapshot, owner.uri)
            self._then[key] = {
                one.iri: one
                for one in around
                if any(span.start <= one.span.start and one.span.end <= span.end for span in spans)
            }
        return self._then[key]


@dataclass
class _Places:
    """The clauses of a file. They are searched only when the first reference to a requirement is found."""

    snapshot: Snapshot
    uri: str

    @cached_property
    def _clauses(self) -> list[PlacedClause]:
        return list(clauses_in(self.snapshot, self.uri))

    def clause(self, span: Span) -> PlacedClause | None:
        """Return the clause that contains a reference; ``None`` if the reference belongs to a whole declaration.

        A part of a negation or of a group is not judged by itself, so the outermost clause inside a loop is returned.
        """
        around = (one for one in self._clauses if one.span.start <= span.start and span.end <= one.span.end)
        judged = (one for one in around if one.name != FOR_ALL)
        return max(judged, key=lambda one: one.span.end - one.span.start, default=None)


def _then_of(root: tree.ChunkTree | None, name: str) -> Iterator[tree.Expression]:
    """Yield the ``Then`` clauses of a template, or of the variant of a story that has the given name."""
    match root:
        case tree.Template():
            yield from _then_in(root.body)
        case tree.Story():
            yield from (one.then for one in root.variants if one.name.text == name and one.then is not None)
        case _:
            pass


def _then_in(body: tree.Body) -> Iterator[tree.Expression]:
    for part in body.parts:
        if part.for_all is not None:
            yield from _then_in(part.for_all.body)
        if part.then is not None:
            yield part.then
