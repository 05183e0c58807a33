"""Preview of a model's Gherkin: the first scenarios, with links back to the model."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from typing import TYPE_CHECKING

from robbdd_tools.gherkin.feature import FeaturePiece, Numbered, ScenarioText, every_scenario, feature_pieces
from robbdd_tools.gherkin.feature_files import only
from robbdd_tools.gherkin.variations import count
from robbdd_tools.graph.write.source_map import Location
from robbdd_tools.names.clause_places import clauses_in
from robbdd_tools.names.variant_places import variants_of

if TYPE_CHECKING:
    from robbdd_tools.graph.acceptance_model import AcceptanceModel, Story, Variant
    from robbdd_tools.graph.write.source_map import SourceMap
    from robbdd_tools.names.project import Snapshot

MAX_SHOWN = 50
"""Maximum number of scenarios in a preview by default."""


@dataclass(frozen=True, slots=True)
class PreviewLine:
    """A line of a preview (from 0) and its source, which is a clause, a variant, or a row of the variant's table."""

    line: int
    iri: str
    location: Location


@dataclass(frozen=True, slots=True)
class Preview:
    """The text of all previewed features, the number of scenarios in it, and the number of all scenarios."""

    text: str
    lines: tuple[PreviewLine, ...]
    shown: int
    total: int


def preview(
    snapshot: Snapshot, uri: str, variant: str | None = None, most: int = MAX_SHOWN, *, expanded: bool = False
) -> Preview:
    """Return a preview of the features of a file without errors, with at most ``most`` scenarios.

    If ``variant`` is given, only its scenarios are shown. If ``expanded`` is true, the definitions of named predicates
    replace their phrases.
    """
    from robbdd_tools.graph.read.acceptance import read_model
    from robbdd_tools.graph.write.build import build_graph

    built = build_graph(snapshot, uri)
    model = read_model(built.graph)
    stories = [only(story, lambda iri: variant in (None, iri)) for story in model.stories]
    shown = [story for story in stories if story.variants]
    return _written(model, shown, most, _Places(snapshot, uri, built.sources), expanded)


def _written(model: AcceptanceModel, stories: list[Story], most: int, places: _Places, expanded: bool) -> Preview:
    total = sum(count(variant.variation) for story in stories for variant in story.variants)
    texts: list[str] = []
    lines: list[PreviewLine] = []
    shown = above = 0
    for story in stories:
        for piece in _pieces(model, story, most - shown, expanded):
            texts.append(piece.text)
            if piece.scenario is not None:
                shown += 1
                lines += places.lines(piece.scenario, above)
        if shown >= most:
            break
        texts.append("\n")
        above = sum(text.count("\n") for text in texts)
    text = "".join(texts).rstrip("\n")
    return Preview(f"{text}\n" if text else "", tuple(lines), shown, total)


def _pieces(model: AcceptanceModel, story: Story, most: int, expanded: bool) -> Iterator[FeaturePiece]:
    """Yield the pieces of a story with at most ``most`` scenarios."""
    limits: dict[str, int] = {}
    for variant in story.variants:
        limits[variant.iri] = min(most, count(variant.variation))
        most -= limits[variant.iri]

    def first(variant: Variant) -> Iterator[Numbered]:
        return islice(every_scenario(variant), limits[variant.iri])

    return feature_pieces(model, story, first, expanded=expanded)


class _Places:
    """The source ranges of clauses, variants and table rows."""

    def __init__(self, snapshot: Snapshot, uri: str, sources: SourceMap) -> None:
        self._sources = sources
        self._clauses: dict[str, Location] = {}
        self._variants: dict[str, Location] = {}
        self._rows: dict[tuple[str, int], Location] = {}
        for file in snapshot.closure(uri):
            name = file.document.uri
            self._clauses |= {clause.iri: Location(name, clause.span) for clause in clauses_in(snapshot, name)}
            for variant in variants_of(snapshot, name):
                self._variants[variant.iri] = Location(name, variant.definition.extent)
                for number, row in enumerate(variant.rows, start=1):
                    self._rows[variant.iri, number] = Location(name, row)

    def lines(self, scenario: ScenarioText, above: int) -> Iterator[PreviewLine]:
        """Yield the source of each line of a scenario. ``above`` is the number of preview lines above its feature."""
        variant = scenario.variant.iri
        heading = self._rows.get((variant, scenario.number), self._variants.get(variant))
        if heading is not None:
            yield PreviewLine(above + scenario.line - 1, variant, heading)
        for line, step in zip(scenario.lines, scenario.steps, strict=True):
            # A model that was read from a graph has no clauses in its text: use the source map of the graph.
            written = self._clauses.get(step.clause) or self._sources.node(step.clause)
            if line and written is not None:
                yield PreviewLine(above + line - 1, step.clause, written)
