"""Tables that list the elements of a scene."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass

from robbdd_tools.gherkin import text
from robbdd_tools.gherkin.steps import StepWriter
from robbdd_tools.graph.acceptance_model import Cell, Iri, SceneModel


@dataclass(frozen=True, slots=True)
class SceneTable:
    """A Gherkin step that sets up a part of the scene, with its one-column table of element names."""

    title: str
    names: tuple[str, ...]


def scene_tables(writer: StepWriter, scene: SceneModel) -> tuple[SceneTable, ...]:
    """Return the non-empty tables of a scene's members."""
    titled = (
        ("a set of objects", scene.objects),
        ("a set of workspaces", scene.workspaces),
        ("a set of agents", scene.agents),
    )
    return tuple(_table(writer, title, names) for title, names in titled if names)


def variable_table(writer: StepWriter, elements: Iterable[Iri]) -> tuple[SceneTable, ...]:
    """Return the table of the elements that the values of a scenario add to its scene. Without such elements, none."""
    names = tuple(elements)
    return (_table(writer, "variable scene elements", names),) if names else ()


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


def _table(writer: StepWriter, title: str, names: Iterable[Iri]) -> SceneTable:
    return SceneTable(title, tuple(text.cell(writer.curie(name)) for name in names))
