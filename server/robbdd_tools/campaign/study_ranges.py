"""Check the ranges of a study against the variables of its models: names, values, units, permitted values."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.quantity_units import UNITS, split_quantity, units_of
from robbdd_tools.catalog.settings import Setting, SettingError, setting_of
from robbdd_tools.gherkin.scenario_outline import variable_name
from robbdd_tools.gherkin.where import variable_names
from robbdd_tools.graph.acceptance_model import Fluent, Iri, every_clause
from robbdd_tools.syntax.study_content import GRID, MOST_POINTS
from robbdd_tools.workbench.points import variable_cells

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.graph.acceptance_model import AcceptanceModel, Variant
    from robbdd_tools.syntax.study_content import Range, StudyText

Fault = tuple["Span", str]
NEEDS_DESIGN = "a range needs a design: write 'design: latin-hypercube 20', 'design: sobol 32' or 'design: grid 5'"
NEEDS_RANGE = "a design needs a range: write 'factor var <NAME>: from 0.1 to 0.5'"


def form_faults(content: StudyText) -> Iterator[Fault]:
    """Yield faults of form: ranges without a design, a design without ranges, settings that would break a design."""
    design = content.design
    if design is None:
        if content.ranges:
            yield content.ranges[0].span, NEEDS_DESIGN
        return
    if not content.ranges:
        yield design.span, NEEDS_RANGE
    if design.kind == GRID and design.size ** len(content.ranges) > MOST_POINTS:
        message = f"{design.size} levels of {len(content.ranges)} ranges are more than {MOST_POINTS:,} points"
        yield design.span, f"{message}: take fewer levels, or 'latin-hypercube'"
    for name in ("first", "sample", "pairwise"):
        if name in content.places and design.kind != GRID:
            message = f"'{name}' would take points out of the design: remove it, or take fewer points"
            yield content.places[name], message


def range_faults(models: Iterable[AcceptanceModel], ranges: Iterable[Range]) -> Iterator[Fault]:
    """Yield the faults that prevent a study's ranges from replacing the values of its models' variables."""
    every = [(model, variant) for model in models for story in model.stories for variant in story.variants]
    taken: dict[tuple[Iri, Iri], str] = {}
    for one in ranges:
        found = [
            (model, variant, variable)
            for model, variant in every
            for variable in variant.variation.variables
            if one.variable.text in variable_names(model, variant, variable)
        ]
        if not found:
            known = dict.fromkeys(variable_name(name) for _, variant in every for name in variant.variation.variables)
            listed = ", ".join(known) or "none"
            yield one.variable.span, f"there is no variable '{one.variable.text}'; the scenarios have {listed}"
        for _, variant, variable in found:
            former = taken.setdefault((variant.iri, variable), one.variable.text)
            if former != one.variable.text:
                yield one.variable.span, f"'{one.variable.text}' is the same variable as '{former}': remove one"
        yield from dict.fromkeys(fault for entry in found for fault in _faults_of(one, *entry))


def _faults_of(one: Range, model: AcceptanceModel, variant: Variant, variable: Iri) -> Iterator[Fault]:
    name = variable_name(variable)
    cells = list(variable_cells(variant.variation, variant.variation.variables.index(variable)))
    quantities = [UNITS[found[1]][0] for cell in cells if isinstance(cell, str) and (found := split_quantity(cell))]
    if quantities and len(quantities) == len(cells):
        if one.unit not in UNITS or UNITS[one.unit][0] not in quantities:
            yield (
                one.span,
                f"the values of '{name}' are quantities: write both bounds with a unit, {_units(quantities)}",
            )
        return
    other = next((cell for cell in cells if isinstance(cell, str | tuple)), None)
    if other is not None:
        shown = model.curie(other) if isinstance(other, Iri) else f'"{other}"'
        yield one.variable.span, f"the values of '{name}' are not numbers: the model gives it {shown}"
        return
    settings = list(_settings(variant, variable))
    units = dict.fromkeys([setting.unit for setting in settings] + ["s"] * _is_horizon(variant, variable))
    if one.unit and one.unit not in units:
        known = " and ".join(unit for unit in units if unit)
        stated = f"are in {known}: write the bounds in {known}" if known else "have no unit: write none"
        yield one.span, f"the values of '{name}' {stated}"
        return
    for setting in settings:
        if setting.whole:
            yield one.span, f"'{setting.name}' takes whole numbers: list them in the variation of the model"
            continue
        for bound in (one.low, one.high):
            try:
                setting.read(f"{bound:g}")
            except SettingError as error:
                yield one.span, str(error)


def _units(dimensions: Iterable[str]) -> str:
    """Return the units of some dimensions in words."""
    return " or ".join(unit for dimension in dict.fromkeys(dimensions) for unit in units_of(dimension))


def _settings(variant: Variant, variable: Iri) -> Iterator[Setting]:
    """Yield the settings (``has config``) whose value is the variable."""
    for clause in _fluents(variant):
        if clause.predicate == "has-config" and clause.arguments.get("value") == variable:
            try:
                yield setting_of(str(clause.arguments["name"]))
            except SettingError:
                continue


def _is_horizon(variant: Variant, variable: Iri) -> bool:
    return any(clause.seconds == variable for clause in _fluents(variant))


def _fluents(variant: Variant) -> Iterator[Fluent]:
    clauses = every_clause((*variant.template.clauses, *variant.clauses))
    return (clause for clause in clauses if isinstance(clause, Fluent))
