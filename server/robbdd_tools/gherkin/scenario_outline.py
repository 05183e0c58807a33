"""Write all scenarios of a variant as one Scenario Outline. This is possible if their steps differ only in values."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass

from robbdd_tools.gherkin import text
from robbdd_tools.gherkin.background_tables import SceneTable, elements_of, name_table
from robbdd_tools.gherkin.binding import UnknownElements
from robbdd_tools.gherkin.steps import Step, StepWriter
from robbdd_tools.gherkin.words import Placeholder
from robbdd_tools.graph.acceptance_model import Cell, Clause, Iri, Product, Selection, Table


@dataclass(frozen=True, slots=True)
class Outline:
    """The tables and steps of a Scenario Outline, with ``<column>`` instead of values.

    ``tags`` are the tags of its clauses.
    """

    tags: tuple[str, ...]
    tables: tuple[SceneTable, ...]
    steps: tuple[Step, ...]


def variable_name(variable: Iri) -> str:
    """Return the name of a variable as the user wrote it."""
    return re.split(r"[/#:]", variable)[-1].removeprefix("var-")


def outline(
    writer: StepWriter, clauses: tuple[Clause, ...], variation: Product | Table, present: Collection[Iri]
) -> Outline | None:
    """Return the outline of some clauses, or ``None`` if a table of values cannot express the scenarios.

    A table cannot express them if a quantifier has a set that varies, if parsers would read a cell differently, or if
    only some of a variable's values are in the scene (``present``). With expanded definitions, values may not be sets,
    because a definition is only expanded for single elements.
    """
    columns = {variable: variable_name(variable) for variable in variation.variables}
    cells = list(_cells(variation))
    if writer.expanded and any(isinstance(cell, tuple) for cell in cells):
        return None
    words = [writer.word(cell) for cell in cells]
    if not columns or len(set(columns.values())) < len(columns) or not all(map(_plain, words)):
        return None
    values = {variable: Placeholder(name) for variable, name in columns.items()}
    try:
        steps = tuple(writer.steps(clauses, values))
        without = " ".join(step.text for step in writer.steps(clauses, dict.fromkeys(values, "")))
    except UnknownElements:
        return None
    if any(f"<{name}>" in step_text for name in columns.values() for step_text in (without, *words)):
        return None
    added: list[str] = []
    for index, name in enumerate(columns.values()):
        kinds = {_added(writer, cell, present) for cell in _column(variation, index)}
        if len(kinds) > 1 or kinds == {None}:
            return None
        added += [f"<{name}>"] if kinds == {True} else []
    tables = (name_table("variable scene elements", added),) if added else ()
    tags = tuple(text.tag("clause", clause) for clause in dict.fromkeys(step.clause for step in steps))
    return Outline(tags, tables, steps)


def _added(writer: StepWriter, cell: Cell, present: Collection[Iri]) -> bool | None:
    """Return whether a value adds an element to the scene.

    For a set that adds elements, return ``None``, because the table of added elements would need several rows.
    """
    new = [element for element in elements_of((cell,)) if element in writer.model.kinds and element not in present]
    return None if new and isinstance(cell, tuple) else bool(new)


def _plain(word: str) -> bool:
    """Return whether all parsers read a word in a table cell in the same way."""
    return "\\" not in word and word == word.strip() and word != ""


def _cells(variation: Product | Table) -> Iterator[Cell]:
    for index in range(len(variation.variables)):
        yield from _column(variation, index)


def _column(variation: Product | Table, index: int) -> Iterable[Cell]:
    """Return the values of a variable. For a selection, these are the elements of its set, each as a set of one."""
    if isinstance(variation, Table):
        return (row[index] for row in variation.rows)
    choices = variation.choices[index]
    return ((value,) for value in choices.source) if isinstance(choices, Selection) else choices
