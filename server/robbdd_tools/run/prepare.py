"""Lays a run out in a fresh folder: features, hooks for behave, the graph as JSON-LD, the manifest."""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.gherkin.feature import ScenarioText, feature_file_name, feature_pieces
from robbdd_tools.gherkin.tables import elements_of
from robbdd_tools.graph.model import (
    AcceptanceModel,
    BehaviourClause,
    Cell,
    Clause,
    Fluent,
    ForAll,
    Iri,
    Junction,
    Story,
    Variant,
)
from robbdd_tools.run.protocol import ClauseSpec, ConfigSpec, Manifest, ScenarioSpec, SceneSpec, write_manifest

if TYPE_CHECKING:
    from robbdd_tools.graph.model import SceneModel

DEFAULT_SEED = 1
_ENVIRONMENT = '''"""Hooks that hold the simulated world while behave goes through the scenarios."""

from robbdd_tools.agent.hooks import after_all, after_scenario, before_all, before_scenario

__all__ = ["after_all", "after_scenario", "before_all", "before_scenario"]
'''
_STEPS = '''"""Steps for every sentence that the catalog knows."""

from robbdd_tools.agent.steps import register

register()
'''


@dataclass(frozen=True, slots=True)
class RunRequest:
    """What to run: a model, the name it goes by in reports, the seed, and the variants (all when ``None``)."""

    model: AcceptanceModel
    name: str
    seed: int = DEFAULT_SEED
    variants: Collection[Iri] | None = None

    def wants(self, variant: Iri) -> bool:
        """Tell whether a variant is to be run."""
        return self.variants is None or variant in self.variants


def prepare(request: RunRequest, folder: Path) -> Manifest:
    """Write everything that the agent needs into ``folder`` (made if missing); raises ``OSError``."""
    features = folder / "features"
    (features / "steps").mkdir(parents=True, exist_ok=True)
    (features / "environment.py").write_text(_ENVIRONMENT, encoding="utf-8")
    (features / "steps" / "catalog_steps.py").write_text(_STEPS, encoding="utf-8")
    scenarios: list[ScenarioSpec] = []
    for story in request.model.stories:
        if any(request.wants(variant.iri) for variant in story.variants):
            scenarios += _write_feature(request, story, features)
    manifest = Manifest(request.name, request.seed, tuple(scenarios))
    write_manifest(folder, manifest)
    return manifest


def write_features(model: AcceptanceModel, folder: Path) -> list[Path]:
    """Write one feature file per story into ``folder`` and return their paths; raises ``OSError``."""
    folder.mkdir(parents=True, exist_ok=True)
    written: list[Path] = []
    for story in model.stories:
        path = folder / feature_file_name(model, story)
        with path.open("w", encoding="utf-8", newline="\n") as file:
            file.writelines(piece.text for piece in feature_pieces(model, story))
        written.append(path)
    return written


def _write_feature(request: RunRequest, story: Story, folder: Path) -> Iterator[ScenarioSpec]:
    name = feature_file_name(request.model, story)
    chosen = Story(
        story.iri,
        story.role,
        story.feature,
        story.benefit,
        tuple(variant for variant in story.variants if request.wants(variant.iri)),
    )
    with (folder / name).open("w", encoding="utf-8", newline="\n") as file:
        for piece in feature_pieces(request.model, chosen):
            file.write(piece.text)
            if piece.scenario is not None:
                yield _scenario(request, story, f"features/{name}", piece.scenario)


def _scenario(request: RunRequest, story: Story, feature: str, scenario: ScenarioText) -> ScenarioSpec:
    model, variant = request.model, scenario.variant
    clauses = tuple(
        ClauseSpec(line, step.clause, model.curie(step.clause).rsplit(":", 1)[-1], step.role, step.text)
        for line, step in zip(scenario.lines, scenario.steps, strict=True)
    )
    return ScenarioSpec(
        feature=feature,
        line=scenario.line,
        name=scenario.name,
        story=story.iri,
        variant=variant.iri,
        variation=scenario.number,
        values={model.curie(variable): _plain(model, cell) for variable, cell in scenario.values.items()},
        seed=_seed(request.seed, variant.iri, scenario.number),
        scene=_scene(model, variant, scenario.values),
        events={model.curie(event): emitter for event, emitter in _events(variant).items()},
        clauses=clauses,
    )


def _seed(seed: int, variant: str, number: int) -> int:
    """Each scenario has its own stream of random numbers, whatever else is run."""
    digest = hashlib.sha256(f"{seed} {variant} {number}".encode()).digest()
    return int.from_bytes(digest[:4], "big")


