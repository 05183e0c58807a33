"""Determine the dependencies of each declaration of a graph. They can be compared between revisions."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from robbdd_tools.graph.write.declarations import Key, Reached, Uses, declarers_of, reachable_declarations
from robbdd_tools.graph.write.identities import identities
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.graph.write.imported_graphs import ImportedGraph
    from robbdd_tools.names.anchors import Anchor
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import Declaration

Identity = tuple[str, "Declaration", int]
"""A declaration across revisions, identified by its document, its text object, and its index among equal texts."""
Fingerprint = tuple[object, ...]
"""All data on which findings in a declaration depend, except its text and the contents of used declarations."""


class Neighbourhoods:
    """The declarations in the graph of one revision of a file, with their dependencies and dependents."""

    def __init__(self, snapshot: Snapshot, uri: str, imported: ImportedGraph) -> None:
        self.uses = Uses(snapshot.closure(uri))
        self.reached = reachable_declarations(self.uses, imported.nodes)
        self.known = identities(snapshot, self.reached)
        self._by_key = {entry.key: entry for entry in self.reached}
        self._identities = dict(self._identified())
        self._present = frozenset(self._identities.values())
        self._partners: dict[Key, list[Reached]] = {}
        self._seen_as: dict[Key, list[object]] = {}
        self._add_declarers()
        self._add_compositions()
        self._add_imported(imported)

    def identity(self, entry: Reached) -> Identity:
        """Return a key that identifies a declaration in all revisions of the file."""
        return self._identities[entry.key]

    def fingerprint(self, entry: Reached) -> Fingerprint:
        """Return the data outside a declaration's own text that affects its findings."""
        return (
            tuple(self._identities[used.key] for used in self._leads_to(entry)),
            self.uses.has_error(entry),
            self.known.starts[entry.key],
            tuple(self._seen_as.get(entry.key, ())),
        )

    def complete(self, entries: Iterable[Reached]) -> tuple[Reached, ...]:
        """Return some declarations and all their dependencies, in the order of the graph."""
        found = {entry.key for entry in entries}
        waiting = [self._by_key[key] for key in found]
        while waiting:
            for other in self._leads_to(waiting.pop()):
                if other.key not in found:
                    found.add(other.key)
                    waiting.append(other)
        return tuple(entry for entry in self.reached if entry.key in found)

    def dependents_of(self, changed: Iterable[Reached]) -> list[Reached]:
        """Return some declarations and all declarations that depend on them."""
        waiting = list(changed)
        if not waiting:
            return []
        users: dict[Key, list[Reached]] = {}
        for entry in self.reached:
            for used in self._leads_to(entry):
                users.setdefault(used.key, []).append(entry)
        found = {entry.key: entry for entry in waiting}
        while waiting:
            for user in users.get(waiting.pop().key, ()):
                if user.key not in found:
                    found[user.key] = user
                    waiting.append(user)
        return list(found.values())

    def _leads_to(self, entry: Reached) -> list[Reached]:
        """Return the declarations that a declaration needs.

        The head of a story also needs a scenario, because a story without scenarios is reported.
        """
        used = self.uses.of(entry)
        if entry.is_head:
            used = [*used, *self.uses.story(entry)[1:2]]
        partners = self._partners.get(entry.key)
        return used if partners is None else used + partners

    def _identified(self) -> Iterator[tuple[Key, Identity]]:
        seen: Counter[tuple[str, Declaration]] = Counter()
        for entry in self.reached:
            which = (entry.uri, entry.placed.declaration)
            yield entry.key, (*which, seen[which])
            seen[which] += 1

    def _add_declarers(self) -> None:
        """Record which declarations name the same node.

        If only one of them can have the node, each becomes a dependency of the others. If they share it, the first name
        of the node is recorded. A story that does not get its node is not written, so all its scenarios depend on the
        node's declarers.
        """
        for declarers in self.known.contested.values():
            others = [self._by_key[declarer.key] for declarer in declarers]
            for other in others:
                for part in self.uses.story(other) if other.is_head else (other,):
                    self._partners.setdefault(part.key, []).extend(others)
        for iri, declarers in self.known.shared.items():
            first = declarers[0]
            for declarer in declarers:
                self._seen_as.setdefault(declarer.key, []).append((iri, first.symbol.path))

    def holds(self, anchor: Anchor) -> bool:
        """Return whether the declaration that contains an anchor still exists."""
        return anchor.declaration is None or (anchor.uri, anchor.declaration, 0) in self._present

    def _add_compositions(self) -> None:
        """Record that a composition depends on the compositions of the workspaces in it.

        The composition need not name these compositions.
        """
        compositions = [entry for entry in self.reached if isinstance(entry.tree, tree.Composition)]
        describing: dict[str, list[Reached]] = {}
        for entry in compositions:
            if isinstance(entry.tree, tree.Composition) and (iri := _iri(entry, entry.tree.workspace)) is not None:
                describing.setdefault(iri, []).append(entry)
        for entry in compositions:
            for link in entry.tree.entries if isinstance(entry.tree, tree.Composition) else ():
                iri = _iri(entry, link.reference)
                if iri in describing:
                    self._partners.setdefault(entry.key, []).extend(describing[iri])

    def _add_imported(self, imported: ImportedGraph) -> None:
        """Record that a declaration depends on the declarations to which imported graphs link its nodes."""
        declarers = declarers_of(self.reached, imported.nodes)
        for subject, value in sorted(imported.links):
            for entry in declarers.get(subject, ()):
                others = [other for other in declarers.get(value, ()) if other.key != entry.key]
                if others:
                    self._partners.setdefault(entry.key, []).extend(others)


def _iri(entry: Reached, ref: tree.Ref) -> str | None:
    target = entry.placed.targets.get(ref)
    return None if target is None else target.iri
