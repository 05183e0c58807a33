"""Inlay hints that show the types of variables at their declarations."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.names.types import VariableType, variable_type
from robbdd_tools.names.uses import clauses_of
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.names.analysis import PlacedDeclaration
    from robbdd_tools.names.project import Snapshot


@dataclass(frozen=True, slots=True)
class TypeHint:
    """The inlay hint after a declared variable. ``span`` is the absolute span of the variable's name."""

    span: Span
    type: VariableType

    @property
    def label(self) -> str:
        """The type as text."""
        return f": {self.type}"


def type_hints(snapshot: Snapshot, uri: str, within: Span) -> list[TypeHint]:
    """Return a hint for each variable that a span of a file declares and whose type is known."""
    file = snapshot.file(uri)
    hints: list[TypeHint] = []
    if file is None:
        return hints
    for placed in file.parts(within):
        for path, span in _declared(placed):
            definition = file.definitions.get(path)
            if definition is None or definition.span != span or not within.contains(span.end):
                continue
            found = variable_type(snapshot, definition)
            if found.is_known:
                hints.append(TypeHint(span, found))
    return hints


def _declared(placed: PlacedDeclaration) -> Iterator[tuple[str, Span]]:
    """Yield the qualified name and the absolute span of each variable that a declaration declares."""
    root = placed.declaration.tree
    if isinstance(root, tree.Template):
        for variable in root.variables:
            yield f"{root.name.text}.{variable.name.text}", variable.name.span.shifted(placed.offset)
    for clauses in clauses_of(placed.declaration):
        for bound in clauses.bounds:
            yield f"{clauses.path}.{bound.variable.text}", bound.variable.span.shifted(placed.offset)
