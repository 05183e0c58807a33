"""Features: one per user story, one scenario per set of values, with a map from lines to clauses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache
from itertools import takewhile
from typing import TYPE_CHECKING

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.gherkin.steps import Step, StepWriter
from robbdd_tools.gherkin.variations import Binding, bindings
from robbdd_tools.graph.model import AcceptanceModel, Cell, Clause, Iri, Story, Variant

if TYPE_CHECKING:
    from jinja2 import Template


@dataclass(frozen=True, slots=True)
class SceneTable:
    """A scene step with its one-column table of names."""

    title: str
    names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class StoryHeader:
    """What the feature line and its narrative say."""

    name: str
    role: str
    feature: str
    benefit: str


@dataclass(frozen=True, slots=True)
class ScenarioText:
    """One scenario: ``number`` counts from 1 within the variant, ``line`` is that of its heading in the feature.

    ``lines`` gives the feature line of each step of ``steps``.
    """

    name: str
    variant: Variant
    number: int
    values: Binding
    tables: tuple[SceneTable, ...]
    steps: tuple[Step, ...]
    line: int = 0
    lines: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class FeaturePiece:
    """A run of text of one feature: its head, or one scenario."""

    text: str
    scenario: ScenarioText | None


def feature_pieces(model: AcceptanceModel, story: Story) -> Iterator[FeaturePiece]:
    """Yield the feature of a story piece by piece, in written order, in constant memory."""
    writer = StepWriter(model, load_catalog())
    header = StoryHeader(model.curie(story.iri), story.role, story.feature, story.benefit)
    text = _render("feature", {"story": header})
    yield FeaturePiece(text, None)
    line = text.count("\n") + 1
    for variant in story.variants:
        for number, binding in enumerate(bindings(variant.variation), start=1):
            scenario = _scenario(writer, variant, number, binding)
            text = _render("scenario", {"scenario": scenario})
            yield FeaturePiece(text, _located(scenario, text, line))
            line += text.count("\n")


def feature_file_name(model: AcceptanceModel, story: Story) -> str:
    """Return the name of a story's feature file; its CURIE made safe for every file system."""
    name = model.curie(story.iri).rsplit(":", 1)[-1]
    return "".join(letter if letter.isalnum() or letter in "-_." else "_" for letter in name) + ".feature"


def _scenario(writer: StepWriter, variant: Variant, number: int, binding: Binding) -> ScenarioText:
    steps = tuple(writer.steps(_in_order(variant), dict(binding)))
    name = f"{writer.model.curie(variant.iri)} -- {number}"
    return ScenarioText(name, variant, number, binding, _tables(writer.model, variant, binding), steps)


def _in_order(variant: Variant) -> tuple[Clause, ...]:
    """Template's before the variant's in each role: what is given, what happens, what then holds."""
    own = [(getattr(clause, "role", "when"), clause) for clause in variant.clauses]
    template = variant.template.clauses
    given = tuple(takewhile(lambda clause: getattr(clause, "role", "") == "given", template))
    return (
        *given,
        *(clause for role, clause in own if role == "given"),
        *(clause for role, clause in own if role == "when"),
        *template[len(given) :],
        *(clause for role, clause in own if role == "then"),
    )


def _tables(model: AcceptanceModel, variant: Variant, binding: Binding) -> tuple[SceneTable, ...]:
    scene = variant.scene
    members = {*scene.objects, *scene.workspaces, *scene.agents}
    extra = tuple(element for element in elements_of(binding) if element in model.kinds and element not in members)
    titled = (
        ("a set of objects", scene.objects),
        ("a set of workspaces", scene.workspaces),
        ("a set of agents", scene.agents),
        ("variable scene elements", extra),
    )
    return tuple(
        SceneTable(title, tuple(_cell(model.curie(name)) for name in names)) for title, names in titled if names
    )


def elements_of(binding: Mapping[Iri, Cell]) -> tuple[Iri, ...]:
    """Return the IRIs among the values of a scenario, sets included, each once, in order."""
    found: dict[Iri, None] = {}
    for cell in binding.values():
        for value in cell if isinstance(cell, tuple) else (cell,):
            if isinstance(value, Iri):
                found.setdefault(value)
    return tuple(found)


def _cell(text: str) -> str:
    return text.replace("\\", "\\\\").replace("|", "\\|")


def _located(scenario: ScenarioText, text: str, first_line: int) -> ScenarioText:
    """Find the lines of a scenario's heading and steps in its rendered text."""
    wanted = [f"{step.keyword} {step.text}" for step in scenario.steps]
    heading = 0
    lines: list[int] = []
    for number, line in enumerate(text.split("\n"), start=first_line):
        stripped = line.strip()
        if not heading and stripped.endswith(scenario.name):
            heading = number
        elif len(lines) < len(wanted) and stripped == wanted[len(lines)]:
            lines.append(number)
    return replace(scenario, line=heading, lines=tuple(lines))


def _render(block: str, values: dict[str, object]) -> str:
    template = _template()
    return "".join(template.blocks[block](template.new_context(values)))


@cache
def _template() -> Template:
    from jinja2 import PackageLoader, StrictUndefined
    from jinja2.sandbox import SandboxedEnvironment

    loader = PackageLoader("robbdd_tools.gherkin", "templates")
    # Feature files are plain text: HTML escaping would corrupt the names.
    environment = SandboxedEnvironment(
        loader=loader, undefined=StrictUndefined, autoescape=False, keep_trailing_newline=True
    )
    return environment.get_template("default.feature.jinja")
