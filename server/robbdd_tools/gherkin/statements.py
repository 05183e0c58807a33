"""The clauses of one scenario with their sentences."""

from __future__ import annotations

from itertools import islice
from typing import TYPE_CHECKING

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.gherkin.steps import StepWriter
from robbdd_tools.gherkin.variations import bindings

if TYPE_CHECKING:
    from robbdd_tools.graph.acceptance_model import AcceptanceModel


def statements(model: AcceptanceModel, variant: str, variation: int) -> set[tuple[str, str]]:
    """Return the clauses (IRIs) and the sentences of scenario number ``variation`` (from 1) of a variant (IRI).

    A clause that is repeated for each element of a set has several sentences. If there is no such scenario, the result
    is empty.
    """
    found = next((one for story in model.stories for one in story.variants if one.iri == variant), None)
    values = None if found is None else next(islice(bindings(found.variation), variation - 1, None), None)
    if found is None or values is None:
        return set()
    steps = StepWriter(model, load_catalog()).steps((*found.template.clauses, *found.clauses), values)
    return {(str(step.clause), step.text) for step in steps}
