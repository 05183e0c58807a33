"""Write features: one for each user story, one scenario for each set of values, and a map from lines to clauses."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

from robbdd_tools.base.file_names import safe_stem
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.gherkin import text
from robbdd_tools.gherkin.background_tables import SceneTable, extra_elements, members, scene_tables, variable_table
from robbdd_tools.gherkin.render import Sheet, our_sheet
from robbdd_tools.gherkin.requirement_tags import requirement_tags, variant_tags
from robbdd_tools.gherkin.scenario_outline import Outline, outline, variable_name
from robbdd_tools.gherkin.steps import Step, StepWriter
from robbdd_tools.gherkin.variations import Binding, bindings
from robbdd_tools.gherkin.words import Placeholder
from robbdd_tools.graph.acceptance_model import AcceptanceModel, Cell, Clause, Iri, Story, Variant
from robbdd_tools.graph.clause_parts import count_of_parts, is_when_clause, part_numbers
from robbdd_tools.graph.read.clauses import named_elements
from robbdd_tools.protocol.time_words import WORDING

Numbered = tuple[int, Binding]
"""The number of a scenario within its variation, from 1, and its values."""


@dataclass(frozen=True, slots=True)
class StoryHeader:
    """The text above the scenarios of a story.

    ``background`` holds the scene tables that all scenarios share. ``wording`` is the version of the sentences.
    """

    name: str
    iri: Iri
    role: str
    feature: str
    benefit: str
    tags: tuple[str, ...]
    background: tuple[SceneTable, ...]
    wording: int = WORDING


@dataclass(frozen=True, slots=True)
class VariantHeader:
    """The data that the scenarios of a variant share.

    ``columns`` are the names of its variables. ``tables`` are the scene tables that are not in the background.
    ``outline`` expresses all scenarios at once; ``None`` if this is not possible. ``events`` are the definitions of the
    template's events, with ``<column>`` instead of values.
    """

    name: str
    iri: Iri
    template: Iri
    tags: tuple[str, ...]
    columns: tuple[str, ...]
    tables: tuple[SceneTable, ...]
    outline: Outline | None
    events: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ScenarioText:
    """The text of one scenario.

    - ``number``: the number of the scenario in the variation (from 1).
    - ``line``: the line of its heading in the feature.
    - ``cells``: its values as words, in the order of the variant's columns.
    - ``lines``: the lines of ``steps`` in the feature; 0 for a step that the template omits.
    - ``tables``: its scene tables that are not in the background.
    - ``events``: the definitions of the events that its template defines.
    """

    name: str
    variant: Variant
    number: int
    values: Binding
    cells: tuple[str, ...]
    tags: tuple[str, ...]
    tables: tuple[SceneTable, ...]
    steps: tuple[Step, ...]
    events: tuple[str, ...] = ()
    line: int = 0
    lines: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class ScenarioData:
    """The fields of a ``ScenarioText`` that templates can use."""

    name: str
    number: int
    values: Binding
    cells: tuple[str, ...]
    tags: tuple[str, ...]
    tables: tuple[SceneTable, ...]
    steps: tuple[Step, ...]
    events: tuple[str, ...]

    @staticmethod
    def of(one: ScenarioText) -> ScenarioData:
        """Return the data of a scenario."""
        return ScenarioData(one.name, one.number, one.values, one.cells, one.tags, one.tables, one.steps, one.events)


@dataclass(frozen=True, slots=True)
class FeaturePiece:
    """A part of a feature's text: the head of the story, the head of a variant, one scenario, or the end."""

    text: str
    scenario: ScenarioText | None


def every_scenario(variant: Variant) -> Iterator[Numbered]:
    """Yield all scenarios of a variant."""
    return enumerate(bindings(variant.variation), start=1)


def feature_pieces(
    model: AcceptanceModel,
    story: Story,
    scenarios: Callable[[Variant], Iterable[Numbered]] = every_scenario,
    sheet: Sheet | None = None,
    *,
    expanded: bool = False,
) -> Iterator[FeaturePiece]:
    """Yield the text of a story's feature piece by piece, in written order. Memory use does not grow with its size.

    ``scenarios`` selects the scenarios of each variant. ``sheet`` is the template, by default the built-in one. If
    ``expanded`` is true, the definitions of named predicates replace their phrases. Raises ``TemplateProblem``.
    """
    writer = _FeatureWriter(StepWriter(model, load_catalog(), expanded=expanded), sheet or our_sheet(), story)
    return writer.pieces(scenarios)


