"""Write feature files incrementally, each with a map from its lines to clauses."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from robbdd_tools.base.files import uri_to_path
from robbdd_tools.base.writing import replacing
from robbdd_tools.gherkin.feature import Numbered, ScenarioText, every_scenario, feature_file_name, feature_pieces
from robbdd_tools.gherkin.render import Sheet, our_sheet
from robbdd_tools.gherkin.scenario_outline import variable_name
from robbdd_tools.graph.acceptance_model import AcceptanceModel, Cell, Clause, Iri, Story, Variant

if TYPE_CHECKING:
    from robbdd_tools.base.document import Document
    from robbdd_tools.graph.write.build import BuiltGraph
    from robbdd_tools.names.project import Snapshot

MAP_ENDING = ".map.json"
"""Suffix of the line map's file name."""


@dataclass(frozen=True, slots=True)
class Origin:
    """The source range of a clause.

    ``file`` is its name. The start and the end are pairs (line, column), counted from 1.
    """

    file: str
    start: tuple[int, int]
    end: tuple[int, int]


@dataclass(frozen=True, slots=True)
class FeaturePlan:
    """The content to write: the stories of a model, the scenarios of each variant, and the template.

    ``origins`` are the source ranges of clauses, if known. If ``expanded`` is true, the definitions of named predicates
    replace their phrases.
    """

    model: AcceptanceModel
    stories: tuple[Story, ...]
    scenarios: Callable[[Variant], Iterable[Numbered]]
    sheet: Sheet
    origins: Mapping[str, Origin]
    expanded: bool = False


@dataclass(frozen=True, slots=True)
class WrittenScenario:
    """A scenario that has been written to a feature file."""

    file: Path
    story: Story
    scenario: ScenarioText


def whole_plan(model: AcceptanceModel, origins: Mapping[str, Origin] | None = None) -> FeaturePlan:
    """Return the plan that writes all scenarios with the built-in template."""
    return FeaturePlan(model, model.stories, every_scenario, our_sheet(), origins or {})


def clause_origins(built: BuiltGraph, snapshot: Snapshot, model: AcceptanceModel) -> dict[str, Origin]:
    """Return the source range of each clause of a model. Clauses without source text are left out."""
    found: dict[str, Origin] = {}
    documents: dict[str, Document | None] = {}
    for story in model.stories:
        for iri in _clause_iris(story):
            location = built.sources.node(iri)
            if location is None:
                continue
            if location.uri not in documents:
                analysis = snapshot.file(location.uri)
                documents[location.uri] = analysis.document if analysis is not None else None
            document = documents[location.uri]
            if document is not None:
                start, end = document.position(location.span.start), document.position(location.span.end)
                path = uri_to_path(location.uri)
                name = path.name if path is not None else location.uri.rsplit("/", 1)[-1]
                found[iri] = Origin(name, (start.line + 1, start.column + 1), (end.line + 1, end.column + 1))
    return found


def write_features(plan: FeaturePlan, folder: Path) -> list[Path]:
    """Write a feature and its line map for each story, and return the paths of the features.

    Raises the same errors as ``written_scenarios``.
    """
    for _ in written_scenarios(plan, folder):
        pass
    return [folder / feature_file_name(plan.model, story) for story in plan.stories]


def written_scenarios(plan: FeaturePlan, folder: Path) -> Iterator[WrittenScenario]:
    """Write a feature and its line map for each story, and yield each scenario after it is written.

    ``folder`` is created if it is missing. Raises ``OSError``, and ``TemplateProblem`` if the template fails.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for story in plan.stories:
        path = folder / feature_file_name(plan.model, story)
        with replacing(path) as feature, replacing(path.with_name(path.name + MAP_ENDING)) as lines:
            line_map = _LineMap(plan, story, path.name, lines)
            for piece in feature_pieces(plan.model, story, plan.scenarios, plan.sheet, expanded=plan.expanded):
                feature.write(piece.text)
                if piece.scenario is not None:
                    line_map.add(piece.scenario)
                    yield WrittenScenario(path, story, piece.scenario)
            line_map.close()


def only(story: Story, wanted: Callable[[Iri], bool]) -> Story:
    """Return a story with the variants selected by ``wanted``."""
    return replace(story, variants=tuple(variant for variant in story.variants if wanted(variant.iri)))


class _LineMap:
    """Writes a line map as JSON while the feature is written (see ``docs/gherkin.md``)."""

    def __init__(self, plan: FeaturePlan, story: Story, feature: str, file: TextIO) -> None:
        self._model = plan.model
        self._file = file
        self._numbers: dict[str, int] = {iri: number for number, iri in enumerate(_clause_iris(story))}
        self._separator = "\n"
        head = {"version": 1, "feature": feature, "story": story.iri}
        clauses = [self._clause(iri, plan.origins.get(iri)) for iri in self._numbers]
        inner = _json(head)[1:-1]
        file.write(f'{{{inner}, "clauses": [\n' + ",\n".join(map(_json, clauses)) + '\n], "scenarios": [')

    def add(self, scenario: ScenarioText) -> None:
        """Add a scenario with known lines."""
        entry = {
            "line": scenario.line,
            "name": scenario.name,
            "variant": scenario.variant.iri,
            "template": scenario.variant.template.iri,
            "variation": scenario.number,
            "values": {variable_name(variable): self._plain(cell) for variable, cell in scenario.values.items()},
            "steps": {
                str(line): self._numbers[step.clause]
                for line, step in zip(scenario.lines, scenario.steps, strict=True)
                if line
            },
        }
        self._file.write(self._separator + _json(entry))
        self._separator = ",\n"

    def close(self) -> None:
        """Complete the document."""
        self._file.write("\n]}\n")

    def _clause(self, iri: str, origin: Origin | None) -> dict[str, object]:
        entry: dict[str, object] = {"iri": iri, "name": self._model.curie(iri).rsplit(":", 1)[-1]}
        if origin is not None:
            places = {side: dict(zip(("line", "column"), place, strict=True)) for side, place in _sides(origin)}
            entry |= {"file": origin.file, "range": places}
        return entry

    def _plain(self, cell: Cell) -> object:
        if isinstance(cell, tuple):
            return [self._plain(value) for value in cell]
        return self._model.curie(cell) if isinstance(cell, Iri) else cell


def _sides(origin: Origin) -> tuple[tuple[str, tuple[int, int]], ...]:
    return ("start", origin.start), ("end", origin.end)


def _json(value: object) -> str:
    return json.dumps(value, ensure_ascii=False)


def _clause_iris(story: Story) -> dict[Iri, None]:
    """Return every clause of a story's variants once, in order."""
    found: dict[Iri, None] = {}
    for variant in story.variants:
        _collect((*variant.template.clauses, *variant.clauses), found)
    return found


def _collect(clauses: Iterable[Clause], found: dict[Iri, None]) -> None:
    for clause in clauses:
        found[clause.iri] = None
        _collect(getattr(clause, "clauses", getattr(clause, "operands", ())), found)
