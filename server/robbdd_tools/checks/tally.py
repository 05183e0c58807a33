"""Count facts of the declarations of files. After an edit, only the facts of changed declarations are counted again."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Generic, TypeVar

from robbdd_tools.base.document import common_prefix
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.checks.file_caches import FileCache

if TYPE_CHECKING:
    from robbdd_tools.names.index import FileIndex
    from robbdd_tools.syntax.declaration import Declaration

Fact = TypeVar("Fact", bound=Hashable)
Entry = TypeVar("Entry")


@dataclass(frozen=True, slots=True, eq=False, weakref_slot=True)
class Counts(Generic[Fact]):
    """How often each fact occurs in a file. The counts stay the same object while no fact is added or removed."""

    by_fact: Mapping[Fact, int]


@dataclass(frozen=True, slots=True)
class _Counted(Generic[Fact]):
    parts: tuple[Declaration, ...]
    counts: Counts[Fact]


class Tally(Generic[Fact]):
    """The counts of one kind of facts. ``facts`` returns the facts of a declaration that has no parts."""

    def __init__(self, facts: Callable[[Declaration], Iterable[Fact]]) -> None:
        self._facts = facts
        self._latest = FileCache[_Counted[Fact]]()

    def of(self, file: FileIndex) -> Counts[Fact]:
        """Return how often each fact occurs in the declarations of a file, and in the parts of declarations."""
        uri, parts = file.document.uri, _parts(file)
        known = self._latest.get(uri) or _Counted((), Counts(dict[Fact, int]()))
        counts = self._updated(known, parts)
        self._latest.put(uri, _Counted(parts, counts))
        return counts

    def _updated(self, known: _Counted[Fact], parts: tuple[Declaration, ...]) -> Counts[Fact]:
        start = common_prefix(known.parts, parts)
        old, new = known.parts[start:], parts[start:]
        same = common_prefix(old[::-1], new[::-1])
        gone, fresh = old[: len(old) - same], new[: len(new) - same]
        change = Counter(fact for part in fresh for fact in self._facts(part))
        change.subtract(fact for part in gone for fact in self._facts(part))
        changed = {fact: by for fact, by in change.items() if by}
        if not changed:
            return known.counts
        counts = dict(known.counts.by_fact)
        for fact, by in changed.items():
            count = counts.get(fact, 0) + by
            if count:
                counts[fact] = count
            else:
                del counts[fact]
        return Counts(counts)


@kept_with_key
def _parts(file: FileIndex) -> tuple[Declaration, ...]:
    found: list[Declaration] = []
    for placed in file.declarations:
        declaration = placed.declaration
        if declaration.parts:
            found += [part.declaration for part in declaration.parts]
        else:
            found.append(declaration)
    return tuple(found)