def feature_file_name(model: AcceptanceModel, story: Story) -> str:
    """Return the name of a story's feature file. It is valid on every file system.

    The file has the name of the story. Stories with the same name in several namespaces are numbered.
    """
    name = _file_stem(model, story.iri)
    same = [other.iri for other in model.stories if _file_stem(model, other.iri).casefold() == name.casefold()]
    return f"{name}.feature" if len(same) < 2 else f"{name}-{same.index(story.iri) + 1}.feature"


def _file_stem(model: AcceptanceModel, iri: Iri) -> str:
    return safe_stem(model.curie(iri).rsplit(":", 1)[-1])


class _FeatureWriter:
    """Writes one feature and counts its lines."""

    def __init__(self, writer: StepWriter, sheet: Sheet, story: Story) -> None:
        self._writer = writer
        self._sheet = sheet
        self._story = story
        self._line = 1
        shared = {scene_tables(writer, variant.scene) for variant in story.variants}
        self._background = shared.pop() if len(shared) == 1 else ()

    def pieces(self, scenarios: Callable[[Variant], Iterable[Numbered]]) -> Iterator[FeaturePiece]:
        story = {"story": self._header()}
        yield from self._plain("feature", story)
        for variant in self._story.variants:
            writer = _VariantWriter(self._writer, variant, self._background, self._sheet.has("variant"))
            values = {**story, "variant": writer.header}
            first = self._line
            shared: tuple[int, ...] = ()
            for piece in self._plain("variant", values):
                if writer.header.outline is not None:
                    shared = _places(piece.text, writer.header.outline.steps, first)
                yield piece
            for number, binding in scenarios(variant):
                scenario = writer.scenario(number, binding)
                rendered = self._sheet.render("scenario", {**values, "scenario": ScenarioData.of(scenario)})
                yield self._advanced(FeaturePiece(rendered, _located(scenario, rendered, self._line, shared)))
        yield from self._plain("end", story)

    def _plain(self, block: str, values: Mapping[str, object]) -> Iterator[FeaturePiece]:
        rendered = self._sheet.render(block, values)
        if rendered:
            yield self._advanced(FeaturePiece(rendered, None))

    def _advanced(self, piece: FeaturePiece) -> FeaturePiece:
        self._line += piece.text.count("\n")
        return piece

    def _header(self) -> StoryHeader:
        story = self._story
        name = text.line(self._writer.curie(story.iri))
        role, feature, benefit = map(text.line, (story.role, story.feature, story.benefit))
        tags = (text.tag("story", story.iri), *requirement_tags(self._writer.model, [story.iri]))
        return StoryHeader(name, story.iri, role, feature, benefit, tags, self._background)


