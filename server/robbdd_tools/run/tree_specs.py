"""Build the agent's specification of a behaviour-tree execution: its leaves' behaviours, scene and events."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace

from robbdd_tools.catalog.coordination import NodeSpec, TreeSpec
from robbdd_tools.gherkin.binding import seconds_of
from robbdd_tools.graph.acceptance_model import (
    AcceptanceModel,
    Cell,
    Clause,
    Fluent,
    Iri,
    TextClause,
    TextFluent,
    TreeNode,
    Variant,
    every_clause,
)
from robbdd_tools.monitor.last_iteration import LAST
from robbdd_tools.monitor.time import After, Before
from robbdd_tools.protocol.specs import ScenarioSpec, SceneSpec
from robbdd_tools.run.related_scenarios import Group, Member, Relations, roots_of
from robbdd_tools.run.seeds import scenario_seed

LEAD = 0.5
"""Minimum seconds recorded before a tree starts."""


@dataclass(frozen=True, slots=True)
class _Shared:
    """The data that the scenarios of a group have in common."""

    tree: TreeSpec
    scene: SceneSpec
    events: Mapping[str, str]


@dataclass(slots=True)
class TreeSpecWriter:
    """Makes scenarios that are linked to the same behaviour tree share one execution of it.

    ``scene`` returns the scene of a single scenario, and ``events`` returns the emitters of its events. Both use
    CURIEs.
    """

    model: AcceptanceModel
    relations: Relations
    seed: int
    scene: Callable[[Variant, Mapping[Iri, Cell]], SceneSpec]
    events: Callable[[Variant], Mapping[str, str]]
    _shared: dict[int, _Shared] = field(default_factory=dict[int, _Shared])

    def related(self, spec: ScenarioSpec, execution: Iri | None) -> ScenarioSpec:
        """Return the specification of a scenario that is judged from its group's shared execution.

        A scenario that belongs to no group is returned unchanged.
        """
        group = self.relations.group(Iri(spec.variant), execution, spec.variation)
        if group is None:
            return spec
        shared = self._shared.get(id(group))
        if shared is None:
            shared = self._shared[id(group)] = self._make(group)
        node = next(member.node for member in group.members if member.key[0] == spec.variant)
        again = f".{spec.repetition}" if spec.repetition > 1 else ""
        return replace(
            spec,
            tree=replace(shared.tree, name=shared.tree.name + again) if again else shared.tree,
            node=node,
            scene=shared.scene,
            seed=scenario_seed(self.seed, group.tree.iri, group.number, spec.repetition),
            events={**shared.events, **spec.events},
            clauses=tuple(replace(clause, iterations=(0, LAST)) for clause in spec.clauses),
        )

    def _make(self, group: Group) -> _Shared:
        scenes = [self.scene(member.variant, member.values) for member in group.members]
        events: dict[str, str] = {}
        for member in reversed(group.members):
            events |= self.events(member.variant)
        return _Shared(self._tree(group), _joined(scenes), events)

    def _tree(self, group: Group) -> TreeSpec:
        tree = group.tree
        horizons = [found for member in group.members for found in _horizons(member)]
        lead = max((seconds for before, seconds in horizons if before), default=LEAD)
        tail = max((seconds for before, seconds in horizons if not before), default=0.0)
        nodes = tuple(self._node(node, group) for node in roots_of(tree))
        name = f"{self.model.curie(tree.iri)} {group.number}"
        return TreeSpec(name, tree.iri, nodes, max(LEAD, lead), tail, tree.source)

    def _node(self, node: TreeNode, group: Group) -> NodeSpec:
        name = self.model.curie(node.iri).rpartition(":")[2].rpartition(".")[2]
        if node.kind != "leaf":
            return NodeSpec(node.iri, name, node.kind, tuple(self._node(child, group) for child in node.children))
        link = self.relations.behaviours.get(node.iri)
        if link is None:
            problem = f"no scenario is linked to {name}, so its behaviour is undefined"
            return NodeSpec(node.iri, name, node.kind, problem=problem)
        arguments = {slot: self._element(term, group.values) for slot, term in link.arguments.items()}
        missing = [slot for slot, element in arguments.items() if not element]
        if missing:
            problem = f"no scenario says which {missing[0]} {name} is about"
            return NodeSpec(node.iri, name, node.kind, problem=problem)
        return NodeSpec(node.iri, name, node.kind, behaviour=link.behaviour, arguments=arguments)

    def _element(self, term: Iri | str, values: Mapping[Iri, Cell]) -> str | tuple[str, ...]:
        """Return the CURIE of a term's element, or all CURIEs of a set of workspaces; empty for any other term."""
        value = values.get(term, self.model.sets.get(term, term)) if isinstance(term, Iri) else term
        if isinstance(value, tuple) and all(self.model.kinds.get(Iri(one)) == "workspace" for one in value):
            return tuple(self.model.curie(str(one)) for one in value)
        return self.model.curie(value) if isinstance(value, Iri) and value in self.model.kinds else ""


def _joined(scenes: list[SceneSpec]) -> SceneSpec:
    """Return the union of scenes that have the same scene model.

    If they conflict, the scenario that is first in the tree takes precedence.
    """
    first = scenes[0]
    config = {(one.target, one.name): one for scene in reversed(scenes) for one in scene.config}
    places = {thing: place for scene in reversed(scenes) for thing, place in scene.places.items()}
    return replace(
        first,
        objects=tuple(dict.fromkeys(name for scene in scenes for name in scene.objects)),
        agents=tuple(dict.fromkeys(name for scene in scenes for name in scene.agents)),
        places=places,
        config=tuple(config.values()),
        unused=tuple(name for name in first.unused if all(name in scene.unused for scene in scenes)),
        sets={name: sets for scene in scenes for name, sets in scene.sets.items()},
    )


def _horizons(member: Member) -> Iterator[tuple[bool, float]]:
    """Yield each time horizon of a member: true if it lies before the event (*before*), and its length in s."""
    clauses = (*member.variant.template.clauses, *member.variant.clauses)
    yield from _clause_horizons(clauses, member.values)
    for policy in () if member.execution is None else member.execution.policies:
        if policy.horizon is not None:
            yield from ((True, policy.horizon), (False, policy.horizon))


def _clause_horizons(clauses: Iterable[Clause], values: Mapping[Iri, Cell]) -> Iterator[tuple[bool, float]]:
    for clause in every_clause(clauses):
        if isinstance(clause, Fluent | TextFluent | TextClause) and isinstance(clause.time, Before | After):
            variable = clause.seconds
            horizon = clause.time.horizon if variable is None else seconds_of(values.get(variable))
            if horizon is not None:
                yield isinstance(clause.time, Before), horizon
