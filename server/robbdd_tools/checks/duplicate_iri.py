"""``duplicate-iri``: two declarations have the same IRI, so the graph would merge them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Set
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Related, Severity
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.checks.facts import UNIQUE_KINDS, facts_of
from robbdd_tools.checks.tally import Tally
from robbdd_tools.names.index import FileIndex
from robbdd_tools.names.namespaces import implied_namespace
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import FILE_NAMESPACE, SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.checks.tally import Counts
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.names.scope import Scope
    from robbdd_tools.syntax.declaration import Declaration

Node = tuple[str | None, str]
"""IRI of a namespace (``None`` if another file declares the namespace), and a name in the namespace."""
_Owner = tuple[str, SymbolKind, str]
"""The written namespace of a declaration, its kind and its name. An implied namespace depends on kind and name."""


@dataclass(frozen=True, slots=True)
class _Group:
    """Names of declarations in one namespace. ``repeated`` are the names that are declared more than once."""

    names: Set[str]
    repeated: Set[str]


def duplicate_iri(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report each declaration of the file whose IRI another declaration, here or in an imported file, already has."""
    scope = snapshot.scope(file.document.uri)
    own: dict[str, list[_Group]] = {}
    for iri, namespace, group in _own_groups(scope.own):
        known = iri or scope.namespace_iri(scope.own, namespace)
        if known is not None:
            own.setdefault(known, []).append(group)
    names = _repeated(own)
    others = _shared(scope, own, names) if scope.is_small else _shared_in_large(snapshot, scope, own, names)
    if not names:
        return
    first: dict[str, Definition] = {}
    ordered = [other for other in scope.uris if other in others] if len(others) > 1 else others
    repeated = tuple(_definitions(file, names))
    wanted = {str(definition.iri) for definition in repeated}
    for other in map(snapshot.file, reversed(list(ordered))):
        if wanted <= first.keys():
            break
        for definition in _definitions(other, names) if other is not None else ():
            first.setdefault(str(definition.iri), definition)
    for definition in repeated:
        other = first.setdefault(str(definition.iri), definition)
        # All members of a ``similar`` set have the same declaration.
        if (other.uri, other.span) != (definition.uri, definition.span):
            yield _report(other, definition)


def _report(first: Definition, second: Definition) -> Diagnostic:
    message = (
        f"'{second.symbol.name}' is already the name of something else in this namespace (both are <{second.iri}>): "
        "give one of the two another name or namespace"
    )
    related = (Related(first.uri, first.span, "the first declaration"),)
    return Diagnostic(second.uri, second.span, Severity.ERROR, "duplicate-iri", message, related)


def _definitions(file: FileAnalysis, names: set[str]) -> Iterator[Definition]:
    """Yield the declarations of a file that have one of the given names and their own IRI."""
    for path in file.definitions:
        if path.rpartition(".")[2] in names:
            definition = file.definitions[path]
            if definition.iri is not None and definition.kind in UNIQUE_KINDS:
                yield definition


def _repeated(own: Mapping[str, list[_Group]]) -> set[str]:
    """Return the names that occur more than once in the same namespace."""
    found: set[str] = set()
    for groups in own.values():
        seen: set[str] = set()
        for group in groups:
            found |= group.repeated
            if len(groups) > 1:
                found |= seen & group.names
                seen |= group.names
    return found


def _shared(scope: Scope, own: Mapping[str, list[_Group]], names: set[str]) -> set[str]:
    """Return the other files that may declare the same nodes, and add the names of these nodes."""
    found: set[str] = set()
    for other in scope.files[1:]:
        for iri, _, theirs in _own_groups(other):
            for known, groups in own.items():
                common = [group.names & theirs.names for group in groups] if iri in (known, None) else []
                if any(common):
                    found.add(other.document.uri)
                    names.update(*common)
    return found


def _shared_in_large(snapshot: Snapshot, scope: Scope, own: Mapping[str, list[_Group]], names: set[str]) -> set[str]:
    """Do the same as ``_shared`` by an index of names, because a large scope has too many files to compare."""
    declaring, uri = _declaring(snapshot), scope.own.document.uri
    found: set[str] = set()
    for iri, groups in own.items():
        for name in frozenset[str]().union(*(group.names for group in groups)):
            files = [other for key in (iri, None) for other in declaring.get((key, name), ())]
            others = [other for other in files if other != uri and scope.reaches(other)]
            names.update([name] if others else [])
            found.update(others)
    return found


@kept_with_key
def _declaring(snapshot: Snapshot) -> Mapping[Node, list[str]]:
    """Return a map from each node to the files that declare it. In unknown namespaces, the IRI is ``None``."""
    found: dict[Node, list[str]] = {}
    for uri, source in snapshot.sources.items():
        for iri, _, group in _own_groups(source) if isinstance(source, FileIndex) else ():
            for name in group.names:
                found.setdefault((iri, name), []).append(uri)
    return found


@kept_with_key
def _own_groups(file: FileIndex) -> tuple[tuple[str | None, str, _Group], ...]:
    """Return each namespace with its unique names: its IRI (``None`` if imported), its name and its group."""
    iris: dict[str, str] = {}
    for placed in file.declarations:
        root = placed.declaration.tree
        if isinstance(root, tree.Namespace):
            iris.setdefault(root.name.text, root.iri.value)
    found: list[tuple[str | None, str, _Group]] = []
    for (written, kind, path), group in _grouped(_NODES.of(file)).items():
        namespace = written
        if namespace == FILE_NAMESPACE:
            namespace = implied_namespace(file, kind, path) or FILE_NAMESPACE
        found.append((iris.get(namespace), namespace, group))
    return tuple(found)


def _nodes(declaration: Declaration) -> Iterator[tuple[_Owner, str]]:
    for namespace, names in facts_of(declaration).own_names.items():
        first, owner = declaration.symbols[0], (namespace, SymbolKind.STORY, "")
        if namespace == FILE_NAMESPACE and first.kind in (SymbolKind.EVENT, SymbolKind.TASK):
            owner = (namespace, first.kind, first.path)
        yield from ((owner, name) for name in names)


_NODES = Tally[tuple[_Owner, str]](_nodes)


@kept_with_key
def _grouped(counts: Counts[tuple[_Owner, str]]) -> Mapping[_Owner, _Group]:
    names: dict[_Owner, set[str]] = {}
    repeated: dict[_Owner, set[str]] = {}
    for (owner, name), count in counts.by_fact.items():
        names.setdefault(owner, set()).add(name)
        if count > 1:
            repeated.setdefault(owner, set()).add(name)
    return {owner: _Group(found, repeated.get(owner, frozenset())) for owner, found in names.items()}
