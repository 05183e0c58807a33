"""Move the parsed data of a piece of text to its place in a larger text."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import cache
from itertools import accumulate
from typing import Any, TypeVar, cast, overload

from robbdd_tools.syntax.declaration import Reference, Symbol, SyntaxFault
from robbdd_tools.syntax.scene_tree import Node, Ref, field_names

Entry = TypeVar("Entry")


class InPlace(Sequence[Entry]):
    """The entries of all parts of a text as one sequence. Each entry is moved to its place at the first access.

    The sequence is equal to any sequence with the same entries. An entry is always the same object.
    """

    def __init__(self, parts: Iterable[tuple[int, Sequence[Entry]]], move: Callable[[Entry, int], Entry]) -> None:
        self._parts = [part for part in parts if part[1]]
        self._ends = list(accumulate(len(entries) for _, entries in self._parts))
        self._move = move
        self._moved: dict[int, tuple[Entry, ...]] = {}

    def __len__(self) -> int:
        return self._ends[-1] if self._ends else 0

    @overload
    def __getitem__(self, index: int) -> Entry: ...

    @overload
    def __getitem__(self, index: slice) -> tuple[Entry, ...]: ...

    def __getitem__(self, index: int | slice) -> Entry | tuple[Entry, ...]:
        if isinstance(index, slice):
            return tuple(self[position] for position in range(len(self))[index])
        position = range(len(self))[index]
        part = bisect_right(self._ends, position)
        return self._part(part)[position - self._ends[part]]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Sequence) and tuple(self) == tuple(cast("Sequence[Any]", other))

    def __hash__(self) -> int:
        return hash(tuple(self))

    def _part(self, number: int) -> tuple[Entry, ...]:
        found = self._moved.get(number)
        if found is None:
            offset, entries = self._parts[number]
            found = self._moved[number] = tuple([self._move(entry, offset) for entry in entries])
        return found


def moved_node(node: Any, by: int) -> Any:
    """Return a tree, or the value of one of its fields, with all its spans moved by ``by`` code points."""
    if isinstance(node, Node):
        kind = type(node)
        return kind(node.span.shifted(by), *[_moved(getattr(node, name), by) for name in _inner_fields(kind)])
    return _moved(node, by)


def _moved(value: Any, by: int) -> Any:
    if isinstance(value, Node):
        return moved_node(value, by)
    if isinstance(value, tuple):
        return tuple([_moved(entry, by) for entry in cast(tuple[Any, ...], value)])
    return value


@cache
def _inner_fields(kind: type[Node]) -> tuple[str, ...]:
    """Return the fields of a kind of node without its span, which is always the first field."""
    return field_names(kind)[1:]


def moved_symbol(symbol: Symbol, by: int) -> Symbol:
    """Return a symbol at its place in a larger text."""
    span, extent = symbol.span.shifted(by), symbol.extent.shifted(by)
    # Same as ``replace``, but several times as fast: the outline of a long story makes thousands of these.
    return Symbol(symbol.path, symbol.name, symbol.kind, span, extent, symbol.namespace, symbol.target)


def moved_reference(reference: Reference, by: int) -> Reference:
    """Return a reference at its place in a larger text."""
    return Reference(moved_ref(reference.ref, by), reference.scopes)


def moved_ref(ref: Ref, by: int) -> Ref:
    """Return the ``Ref`` of a reference at its place in a larger text."""
    return Ref(ref.span.shifted(by), ref.role, ref.path)


def moved_fault(fault: SyntaxFault, by: int) -> SyntaxFault:
    """Return a fault and its repair at its place in a larger text."""
    fix = None if fault.fix is None else replace(fault.fix, span=fault.fix.span.shifted(by))
    return SyntaxFault(fault.span.shifted(by), fault.message, fix)
