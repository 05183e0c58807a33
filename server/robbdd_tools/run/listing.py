"""List the scenarios of a variant without running them, in the wording of reports and editors."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.gherkin.feature import ScenarioText, feature_pieces
from robbdd_tools.gherkin.feature_files import only
from robbdd_tools.gherkin.variations import at, count
from robbdd_tools.run.report import plain_sentence, value_words

if TYPE_CHECKING:
    from robbdd_tools.gherkin.feature import Numbered
    from robbdd_tools.gherkin.steps import Step
    from robbdd_tools.graph.acceptance_model import AcceptanceModel, Cell, Iri, Variant


@dataclass(frozen=True, slots=True)
class ListedClause:
    """A clause of one scenario: its IRI, name, role and sentence with the scenario's values."""

    iri: str
    name: str
    role: str
    sentence: str


@dataclass(frozen=True, slots=True)
class ListedScenario:
    """Scenario ``number`` (from 1) of a variant.

    ``varying`` has the values that differ between the scenarios of the variant, and ``shared`` has the values that all
    scenarios have in common. Both are texts. ``clauses`` are in the order of judgement.
    """

    number: int
    varying: str
    shared: str
    clauses: tuple[ListedClause, ...]


def listed_scenarios(model: AcceptanceModel, variant: Iri, first: int, most: int) -> Iterator[ListedScenario]:
    """Yield at most ``most`` scenarios of a variant, starting at number ``first``.

    An unknown variant yields no scenarios.
    """

    def chosen(found: Variant) -> Iterator[Numbered]:
        end = min(count(found.variation), first - 1 + most)
        return ((index + 1, at(found.variation, index)) for index in range(first - 1, end))

    for story in model.stories:
        own = only(story, lambda iri: iri == variant)
        if own.variants:
            varying = _varying(own.variants[0])
            for piece in feature_pieces(model, own, chosen):
                if piece.scenario is not None:
                    yield _listed(model, piece.scenario, varying)


def _varying(variant: Variant) -> frozenset[Iri]:
    """Return the variables whose value differs between the scenarios."""
    variation = variant.variation
    last = count(variation) - 1
    if last < 1:
        return frozenset(variation.variables)
    rows = getattr(variation, "rows", None)
    if rows is not None:
        columns = zip(*rows, strict=True)
        return frozenset(name for name, cells in zip(variation.variables, columns, strict=True) if len(set(cells)) > 1)
    # The first and the last scenario of a product differ in every variable that has a choice.
    least, greatest = at(variation, 0), at(variation, last)
    return frozenset(name for name in variation.variables if least[name] != greatest[name])


def _listed(model: AcceptanceModel, scenario: ScenarioText, varying: frozenset[Iri]) -> ListedScenario:
    def words(among: bool) -> str:
        shown = ((name, cell) for name, cell in scenario.values.items() if (name in varying) is among)
        return ", ".join(value_words(model.curie(name), _plain(model, cell)) for name, cell in shown)

    return ListedScenario(
        scenario.number,
        words(True),
        words(False),
        tuple(_clause(model, step) for line, step in zip(scenario.lines, scenario.steps, strict=True) if line),
    )


def _clause(model: AcceptanceModel, step: Step) -> ListedClause:
    name = model.curie(step.clause).rsplit(":", 1)[-1]
    return ListedClause(step.clause, name, step.role, plain_sentence(step.text))


def _plain(model: AcceptanceModel, cell: Cell) -> object:
    from robbdd_tools.graph.acceptance_model import Iri

    if isinstance(cell, tuple):
        return [_plain(model, value) for value in cell]
    return model.curie(cell) if isinstance(cell, Iri) else cell