def _plain(model: AcceptanceModel, cell: Cell) -> object:
    if isinstance(cell, tuple):
        return [_plain(model, value) for value in cell]
    return model.curie(cell) if isinstance(cell, Iri) else cell


def _scene(model: AcceptanceModel, variant: Variant, values: Mapping[Iri, Cell]) -> SceneSpec:
    scene = variant.scene
    extra = elements_of(values.values())

    def members(own: tuple[Iri, ...], kind: str) -> tuple[str, ...]:
        added = (element for element in extra if model.kinds.get(element) == kind)
        return tuple(model.curie(element) for element in dict.fromkeys((*own, *added)))

    def curies(mapping: Mapping[Iri, tuple[Iri, ...]]) -> dict[str, tuple[str, ...]]:
        return {model.curie(key): tuple(model.curie(entry) for entry in entries) for key, entries in mapping.items()}

    return SceneSpec(
        members((*scene.objects, *_carriers(scene)), "object"),
        members(scene.agents, "agent"),
        curies(scene.carriers),
        curies(scene.contains),
        {model.curie(thing): model.curie(place) for thing, place in _places(variant, values)},
        tuple(_config(model, (*variant.template.clauses, *variant.clauses), values)),
    )


def _carriers(scene: SceneModel) -> Iterator[Iri]:
    for objects in scene.carriers.values():
        yield from objects


def _places(variant: Variant, values: Mapping[Iri, Cell]) -> Iterator[tuple[Iri, Iri]]:
    """Where the Given clauses want things: a world that contradicts them from the start would test nothing."""
    for clause in (*variant.template.clauses, *variant.clauses):
        if isinstance(clause, Fluent) and clause.role == "given" and clause.predicate == "located-at":
            thing, place = (_value(clause.arguments[slot], values) for slot in ("object", "workspace"))
            if isinstance(thing, Iri) and isinstance(place, Iri):
                yield thing, place


def _config(model: AcceptanceModel, clauses: tuple[Clause, ...], values: Mapping[Iri, Cell]) -> Iterator[ConfigSpec]:
    """How the Given clauses want elements set up, each value as the feature text has it."""
    for clause in clauses:
        match clause:
            case Fluent(role="given", predicate="has-config"):
                target, value = (_value(clause.arguments[slot], values) for slot in ("target", "value"))
                for element in target if isinstance(target, tuple) else (target,):
                    yield ConfigSpec(_word(model, element), clause.arguments["name"], _word(model, value))
            case Junction(operator="and"):
                yield from _config(model, clause.operands, values)
            case ForAll():
                elements = values.get(clause.in_set, model.sets.get(clause.in_set, ()))
                for element in elements if isinstance(elements, tuple) else (elements,):
                    yield from _config(model, clause.clauses, {**values, clause.variable: element})
            case _:
                pass


def _word(model: AcceptanceModel, cell: Cell) -> str:
    if isinstance(cell, tuple):
        return " ".join(_word(model, value) for value in cell)
    return model.curie(cell) if isinstance(cell, Iri) else " ".join(str(cell).split())


def _value(term: Iri | str, values: Mapping[Iri, Cell]) -> Cell:
    return values.get(term, term) if isinstance(term, Iri) else term


def _events(variant: Variant) -> dict[Iri, str]:
    """Which emitter stamps which event of the model.

    The template's duration is the execution's, a behaviour's duration is that of its first and last emitted event;
    any other event is the behaviour's inner event of the same name (``evt-pick-end`` is ``pick-end``).
    """
    template = variant.template
    bound = {template.start: "scenario-start", template.end: "scenario-end"}
    behaviours = load_catalog().behaviours
    emitted: set[str] = set()
    clauses = tuple(_every((*template.clauses, *variant.clauses)))
    for clause in clauses:
        if isinstance(clause, BehaviourClause):
            events = behaviours[clause.behaviour].events
            emitted.update(events)
            bound |= {clause.start: events[0], clause.end: events[-1]}
    for clause in clauses:
        for event in _named_events(clause):
            name = _event_name(event)
            if name in emitted:
                bound.setdefault(event, name)
    return bound


def _every(clauses: tuple[Clause, ...]) -> Iterator[Clause]:
    for clause in clauses:
        yield clause
        yield from _every(getattr(clause, "clauses", getattr(clause, "operands", ())))


def _named_events(clause: Clause) -> Iterator[Iri]:
    time = getattr(clause, "time", None)
    for name in ("event", "start", "end"):
        event = getattr(time, name, None)
        if event is not None:
            yield Iri(event)


def _event_name(event: str) -> str:
    local = event.replace("#", "/").rsplit("/", 1)[-1].lower().replace("_", "-")
    return local.removeprefix("evt-").removeprefix("event-")
