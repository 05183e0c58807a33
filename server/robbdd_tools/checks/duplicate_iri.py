"""``duplicate-iri``: two declarations have the same IRI, so the graph would merge them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
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

Node = tuple[str | None, str]
"""IRI of a namespace, ``None`` where it is declared in another file, and a name in it."""


def duplicate_iri(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report each declaration of the file whose IRI another declaration, here or in an imported file, already has."""
    uri = file.document.uri
    scope, declaring = snapshot.scope(uri), _declaring(snapshot)
    names: set[str] = set()
    others: set[str] = set()
    own: Counter[Node] = Counter()
    for iri, namespace, name in _own_names(scope.own):
        known = iri or scope.namespace_iri(scope.own, namespace)
        if known is not None:
            own[known, name] += 1
            files = (other for key in (known, None) for other in declaring.get((key, name), ()))
            found = [other for other in files if other != uri and scope.reaches(other)]
            names.update([name] if found else [])
            others.update(found)
    names.update(name for (_, name), count in own.items() if count > 1)
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
    """Yield the declarations of a file that have one of some names and an IRI of their own."""
    for path in file.definitions:
        if path.rpartition(".")[2] in names:
            definition = file.definitions[path]
            if definition.iri is not None and definition.kind in UNIQUE_KINDS:
                yield definition


@kept_with_key
def _declaring(snapshot: Snapshot) -> Mapping[Node, list[str]]:
    """Return the files that declare each node, those of unknown namespaces by name."""
    found: dict[Node, list[str]] = {}
    for uri, source in snapshot.sources.items():
        for iri, _, name in _own_names(source) if isinstance(source, FileIndex) else ():
            found.setdefault((iri, name), []).append(uri)
    return found


@kept_with_key
def _own_names(file: FileIndex) -> tuple[tuple[str | None, str, str], ...]:
    """Return the names that must be unique: the IRI of the namespace, ``None`` if imported, its name, and the name."""
    iris: dict[str, str] = {}
    for placed in file.declarations:
        root = placed.declaration.tree
        if isinstance(root, tree.Namespace):
            iris.setdefault(root.name.text, root.iri.value)
    found: list[tuple[str | None, str, str]] = []
    for placed in file.declarations:
        for written, names in facts_of(placed.declaration).own_names.items():
            namespace = written
            if namespace == FILE_NAMESPACE:
                namespace = namespace_of(file, placed.declaration.symbols[0]) or FILE_NAMESPACE
            found += ((iris.get(namespace), namespace, name) for name in names)
    return tuple(found)
