"""Replace the model's values of variables of scenarios by the points of an experimental design."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product

from robbdd_tools.gherkin.select import SelectionError
from robbdd_tools.gherkin.variations import bindings, cells_of, count
from robbdd_tools.gherkin.where import variable_names
from robbdd_tools.graph.acceptance_model import AcceptanceModel, Cell, Iri, Product, Table, Variant
from robbdd_tools.protocol.specs import ScenarioSpec, plain_name
from robbdd_tools.run.seeds import scenario_seed

MOST_SCENARIOS = 1_000_000
"""Limit of the scenarios of a variant whose values are points, because all of them are in memory."""


@dataclass(frozen=True, slots=True)
class Points:
    """Values of variables for scenarios.

    - ``variables``: their names as in ``--where``: alone, with their template, or as a CURIE.
    - ``rows``: the values of one point each, in the order of the variables.
    - ``levels``: for a grid, the values of each variable. Their combinations are the points, and ``rows`` is empty.
    - ``units``: the unit of each variable. If the model's values are quantities (``0.25 m/s``), those of points are,
      too.
    """

    variables: tuple[str, ...]
    rows: tuple[tuple[float, ...], ...] = ()
    levels: tuple[tuple[float, ...], ...] = ()
    units: tuple[str, ...] = ()


def with_points(model: AcceptanceModel, points: Points | None) -> AcceptanceModel:
    """Return a model in which the points replace the values of the named variables.

    Each combination of the other variables' values is executed at each point. A variant that has only some of the
    variables gets only their values. A variant that has none of them is unchanged. Raises ``SelectionError``.
    """
    if points is None:
        return model
    stories = tuple(
        replace(story, variants=tuple(_at_points(model, variant, points) for variant in story.variants))
        for story in model.stories
    )
    return replace(model, stories=stories)


def _at_points(model: AcceptanceModel, variant: Variant, points: Points) -> Variant:
    columns = {
        place: points.variables.index(names.pop())
        for place, variable in enumerate(variant.variation.variables)
        if (names := set(variable_names(model, variant, variable)) & set(points.variables))
    }
    if not columns:
        return variant
    variation = variant.variation
    written = {place: _writer(variation, place, points.units, column) for place, column in columns.items()}
    if points.levels and isinstance(variation, Product):
        choices = tuple(
            tuple(map(written[place], points.levels[columns[place]])) if place in columns else found
            for place, found in enumerate(variation.choices)
        )
        return replace(variant, variation=replace(variation, choices=choices))
    others = tuple(one for place, one in enumerate(variation.variables) if place not in columns)
    rows = list(dict.fromkeys(_projected(points, tuple(columns.values()))))
    if count(variation) * len(rows) > MOST_SCENARIOS:
        name = model.curie(variant.iri)
        raise SelectionError(
            f"{name} has more than {MOST_SCENARIOS} scenarios at {len(rows)} points: take fewer points"
        )
    return replace(
        variant,
        variation=Table(
            variation.variables, tuple(_rows(variation, others, list(written.values()), list(columns), rows))
        ),
    )


def _projected(points: Points, columns: Sequence[int]) -> Iterator[tuple[float, ...]]:
    """Yield the points' values of some of the variables."""
    if points.levels:
        yield from product(*(points.levels[column] for column in columns))
    for row in points.rows:
        yield tuple(row[column] for column in columns)


def _writer(
    variation: Product | Table, place: int, units: Sequence[str], column: int
) -> Callable[[float], float | str]:
    """Return a function that writes a value as the model writes the variable's values: with or without a unit."""
    cells = variable_cells(variation, place)
    unit = units[column] if units and any(isinstance(cell, str) for cell in cells) else ""
    return (lambda value: f"{value!r} {unit}") if unit else lambda value: value


def variable_cells(variation: Product | Table, place: int) -> Iterable[Cell]:
    """Return the values of a variable, given by its position in the variation."""
    return (
        cells_of(variation.choices[place]) if isinstance(variation, Product) else [row[place] for row in variation.rows]
    )


def _rows(
    variation: Product | Table,
    others: Sequence[Iri],
    writers: Sequence[Callable[[float], Cell]],
    places: Sequence[int],
    rows: Sequence[tuple[float, ...]],
) -> Iterator[tuple[Cell, ...]]:
    kept = dict.fromkeys(tuple(values[name] for name in others) for values in bindings(variation))
    cells = [[write(value) for write, value in zip(writers, row, strict=True)] for row in rows]
    for former in kept:
        for row in cells:
            values, found = iter(former), dict(zip(places, row, strict=True))
            yield tuple(found[place] if place in found else next(values) for place in range(len(variation.variables)))


def block_seeds(seed: int) -> Callable[[ScenarioSpec], ScenarioSpec]:
    """Return a function that gives an execution a seed that depends only on its repetition.

    Seeds of scenes (``has config seed``) and of executions of behaviour trees do not change.
    """

    def seeded(spec: ScenarioSpec) -> ScenarioSpec:
        return replace(spec, seed=scenario_seed(seed, "repetition", 1, spec.repetition))

    return seeded


def common_seeds(variables: Sequence[str], seed: int) -> Callable[[ScenarioSpec], ScenarioSpec]:
    """Return a function that gives an execution a seed that does not depend on the values of some variables.

    So the executions at all points differ only in these values. Seeds of scenes (``has config seed``) and of executions
    of behaviour trees do not change. ``variables`` are names as in users' code (``plain_name``).
    """

    def seeded(spec: ScenarioSpec) -> ScenarioSpec:
        others = {name: value for name, value in spec.values.items() if plain_name(name) not in variables}
        key = f"{spec.variant} {json.dumps(others, sort_keys=True)}"
        return replace(spec, seed=scenario_seed(seed, key, 1, spec.repetition))

    return seeded