class _VariantWriter:
    """Writes the scenarios of one variant and, if ``outlined`` is true, its outline."""

    def __init__(
        self, writer: StepWriter, variant: Variant, background: tuple[SceneTable, ...], outlined: bool
    ) -> None:
        self._writer = writer
        self._variant = variant
        self._clauses = _in_order(variant)
        self._members = members(variant.scene)
        self._named = named_elements(writer.model, variant)
        self._tables = () if background else scene_tables(writer, variant.scene)
        self._tags: dict[Iri, str] = {}
        variables = variant.variation.variables
        self.header = VariantHeader(
            text.line(writer.curie(variant.iri)),
            variant.iri,
            variant.template.iri,
            self._tags_of(variant),
            tuple(variable_name(variable) for variable in variables),
            self._tables,
            self._outline() if outlined else None,
            self._definitions({variable: Placeholder(variable_name(variable)) for variable in variables}),
        )

    def _tags_of(self, variant: Variant) -> tuple[str, ...]:
        made_from = text.tag("variant", variant.iri), text.tag("template", variant.template.iri)
        return (*made_from, *variant_tags(self._writer.model, variant))

    def _outline(self) -> Outline | None:
        """Return the outline of the scenarios; ``None`` if clauses add elements, as their table has several rows."""
        if not self._members.issuperset(self._named) or self._tables_have_placeholders():
            return None
        return outline(self._writer, self._clauses, self._variant.variation, self._members)

    def _tables_have_placeholders(self) -> bool:
        """Return whether an outline would replace a part of a property's value, such as ``<part>``."""
        placeholders = [f"<{variable_name(variable)}>" for variable in self._variant.variation.variables]
        cells = (cell for table in self._tables for row in table.rows for cell in row)
        return any(placeholder in cell for cell in cells for placeholder in placeholders)

    def scenario(self, number: int, values: Binding) -> ScenarioText:
        """Return one scenario, without its lines in a feature."""
        cells = tuple(values.values())
        steps = tuple(self._writer.steps(self._clauses, values))
        extra = extra_elements((*cells, *self._named), self._writer.model.kinds, self._members)
        return ScenarioText(
            f"{self.header.name} -- {number}",
            self._variant,
            number,
            values,
            tuple(text.cell(self._writer.word(cell)) for cell in cells),
            (*self.header.tags, *self._clause_tags(steps)),
            (*self._tables, *variable_table(self._writer, extra)),
            steps,
            self._definitions(values),
        )

    def _definitions(self, values: Mapping[Iri, Cell]) -> tuple[str, ...]:
        """Return the definitions of the template's events, and of named predicates, as sentences."""
        template = self._variant.template
        found = (self._writer.definition(event, values) for event in template.events)
        meanings = self._writer.meanings(self._clauses, template.events, values)
        return (*filter(None, found), *meanings)

    def _clause_tags(self, steps: Iterable[Step]) -> Iterator[str]:
        for clause in dict.fromkeys(step.clause for step in steps):
            found = self._tags.get(clause)
            if found is None:
                found = self._tags[clause] = text.tag("clause", clause)
            yield found


def _in_order(variant: Variant) -> tuple[Clause, ...]:
    """Return the clauses of a variant in the order of their roles: given, when, then.

    Within a role, clauses of the template are before clauses of the variant. If the template has several parts, its
    clauses keep their order: the Given clauses of the variant are before them, and its other clauses after the last
    When.
    """
    own = variant.template.clauses
    if count_of_parts(own, part_numbers(own)) < 2:
        return _by_role((*own, *variant.clauses))
    end = max(index for index, clause in enumerate(own, start=1) if is_when_clause(clause))
    first = tuple(clause for clause in variant.clauses if _role(clause) == "given")
    others = tuple(clause for clause in variant.clauses if _role(clause) != "given")
    return (*first, *own[:end], *_by_role((*own[end:], *others)))


def _by_role(clauses: tuple[Clause, ...]) -> tuple[Clause, ...]:
    return tuple(clause for role in ("given", "when", "then") for clause in clauses if _role(clause) == role)


def _role(clause: Clause) -> str:
    # When clauses and repeated bodies have no role attribute.
    return getattr(clause, "role", "when")


def _located(scenario: ScenarioText, rendered: str, first_line: int, shared: tuple[int, ...]) -> ScenarioText:
    """Return a scenario with the lines of its heading and its steps in the rendered text.

    ``shared`` are the lines of an outline's steps. A row of the outline gets these lines, because it has no own steps.
    """
    heading = 0
    for number, text_line in enumerate(rendered.split("\n"), start=first_line):
        if text_line.strip() and (not heading or text_line.rstrip().endswith(scenario.name)):
            heading = number
            if text_line.rstrip().endswith(scenario.name):
                break
    lines = _places(rendered, scenario.steps, first_line)
    if shared and not any(lines):
        lines = shared
    return replace(scenario, line=heading, lines=lines)


def _places(rendered: str, steps: tuple[Step, ...], first_line: int) -> tuple[int, ...]:
    """Return the line of each step in the rendered text; 0 for a missing step. Steps are searched in order."""
    found: list[int] = []
    lines = enumerate(rendered.split("\n"), start=first_line)
    written = [(number, text_line.strip()) for number, text_line in lines]
    start = 0
    for step in steps:
        place = next((at for at in range(start, len(written)) if written[at][1].endswith(step.text)), None)
        if place is None:
            found.append(0)
        else:
            found.append(written[place][0])
            start = place + 1
    return tuple(found)
