"""The types of variables, to be shown behind the places where they are declared."""

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
    """What to show behind a declared variable, whose name is at ``span`` (absolute)."""

    span: Span
    type: VariableType

    @property
    def label(self) -> str:
        """The type as it would be written behind the name."""
        return f": {self.type}"


def type_hints(snapshot: Snapshot, uri: str, within: Span) -> list[TypeHint]:
    """Return a hint for each variable declared in a part of a file whose type is known."""
    file = snapshot.file(uri)
    hints: list[TypeHint] = []
    for placed in file.declarations if file is not None else ():
        if placed.span.end < within.start or within.end < placed.span.start:
            continue
        for path, span in _declared(placed):
            definition = None if file is None else file.definitions.get(path)
            if definition is None or definition.span != span or not within.contains(span.end):
                continue
            found = variable_type(snapshot, definition)
            if found.is_known:
                hints.append(TypeHint(span, found))
    return hints


def _declared(placed: PlacedDeclaration) -> Iterator[tuple[str, Span]]:
    """Yield the qualified names of the variables that a declaration introduces, with their absolute spans."""
    root = placed.declaration.tree
    if isinstance(root, tree.Template):
        for variable in root.variables:
            yield f"{root.name.text}.{variable.name.text}", variable.name.span.shifted(placed.offset)
    for clauses in clauses_of(placed.declaration):
        if isinstance(root, tree.Template):
            owner = root.name.text
        elif isinstance(root, tree.Story):
            owner = f"{root.name.text}.{clauses.node.name.text}"
        else:
            continue
        for bound in clauses.bounds:
            yield f"{owner}.{bound.variable.text}", bound.variable.span.shifted(placed.offset)
