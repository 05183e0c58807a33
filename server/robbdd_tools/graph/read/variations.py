"""Read variations into plain data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.graph.acceptance_model import Cell, Iri, Product, Selection, Table, Value
from robbdd_tools.graph.rdf.records import Incomplete, Records
from robbdd_tools.graph.rdf.vocabulary import SELECTIONS

if TYPE_CHECKING:
    from rdflib.term import Node


@dataclass(frozen=True, slots=True)
class VariationReader:
    """Reads variations, given the elements of every constant set. Raises ``Incomplete``."""

    records: Records
    sets: Mapping[Iri, tuple[Value, ...]]

    def variation(self, node: Iri) -> Product | Table:
        """Return a table or a Cartesian product."""
        variables = self.records.iris(self.records.list_of(node, "bdd:variable-list"))
        if self.records.is_a(node, "bdd:TableVariation"):
            rows = tuple(self._row(row, len(variables)) for row in self.records.list_of(node, "bdd:rows"))
            return Table(variables, rows)
        entries = self.records.list_of(node, "bdd:of-sets")
        if len(entries) != len(variables):
            raise Incomplete(f"{node} has {len(entries)} sets for {len(variables)} variables")
        pairs = zip(variables, map(self._choices, entries), strict=True)
        return Product(variables, tuple(self._fitting(variable, choices) for variable, choices in pairs))

    def _fitting(self, variable: Iri, choices: tuple[Cell, ...] | Selection) -> tuple[Cell, ...] | Selection:
        """Return the choices for a variable. If it is not a set, a selection of one element becomes the elements.

        Published graphs write such a selection for a variable that is not a set.
        """
        single = isinstance(choices, Selection) and choices.length == 1 and not self.records.is_a(variable, "bdd:Set")
        return choices.source if isinstance(choices, Selection) and single else choices

    def _row(self, row: Node, width: int) -> tuple[Cell, ...]:
        cells = self.records.items(row)
        if cells is None or len(cells) != width:
            raise Incomplete(f"a row does not have {width} cells")
        return tuple(self._cell(cell) for cell in cells)

    def _cell(self, node: Node) -> Cell:
        items = self.records.items(node)
        if items is not None:
            return tuple(self.records.value(item) for item in items)
        value = self.records.value(node)
        return self.sets.get(value, value) if isinstance(value, Iri) else value

    def _choices(self, node: Node) -> tuple[Cell, ...] | Selection:
        items = self.records.items(node)
        if items is not None:
            return tuple(self._cell(item) for item in items)
        value = self.records.value(node)
        if isinstance(value, Iri):
            for kind, type_ in SELECTIONS.items():
                if self.records.is_a(value, type_):
                    return self._selection(value, kind)
            if value in self.sets:
                return self.sets[value]
        raise Incomplete(f"{value} is not a set of values")

    def _selection(self, node: Iri, kind: str) -> Selection:
        source = self.records.one(node, "bdd:from")
        length = self.records.literal(node, "bdd:length")
        if source not in self.sets or not isinstance(length, int) or length < 1:
            raise Incomplete(f"{node} does not say how many elements of which set it selects")
        repeated = self.records.text(node, "bdd:repetition-allowed") == "true"
        return Selection(kind, self.sets[source], length, repeated)
