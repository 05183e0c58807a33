"""Requirements in graph files: their coverage, and the exchange with other forms of requirements."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.files import path_to_uri
from robbdd_tools.base.graph_formats import graph_format
from robbdd_tools.features.pass_rates import missing_executions
from robbdd_tools.features.rejudged_results import BADNESS
from robbdd_tools.graph.requirement import Requirement
from robbdd_tools.workbench.requirement_table import Names, RequirementRow, ScenarioCell, TableProblem, verdict_of

if TYPE_CHECKING:
    from robbdd_tools.features.run_verdicts import JudgedScenario
    from robbdd_tools.graph.verified_requirements import VerifyingVariant
    from robbdd_tools.run.store import RunStore
    from robbdd_tools.workbench.model import ModelFile


def read_requirement_graph(file: Path, text: str) -> list[RequirementRow]:
    """Return the requirements that a graph file states, in the order of their IRIs. Raises ``TableProblem``."""
    from robbdd_tools.graph.rdf.serialize import UnreadableGraph
    from robbdd_tools.graph.read.requirements import requirements_in

    try:
        found = requirements_in(text, graph_format(file.name), path_to_uri(file))
    except UnreadableGraph as error:
        before = text[: error.offset]
        place = f"{before.count(chr(10)) + 1}:{len(before) - before.rfind(chr(10))}"
        raise TableProblem(f"{file}:{place}: {error}") from error
    names = Names()
    return [_row(one, names) for one in found]


def graph_text(file: Path, rows: Sequence[RequirementRow], namespace: str = "") -> str:
    """Return requirements as a graph in the format of the file's suffix.

    Requirements of no model have their names in ``namespace``. Raises ``TableProblem``.
    """
    from robbdd_tools.graph.rdf.serialize import UnwritableGraph
    from robbdd_tools.graph.write.requirement_graph import requirement_graph

    nameless = next((one.name for one in rows if not one.iri and not namespace), None)
    if nameless is not None:
        raise TableProblem(f"the requirement '{nameless}' has no IRI: give its declaration a namespace (ns=…)")
    found = (
        (one.name, Requirement(one.iri or namespace + one.name, one.text, one.identifier, one.source)) for one in rows
    )
    try:
        return requirement_graph(found, graph_format(file.name))
    except UnwritableGraph as error:
        raise TableProblem(f"{file}: {error}") from error


def graph_rows(
    file: ModelFile, variants: Mapping[str, Sequence[JudgedScenario]], store: RunStore
) -> list[RequirementRow]:
    """Return the requirements of a model of graph files. ``variants`` has the latest results by variant.

    A result is stale if the graph of its run, in ``store``, was another one. Raises ``ModelErrors``.
    """

    @cache
    def is_stale(run: int) -> bool:
        return store.find(str(run)).record().digest != file.digest

    def cell(variant: VerifyingVariant) -> ScenarioCell:
        every = variants.get(variant.iri, ())
        known = [one for one in every if one.finished]
        outcomes = [_outcome(one, variant) for one in known]
        judged = [one.clauses[iri] for one in known for iri in variant.clauses if iri in one.clauses]
        return ScenarioCell(
            variant.name,
            min(outcomes, key=BADNESS.index, default=""),
            outcomes.count("holds"),
            len(known),
            bool(judged) and all(one.vacuous for one in judged),
            any(is_stale(one.run) for one in known),
            missing_executions(every, variant.scenarios) if known else 0,
        )

    def rows() -> Iterator[RequirementRow]:
        for one in file.requirements:
            evidence = tuple(map(cell, one.variants))
            yield RequirementRow(
                one.name, one.identifier, one.text, one.source, evidence, verdict_of(evidence), one.iri
            )

    return list(rows())


def _outcome(scenario: JudgedScenario, variant: VerifyingVariant) -> str:
    if variant.whole:
        return scenario.outcome
    outcomes = [scenario.clauses[iri].outcome if iri in scenario.clauses else "unknown" for iri in variant.clauses]
    return min(outcomes, key=BADNESS.index, default="unknown")


def _row(one: Requirement, names: Names) -> RequirementRow:
    local = one.iri.replace("#", "/").rsplit("/", 1)[-1]
    name = names.free(local, 0) or names.made(one.identifier or local, 0)
    identifier = "" if one.identifier == name else one.identifier
    return RequirementRow(name, identifier, one.text, one.source, iri=one.iri)
