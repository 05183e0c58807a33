"""A graph file with its acceptance criteria, as the rules for graph files need it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.base.files import uri_to_path
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.graph.acceptance_model import Cell, Iri, Product, Selection, Value
from robbdd_tools.graph.read.acceptance import read_instances, read_model
from robbdd_tools.graph.write.source_map import Location

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import ObjectModel, RobotModel
    from robbdd_tools.catalog.executable import SceneInstance
    from robbdd_tools.graph.acceptance_model import AcceptanceModel, Variant
    from robbdd_tools.graph.write.built import BuiltGraph


@dataclass(frozen=True)
class GraphSite:
    """A graph, the acceptance criteria in it and all of its scene instances."""

    built: BuiltGraph
    model: AcceptanceModel
    instances: tuple[SceneInstance, ...]

    @classmethod
    def of(cls, built: BuiltGraph) -> GraphSite:
        """Read the acceptance criteria of a graph."""
        model = read_model(built.graph, records=built.records)
        return cls(built, model, read_instances(built.graph, records=built.records))

    @cached_property
    def variants(self) -> tuple[Variant, ...]:
        """All variants that can become scenarios, in written order."""
        return tuple(variant for story in self.model.stories for variant in story.variants)

    @cached_property
    def sets(self) -> dict[Iri, tuple[str, ...]]:
        """Element → the local names of its sets. These names also select models."""
        found: dict[Iri, tuple[str, ...]] = {}
        for name, elements in self.model.sets.items():
            for element in elements:
                if isinstance(element, Iri):
                    found[element] = (*found.get(element, ()), self.local_name(name))
        return found

    def name(self, node: str) -> str:
        """Return the name of a node in messages."""
        return self.built.names.get(node, node)

    def local_name(self, node: str) -> str:
        """Return the local name of a node, which selects its model."""
        return self.model.curie(node).rpartition(":")[2]

    def object_model(self, element: Iri) -> ObjectModel | None:
        """Return the catalog's model for the name of an object."""
        return load_catalog().object_for(self.local_name(element), self.sets.get(element, ()))

    def robot_model(self, element: Iri) -> RobotModel | ObjectModel | None:
        """Return the catalog's model for the name of an agent. For a person, this is the model of an object."""
        catalog, names = load_catalog(), (self.local_name(element), self.sets.get(element, ()))
        return catalog.robot_for(*names) or catalog.bystander_for(*names)

    def location(self, node: str) -> Location:
        """Return the position of a node, or the beginning of the file if the position is unknown."""
        return self.built.sources.node(node) or Location(self.built.uri, Span(0, 0))

    def folder(self, node: str) -> Path | None:
        """Return the folder of the file that describes a node; ``None`` for a text without a file."""
        path = uri_to_path(self.location(node).uri)
        return None if path is None else path.parent

    def finding(self, node: str, code: str, message: str, severity: Severity = Severity.WARNING) -> Diagnostic:
        """Return a diagnostic at a node. The message begins with the node's name."""
        place = self.location(node)
        return Diagnostic(place.uri, place.span, severity, code, f"'{self.name(node)}': {message}")


def values_of(variant: Variant) -> Iterator[tuple[Iri, Cell]]:
    """Yield each variable of a variation with each of its values. For a selection, the value is the whole set."""
    variation = variant.variation
    if isinstance(variation, Product):
        for variable, choices in zip(variation.variables, variation.choices, strict=True):
            cells = (choices.source,) if isinstance(choices, Selection) else choices
            yield from ((variable, cell) for cell in cells)
        return
    for row in variation.rows:
        yield from zip(variation.variables, row, strict=True)


def members(cell: Cell) -> tuple[Value, ...]:
    """Return the values in a cell of a variation."""
    return cell if isinstance(cell, tuple) else (cell,)
