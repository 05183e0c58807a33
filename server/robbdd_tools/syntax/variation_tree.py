"""Syntax trees of variations: the values of variables in the scenarios of a variant."""

from __future__ import annotations

from dataclasses import dataclass

from robbdd_tools.syntax.scene_tree import Link, Node, Number, Quantity, Ref, Text, Where

Value = Ref | Quantity | Number | Text


@dataclass(frozen=True, slots=True)
class ValueList(Node):
    """``{ value, value }``."""

    values: tuple[Value, ...]


SetExpression = Link | ValueList


@dataclass(frozen=True, slots=True)
class Selection(Node):
    """``select N [repeated] combinations|permutations from <set> [where …]``."""

    count: Number
    repeated: bool
    kind: str
    source: Ref
    where: Where | None


@dataclass(frozen=True, slots=True)
class SetList(Node):
    """``{ { … }, { … } }``."""

    sets: tuple[ValueList, ...]


@dataclass(frozen=True, slots=True)
class Assignment(Node):
    """``var <v>: SET`` or ``set var <v>: SETS``."""

    variable: Ref
    choices: SetExpression | Selection | SetList


@dataclass(frozen=True, slots=True)
class Product(Node):
    """Cartesian product of the assignments."""

    assignments: tuple[Assignment, ...]


@dataclass(frozen=True, slots=True)
class TableRow(Node):
    """One row of values."""

    cells: tuple[Value | SetExpression, ...]


@dataclass(frozen=True, slots=True)
class Table(Node):
    """Header of variables and rows of values."""

    header: tuple[Ref, ...]
    rows: tuple[TableRow, ...]
