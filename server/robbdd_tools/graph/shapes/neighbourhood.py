"""What each declaration of a graph depends on, in a form that can be compared with an earlier revision's."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from robbdd_tools.graph.write.declarations import Key, Reached, Uses, reach
from robbdd_tools.graph.write.identities import identities
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.names.anchors import Anchor
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import Declaration

Identity = tuple[str, "Declaration", int]
"""What is the same declaration in two revisions: its document, its text (by identity), which one of equal text."""
Fingerprint = tuple[object, ...]
"""All that findings in a declaration depend on, besides its text and what it leads to."""


class Neighbourhoods:
    """The declarations of a file's graph, what each depends on and who depends on it, in one revision."""

    def __init__(self, snapshot: Snapshot, uri: str) -> None:
        self.uses = Uses(snapshot.closure(uri))
        self.reached = reach(self.uses)
        self.known = identities(snapshot, self.reached)
        self._by_key = {entry.key: entry for entry in self.reached}
        self._identities = dict(self._identified())
        self._present = frozenset(self._identities.values())
        self._partners: dict[Key, list[Reached]] = {}
        self._seen_as: dict[Key, list[object]] = {}
        self._add_declarers()
        self._add_compositions()

    def identity(self, entry: Reached) -> Identity:
        """Return what a declaration is known by in other revisions."""
        return self._identities[entry.key]

    def fingerprint(self, entry: Reached) -> Fingerprint:
        """Return what, besides its text, says how a declaration stands in its graph."""
        return (
            tuple(self._identities[used.key] for used in self._leads_to(entry)),
            self.uses.has_error(entry),
            self.known.starts[entry.key],
            tuple(self._seen_as.get(entry.key, ())),
        )

    def complete(self, entries: Iterable[Reached]) -> tuple[Reached, ...]:
        """Return some declarations with all that they depend on, in the order of the graph."""
        found = {entry.key for entry in entries}
        waiting = [self._by_key[key] for key in found]
        while waiting:
            for other in self._leads_to(waiting.pop()):
                if other.key not in found:
                    found.add(other.key)
                    waiting.append(other)
        return tuple(entry for entry in self.reached if entry.key in found)

    def touched_by(self, changed: Iterable[Reached]) -> list[Reached]:
        """Return some declarations with all that depend on them."""
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
        used = self.uses.of(entry)
        partners = self._partners.get(entry.key)
        return used if partners is None else used + partners

    def _identified(self) -> Iterator[tuple[Key, Identity]]:
        seen: Counter[tuple[str, Declaration]] = Counter()
        for entry in self.reached:
            which = (entry.uri, entry.placed.declaration)
            yield entry.key, (*which, seen[which])
            seen[which] += 1

    def _add_declarers(self) -> None:
        """Who contests a node depends on the others; who shares one sees it named by the first."""
        for declarers in self.known.contested.values():
            others = [self._by_key[declarer.key] for declarer in declarers]
            for declarer in declarers:
                self._partners.setdefault(declarer.key, []).extend(others)
        for iri, declarers in self.known.shared.items():
            first = declarers[0]
            for declarer in declarers:
                self._seen_as.setdefault(declarer.key, []).append((iri, first.symbol.path))

    def holds(self, anchor: Anchor) -> bool:
        """Tell whether the declaration that a place counts from is still there."""
        return anchor.declaration is None or (anchor.uri, anchor.declaration, 0) in self._present

    def _add_compositions(self) -> None:
        """A composition encloses what those of the workspaces in it hold, whether it names these or not."""
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


def _iri(entry: Reached, ref: tree.Ref) -> str | None:
    target = entry.placed.targets.get(ref)
    return None if target is None else target.iri
