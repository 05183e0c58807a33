"""Tables that list the elements of a scene."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass

from robbdd_tools.base.property_values import ELEMENT, PropertyValue
from robbdd_tools.gherkin import text
from robbdd_tools.gherkin.steps import StepWriter
from robbdd_tools.graph.acceptance_model import Cell, Iri, SceneModel
from robbdd_tools.graph.shown_properties import Column

NAME_COLUMN = "name"
"""The first column of every table."""


@dataclass(frozen=True, slots=True)
class SceneTable:
    """A Gherkin step that sets up a part of the scene, with its table of elements.

    ``columns`` are the names of the columns: ``name`` and the properties that the scene shows. ``rows`` has the cells
    of each element.
    """

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]

    @property
    def names(self) -> tuple[str, ...]:
        """The cells of the first column."""
        return tuple(row[0] for row in self.rows)


def scene_tables(writer: StepWriter, scene: SceneModel) -> tuple[SceneTable, ...]:
    """Return the non-empty tables of a scene's members, with the properties that the scene shows."""
    titled = (
        ("a set of objects", scene.objects),
        ("a set of workspaces", scene.workspaces),
        ("a set of agents", scene.agents),
    )
    return tuple(_property_table(writer, title, names, scene.columns) for title, names in titled if names)


def variable_table(writer: StepWriter, elements: Iterable[Iri]) -> tuple[SceneTable, ...]:
    """Return the table of the elements that the values of a scenario add to its scene. Without such elements, none."""
    names = tuple(elements)
    return (name_table("variable scene elements", _names(writer, names)),) if names else ()


def name_table(title: str, names: Iterable[str]) -> SceneTable:
    """Return a table that has only the names of elements, which are cells of a table already."""
    return SceneTable(title, (NAME_COLUMN,), tuple((name,) for name in names))


def members(scene: SceneModel) -> frozenset[Iri]:
    """Return all elements that the tables of a scene list."""
    return frozenset((*scene.objects, *scene.workspaces, *scene.agents))


def extra_elements(cells: Iterable[Cell], kinds: Mapping[Iri, str], present: Collection[Iri]) -> tuple[Iri, ...]:
    """Return the scene elements among some values that are not yet in the scene.

    The keys of ``kinds`` are all scene elements, and ``present`` are the elements that are already in the scene.
    """
    return tuple(element for element in elements_of(cells) if element in kinds and element not in present)


def elements_of(cells: Iterable[Cell]) -> tuple[Iri, ...]:
    """Return the IRIs among the values of a scenario, including those in sets, each IRI once and in order."""
    found: dict[Iri, None] = {}
    for cell in cells:
        for value in cell if isinstance(cell, tuple) else (cell,):
            if isinstance(value, Iri):
                found.setdefault(value)
    return tuple(found)


def _property_table(writer: StepWriter, title: str, members: tuple[Iri, ...], columns: Iterable[Column]) -> SceneTable:
    """Return the table of a scene's members of one kind. A column chosen for one set has the values of all members."""
    shown: dict[str, Column] = {}
    for column in columns:
        if column.name != NAME_COLUMN and not column.elements.isdisjoint(members):
            shown.setdefault(column.name, column)
    cells = ((_cell(writer, column.values.get(member, ())) for column in shown.values()) for member in members)
    rows = tuple((name, *row) for name, row in zip(_names(writer, members), cells, strict=True))
    return SceneTable(title, (NAME_COLUMN, *shown), rows)


def _cell(writer: StepWriter, values: Iterable[PropertyValue]) -> str:
    written = (writer.curie(Iri(one.text)) if one.kind == ELEMENT else text.free(one.text) for one in values)
    return text.cell(", ".join(written))


def _names(writer: StepWriter, elements: Iterable[Iri]) -> Iterator[str]:
    return (text.cell(writer.curie(element)) for element in elements)
