"""``duplicate-iri``: two declarations with the same IRI, which the graph would merge."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Related, Severity
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.checks.facts import UNIQUE_KINDS, facts_of
from robbdd_tools.names.index import FileIndex
from robbdd_tools.names.namespaces import namespace_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import FILE_NAMESPACE

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot

Taken = Mapping[str, Mapping[str, int]]
"""IRI of a namespace → name → number of declarations."""


def duplicate_iri(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report each declaration of the file whose IRI is already used, here or in an imported file."""
    uri = file.document.uri
    files = snapshot.scope(uri).files
    if not _may_repeat(snapshot, files[0]):
        return
    own, imported = _taken_by(files[:1], files), _taken(files[1:])
    names: set[str] = set()
    for namespace, counted in own.items():
        names |= counted.keys() & imported.get(namespace, {}).keys()
        names.update(name for name, count in counted.items() if count > 1)
    if not names:
        return
    first: dict[str, Definition] = {}
    for other in snapshot.closure(uri)[:0:-1]:
        for definition in _definitions(other, names):
            first.setdefault(str(definition.iri), definition)
    for definition in _definitions(file, names):
        other = first.setdefault(str(definition.iri), definition)
        # All members of a similar set share one declaration.
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
    """Yield the declarations of a file that have some names and an IRI of their own."""
    for path in file.definitions:
        if path.rpartition(".")[2] in names:
            definition = file.definitions[path]
            if definition.iri is not None and definition.kind in UNIQUE_KINDS:
                yield definition


def _may_repeat(snapshot: Snapshot, file: FileIndex) -> bool:
    """Return whether any name of a file is declared twice in the project, in any namespace: a quick test."""
    counted = _declared(snapshot)
    return any(counted[name] > 1 for name in _own_names(file))


@kept_with_key
def _declared(snapshot: Snapshot) -> Counter[str]:
    files = (source for source in snapshot.sources.values() if isinstance(source, FileIndex))
    return Counter(name for file in files for name in _own_names(file))


@kept_with_key
def _own_names(file: FileIndex) -> tuple[str, ...]:
    owned = (facts_of(placed.declaration).own_names for placed in file.declarations)
    return tuple(name for names in owned for several in names.values() for name in several)


@lru_cache(maxsize=4)
def _taken(files: tuple[FileIndex, ...]) -> Taken:
    return _taken_by(files, files)


def _taken_by(files: Iterable[FileIndex], scope: tuple[FileIndex, ...]) -> Taken:
    """Count the names in some files, whose namespaces are declared in the files themselves or else in a scope."""
    outer = _namespaces(scope)
    found: dict[str, dict[str, int]] = {}
    for file in files:
        namespaces = {**outer, **_namespaces((file,))}
        for placed in file.declarations:
            for namespace, names in facts_of(placed.declaration).own_names.items():
                if namespace == FILE_NAMESPACE:
                    namespace = namespace_of(file, placed.declaration.symbols[0]) or FILE_NAMESPACE
                counted = found.setdefault(namespaces.get(namespace, ""), {})
                for name in names:
                    counted[name] = counted.get(name, 0) + 1
    found.pop("", None)
    return found


def _namespaces(files: Iterable[FileIndex]) -> dict[str, str]:
    """Return the namespaces of some files by name; the nearest file wins."""
    found: dict[str, str] = {}
    for file in files:
        for placed in file.declarations:
            root = placed.declaration.tree
            if isinstance(root, tree.Namespace):
                found.setdefault(root.name.text, root.iri.value)
    return found
