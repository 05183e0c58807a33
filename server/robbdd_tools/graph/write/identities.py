"""Find the declarations that describe the same node, and the name of each node in the text."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.graph.write.declarations import Key, Reached
from robbdd_tools.graph.write.source_map import Location
from robbdd_tools.names.namespaces import namespace_of
from robbdd_tools.names.scope import local_name
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import Declaration, Symbol

VARIABLES = frozenset({SymbolKind.VARIABLE, SymbolKind.SET_VARIABLE})
SHARED = VARIABLES | {SymbolKind.BEHAVIOUR}
"""Kinds whose nodes several templates of a namespace may share."""


@dataclass(frozen=True, slots=True)
class _Named:
    """A name of a node.

    ``local`` is the end of the node's IRI. ``says`` is the content of the declaration, if it may share its node with
    other declarations.
    """

    symbol: Symbol
    local: str
    says: str | None


@dataclass(frozen=True, slots=True)
class Declarer:
    """A declaration that names a node. ``key`` identifies the declaration, and ``symbol`` is the name."""

    key: Key
    symbol: Symbol
    says: str | None

    @property
    def location(self) -> Location:
        """The place of the name."""
        uri, offset = self.key
        return Location(uri, self.symbol.span.shifted(offset))


@dataclass(slots=True)
class Identities:
    """The nodes that some declarations name.

    - ``names``: maps the IRI of a node to its first qualified name.
    - ``starts``: maps a declaration to the IRIs of the namespaces of its nodes; ``None`` for an unknown namespace.
    - ``shared``: the nodes that several declarations define equally.
    - ``contested``: the nodes that declarations define differently, or that only one of them can have.

    ``shared`` and ``contested`` list the declarations that name the node in the order of the graph.
    """

    names: Mapping[str, str]
    starts: Mapping[Key, tuple[str | None, ...]]
    shared: dict[str, list[Declarer]] = field(default_factory=dict[str, list[Declarer]])
    contested: dict[str, list[Declarer]] = field(default_factory=dict[str, list[Declarer]])


def identities(snapshot: Snapshot, reached: Sequence[Reached]) -> Identities:
    """Return the nodes that some declarations name, and classify nodes with several names as shared or contested."""
    names: dict[str, str] = {}
    first: dict[str, tuple[Reached, _Named]] = {}
    repeated: dict[str, list[Declarer]] = {}
    starts: dict[Key, tuple[str | None, ...]] = {}
    iris: dict[tuple[str, str | None], str | None] = {}
    for entry in reached:
        scope = snapshot.scope(entry.uri)
        own: dict[str | None, None] = {}
        for named in _named(entry.placed.declaration):
            namespace = namespace_of(scope.own, named.symbol)
            if (entry.uri, namespace) not in iris:
                iris[entry.uri, namespace] = scope.namespace_iri(scope.own, namespace)
            start = iris[entry.uri, namespace]
            own[start] = None
            if start is None:
                continue
            iri = start + named.local
            if iri not in first:
                first[iri] = (entry, named)
                names[iri] = named.symbol.path
                continue
            other, one = first[iri]
            declarers = repeated.setdefault(iri, [Declarer(other.key, one.symbol, one.says)])
            declarers.append(Declarer(entry.key, named.symbol, named.says))
        starts[entry.key] = tuple(own)
    return _resolved(Identities(names, starts), repeated)


def _resolved(found: Identities, repeated: Mapping[str, list[Declarer]]) -> Identities:
    """Separate shared nodes from contested ones.

    If a declaration names any contested node, it may be left out entirely. So its shared nodes are contested, too.
    """
    for iri, declarers in repeated.items():
        agreed = {declarer.says for declarer in declarers}
        (found.contested if None in agreed or len(agreed) > 1 else found.shared)[iri] = declarers
    unsure = {declarer.key for declarers in found.contested.values() for declarer in declarers}
    for iri in [iri for iri, declarers in found.shared.items() if any(one.key in unsure for one in declarers)]:
        found.contested[iri] = found.shared.pop(iri)
    return found


@kept_with_key
def _named(declaration: Declaration) -> tuple[_Named, ...]:
    words = _behaviours(declaration.tree) if isinstance(declaration.tree, tree.Template) else {}
    return tuple(
        _Named(symbol, local_name(symbol), _states(symbol, words))
        for symbol in declaration.symbols
        if symbol.namespace is not None
    )


def _states(symbol: Symbol, words: Mapping[str, str]) -> str | None:
    if symbol.kind in VARIABLES:
        return str(symbol.kind)
    return words.get(symbol.name) if symbol.kind is SymbolKind.BEHAVIOUR else None


def _behaviours(template: tree.Template) -> dict[str, str]:
    """Return the catalog word of each behaviour of a template by name, including those inside ``for all``."""
    return {use.name.text: use.action.word for use in template.body.behaviours}
