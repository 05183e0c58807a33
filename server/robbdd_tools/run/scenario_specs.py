"""Build the agent's specification of each scenario: its scene, events, seed and clause lines."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from robbdd_tools.catalog.executable import SceneInstance
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.gherkin.background_tables import elements_of
from robbdd_tools.gherkin.binding import Binder
from robbdd_tools.gherkin.feature import ScenarioText
from robbdd_tools.gherkin.steps import Step
from robbdd_tools.graph.acceptance_model import (
    AcceptanceModel,
    Cell,
    Clause,
    Execution,
    Fluent,
    ForAll,
    Iri,
    Junction,
    SceneModel,
    Variant,
)
from robbdd_tools.graph.acceptance_model import DefinedEvent as ModelEvent
from robbdd_tools.graph.clause_parts import count_of_parts, part_numbers
from robbdd_tools.graph.read.clauses import named_elements, names_in_events, used_names
from robbdd_tools.graph.read.named_predicates import required_parts
from robbdd_tools.monitor.policy import Observation, Policy
from robbdd_tools.protocol.clauses import BehaviourCall, DefinedEvent, EventOccurrence, Text, leaves_of
from robbdd_tools.protocol.clauses import Junction as StatedJunction
from robbdd_tools.protocol.specs import ClauseSpec, ConfigSpec, ExecutionSpec, ScenarioSpec, SceneSpec
from robbdd_tools.run.emitters import emitters_of
from robbdd_tools.run.iterations import behaviour_scopes, iterations_of
from robbdd_tools.run.related_scenarios import Relations
from robbdd_tools.run.seeds import scenario_seed
from robbdd_tools.run.tree_specs import TreeSpecWriter

Values = Mapping[Iri, Cell]


@dataclass(frozen=True, slots=True)
class _Shared:
    """The data that all scenarios of a variant have in common."""

    clauses: tuple[Clause, ...]
    defined: tuple[ModelEvent, ...]
    objects: tuple[Iri, ...]
    workspaces: Mapping[str, tuple[str, ...]]
    contains: Mapping[str, tuple[str, ...]]
    named: tuple[Iri, ...]
    events: Mapping[str, str]
    instance: SceneInstance | None
    correct_places: Mapping[str, tuple[str, ...]]


class SpecWriter:
    """Builds the scenario specifications of one model, for the given ``execution`` if there is one.

    ``relations`` must cover the whole model, so that the specification of a scenario does not depend on which scenarios
    are selected.
    """

    def __init__(
        self,
        model: AcceptanceModel,
        seed: int,
        relations: Relations,
        execution: Execution | None = None,
        name: str = "",
    ) -> None:
        self._model = model
        self._name = name
        self._seed = seed
        self._relations = relations
        self._curies: dict[str, str] = {}
        self._variants: dict[Iri, _Shared] = {}
        self._related = TreeSpecWriter(
            model,
            relations,
            seed,
            lambda variant, values: self._scene(self._known(variant), variant.scene, values),
            lambda variant: self._known(variant).events,
        )
        policies = () if execution is None else execution.policies
        by_code = frozenset(policy.clause for policy in policies if policy.rule.kind == "python")
        self._binder = Binder(model, load_catalog(), by_code, reads_texts=True)
        self._sets: dict[str, tuple[str, ...]] = {}
        for name, elements in model.sets.items():
            for element in elements:
                known = self._sets.get(self._curie(str(element)), ())
                self._sets[self._curie(str(element))] = (*known, self._curie(name).rpartition(":")[2])
        self._stated_places = self._named(model.correct_places)
        self._stated = {
            self._curie(thing): tuple(ConfigSpec(self._curie(thing), name, value) for name, value in settings.items())
            for thing, settings in model.stated_settings.items()
        }
        self.execution = None if execution is None else self._execution(execution)

    def _execution(self, execution: Execution) -> ExecutionSpec:
        return ExecutionSpec(
            execution.iri,
            self._curie(execution.iri),
            execution.implementation,
            None if execution.scene is None else self._instance(execution.scene),
            tuple(self._policy(policy) for policy in execution.policies),
            execution.repeat,
            execution.timeout,
            execution.seed,
        )

    def _instance(self, scene: SceneInstance) -> SceneInstance:
        elements = tuple(replace(one, element=self._curie(one.element)) for one in scene.elements)
        frictions = tuple(
            replace(one, first=self._curie(one.first), second=self._curie(one.second)) for one in scene.frictions
        )
        boxes = tuple(replace(one, workspace=self._curie(one.workspace)) for one in scene.boxes)
        return replace(scene, elements=elements, frictions=frictions, boxes=boxes)

    def _policy(self, policy: Policy) -> Policy:
        return replace(policy, observations=tuple(self._observation(one) for one in policy.observations))

    def _observation(self, observation: Observation) -> Observation:
        mapped = tuple((text, self._curie(target)) for text, target in observation.mapped)
        provider, view = observation.provider, observation.provider.view
        if view is not None:
            provider = replace(provider, view=replace(view, sensor=self._curie(view.sensor)))
        targets = tuple(map(self._curie, observation.targets))
        return replace(observation, provider=provider, targets=targets, mapped=mapped)

    def specs(self, feature: str, story: Iri, scenario: ScenarioText, repeat: int = 1) -> Iterator[ScenarioSpec]:
        """Yield one specification for each repetition of a scenario in a feature.

        ``feature`` is the path of the feature relative to the run folder.
        """
        first = self._spec(feature, story, scenario)
        execution = None if self.execution is None else Iri(self.execution.iri)
        for repetition in range(1, repeat + 1):
            name = first.name if repeat == 1 else f"{first.name} (repetition {repetition})"
            seed = scenario_seed(self._seed, first.variant, first.variation, repetition)
            again = replace(first, name=name, seed=seed, repetition=repetition)
            yield self._related.related(again, execution)

    def _spec(self, feature: str, story: Iri, scenario: ScenarioText) -> ScenarioSpec:
        variant = scenario.variant
        shared = self._known(variant)
        curie = self._curie
        # A template may omit a step; then there is nothing to judge or to execute.
        steps = [(line, step) for line, step in zip(scenario.lines, scenario.steps, strict=True) if line]
        scopes = behaviour_scopes(step for _, step in steps)
        return ScenarioSpec(
            feature=feature,
            line=scenario.line,
            name=scenario.name,
            story=story,
            variant=variant.iri,
            variation=scenario.number,
            values={curie(variable): self._plain(cell) for variable, cell in scenario.values.items()},
            seed=scenario_seed(self._seed, variant.iri, scenario.number),
            scene=self._scene(shared, variant.scene, scenario.values),
            events=shared.events,
            clauses=tuple(
                self._clause(line, step, iterations_of(step.scope, scopes, step.reach)) for line, step in steps
            ),
            execution=self.execution,
            model=self._name,
            chosen_instance=shared.instance,
            defined=self._defined(variant, scenario.values),
        )

    def _defined(self, variant: Variant, values: Values) -> tuple[DefinedEvent, ...]:
        found = (self._binder.defined_event(event, values) for event in variant.template.events)
        return tuple(event for event in found if event is not None)

    def _known(self, variant: Variant) -> _Shared:
        shared = self._variants.get(variant.iri)
        if shared is None:
            shared = self._variants[variant.iri] = self._shared(variant)
        return shared

    def _clause(self, line: int, step: Step, iterations: tuple[int, ...]) -> ClauseSpec:
        name = self._curie(step.clause).rsplit(":", 1)[-1]
        statement = step.statement
        found = ClauseSpec(line, step.clause, name, step.role, step.text, statement, (), iterations)
        if isinstance(statement, BehaviourCall | EventOccurrence):
            return found
        leaves = tuple(leaves_of(statement))
        parts = tuple(leaf.iri for leaf in leaves)
        if not self._binder.by_code.isdisjoint(parts) or any(isinstance(leaf, Text) for leaf in leaves):
            found = replace(found, statement=self._binder.bind(*step.source))
        return replace(found, parts=parts) if isinstance(statement, StatedJunction) else found

    def _curie(self, iri: str) -> str:
        found = self._curies.get(iri)
        if found is None:
            found = self._curies[iri] = self._model.curie(iri)
        return found

    def _plain(self, cell: Cell) -> object:
        if isinstance(cell, tuple):
            return [self._plain(value) for value in cell]
        return self._curie(cell) if isinstance(cell, Iri) else cell

    def _shared(self, variant: Variant) -> _Shared:
        scene = variant.scene
        return _Shared(
            (*variant.template.clauses, *variant.clauses),
            variant.template.events,
            (*scene.objects, *(thing for carriers in scene.carriers.values() for thing in carriers)),
            self._named(scene.carriers),
            self._named(scene.contains),
            named_elements(self._model, variant),
            {self._curie(event): emits for event, emits in emitters_of(variant, self._relations.node(variant)).items()},
            None if variant.instance is None else self._instance(variant.instance),
            self._correct_places(variant.instance),
        )

    def _correct_places(self, instance: SceneInstance | None) -> dict[str, tuple[str, ...]]:
        """Return the correct places that the model states, and those that a chosen scene instance adds."""
        if instance is None:
            return self._stated_places
        found = {thing: set[str](places) for thing, places in self._model.correct_places.items()}
        for thing, places in instance.correct_places.items():
            found.setdefault(Iri(thing), set()).update(places)
        return self._named({thing: tuple(map(Iri, sorted(places))) for thing, places in found.items()})

    def _named(self, mapping: Mapping[Iri, tuple[Iri, ...]]) -> dict[str, tuple[str, ...]]:
        return {self._curie(key): tuple(map(self._curie, entries)) for key, entries in mapping.items()}

    def _scene(self, shared: _Shared, scene: SceneModel, values: Values) -> SceneSpec:
        extra = elements_of((*values.values(), *shared.named))
        places: dict[str, str] = {}
        config: list[ConfigSpec] = []
        for fluent, inner, is_later in _givens(self._model, shared.clauses, values):
            if fluent.conditions:
                continue
            if fluent.predicate == "located-at":
                thing, place = (_value(fluent.arguments[slot], inner) for slot in ("object", "workspace"))
                if isinstance(thing, Iri) and isinstance(place, Iri):
                    name = self._curie(thing)
                    places[name] = places[name] if is_later and name in places else self._curie(place)
            elif fluent.predicate == "has-config":
                config += self._config(fluent, inner)
        objects = self._members(shared.objects, extra, "object")
        agents = self._members(scene.agents, extra, "agent")
        used = self._used(shared, extra) | {one.target for one in config}
        return SceneSpec(
            objects,
            agents,
            shared.workspaces,
            shared.contains,
            places,
            tuple(config),
            tuple(name for name in (*objects, *agents) if name not in used),
            {name: sets for name in (*objects, *agents) if (sets := self._sets.get(name))},
            {name: correct for name in objects if (correct := shared.correct_places.get(name))},
            tuple(one for name in objects for one in self._stated.get(name, ())),
        )

    def _used(self, shared: _Shared, extra: tuple[Iri, ...]) -> set[str]:
        """Return the elements that values and clauses use, and which of them are objects that carry workspaces."""
        terms = (*used_names(shared.clauses), *names_in_events(shared.defined))
        named = [iri for name in terms for iri in (name, *self._model.sets.get(name, ()))]
        used = {self._curie(str(name)) for name in (*extra, *named)}
        waiting = [name for name in used if name in shared.workspaces or name in shared.contains]
        while waiting:
            workspace = waiting.pop()
            inner = [name for name in shared.contains.get(workspace, ()) if name not in used]
            used.update(shared.workspaces.get(workspace, ()), inner)
            waiting += inner
        return used

    def _members(self, own: tuple[Iri, ...], extra: tuple[Iri, ...], kind: str) -> tuple[str, ...]:
        added = (element for element in extra if self._model.kinds.get(element) == kind)
        return tuple(self._curie(element) for element in dict.fromkeys((*own, *added)))

    def _config(self, fluent: Fluent, values: Values) -> Iterator[ConfigSpec]:
        """Yield the configuration of elements that a clause requires. ``values`` are written as in the feature text."""
        target, value = (_value(fluent.arguments[slot], values) for slot in ("target", "value"))
        for element in target if isinstance(target, tuple) else (target,):
            yield ConfigSpec(self._word(element), fluent.arguments["name"], self._word(value))

    def _word(self, cell: Cell) -> str:
        if isinstance(cell, tuple):
            return " ".join(self._word(value) for value in cell)
        return self._curie(cell) if isinstance(cell, Iri) else " ".join(str(cell).split())


def _givens(
    model: AcceptanceModel, clauses: tuple[Clause, ...], values: Values, *, is_later: bool = False
) -> Iterator[tuple[Fluent, Values, bool]]:
    """Yield the unconditional fluents of ``Given``, and whether they belong to a later part of a body.

    If the world contradicts such a fluent from the start, the scenario would test nothing. Fluents of a later part are
    marked, because an earlier part may move a thing to the place where the later part expects it.
    """
    numbers = part_numbers(clauses)
    count = count_of_parts(clauses, numbers)
    for clause, number in zip(clauses, numbers, strict=True):
        later = is_later or 0 < number < count
        match clause:
            case Fluent(role="given"):
                yield from ((part, values, later) for part in (clause, *required_parts(clause)))
            case Junction(operator="and"):
                yield from _givens(model, clause.operands, values, is_later=later)
            case ForAll():
                elements = values.get(clause.in_set, model.sets.get(clause.in_set, ()))
                for element in elements if isinstance(elements, tuple) else (elements,):
                    inner = {**values, clause.variable: element}
                    yield from _givens(model, clause.clauses, inner, is_later=later)
            case _:
                pass


def _value(term: Iri | str, values: Values) -> Cell:
    return values.get(term, term) if isinstance(term, Iri) else term
