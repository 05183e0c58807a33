"""Read acceptance criteria from any graph into plain data. Incomplete parts of the graph are left out."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from robbdd_tools.graph.acceptance_model import (
    AcceptanceModel,
    Clause,
    Iri,
    SceneModel,
    Story,
    Template,
    Value,
    Variant,
)
from robbdd_tools.graph.rdf.prefixes import reading_prefixes
from robbdd_tools.graph.rdf.records import Incomplete, Records
from robbdd_tools.graph.rdf.vocabulary import ELEMENT_TYPES, MEMBERSHIPS, VERIFIES
from robbdd_tools.graph.read.behaviour_trees import read_trees
from robbdd_tools.graph.read.clauses import ClauseReader, names_in_events, used_names
from robbdd_tools.graph.read.executions import read_executions, read_implementations
from robbdd_tools.graph.read.instances import InstanceReader, Places
from robbdd_tools.graph.read.requirements import read_requirements
from robbdd_tools.graph.read.scene_columns import read_columns
from robbdd_tools.graph.read.stated_settings import read_stated_settings
from robbdd_tools.graph.read.variations import VariationReader

if TYPE_CHECKING:
    from rdflib import Graph

    from robbdd_tools.catalog.executable import SceneInstance


def _nowhere(_: str) -> None:
    """Return no source position."""


def read_model(graph: Graph, places: Places = _nowhere, records: Records | None = None) -> AcceptanceModel:
    """Return the acceptance criteria of a graph, in written order if the graph records this order.

    ``places`` returns the source positions of nodes. ``records`` are the graph's records, if known. A variant is
    left out if something is missing, for example its template, the value of a variable or a known predicate.
    """
    records = records or Records(graph)
    sets = {node: read_set(records, node) for node in records.instances("bdd:ConstantSet")}
    kinds = {node: kind for kind, type_ in ELEMENT_TYPES.items() for node in records.instances(type_)}
    stories = story_order(records)
    reader = _Reader(records, ClauseReader(records), VariationReader(records, sets))
    every = tuple(reader.story(node) for node in stories)
    executions = read_executions(records, InstanceReader(records, sets, places), places)
    trees = read_trees(records, places)
    correct = _correct_places(records, sets)
    verifies = {node: records.iris(records.all(node, VERIFIES)) for node in records.subjects(VERIFIES)}
    known = read_implementations(records, places)
    stated = read_stated_settings(records, (node for node, kind in kinds.items() if kind == "object"))
    prefixes, required = reading_prefixes(graph), read_requirements(records)
    rest = correct, verifies, known, stated, required
    return AcceptanceModel(every, kinds, sets, prefixes, executions, trees, *rest)


def _correct_places(records: Records, sets: Mapping[Iri, tuple[Value, ...]]) -> dict[Iri, tuple[Iri, ...]]:
    """Return the workspaces that are correct for each object, in the order of their IRIs."""
    found: dict[Iri, dict[Iri, None]] = {}
    for workspace in records.subjects("rbw:correct-for"):
        for stated in records.iris(records.all(workspace, "rbw:correct-for")):
            for thing in sets.get(stated, (stated,)):
                if isinstance(thing, Iri):
                    found.setdefault(thing, {})[workspace] = None
    return {thing: tuple(places) for thing, places in found.items()}


def read_instances(
    graph: Graph, places: Places = _nowhere, records: Records | None = None
) -> tuple[SceneInstance, ...]:
    """Return the scene instances of a graph in IRI order, each with the correct places that the graph states.

    ``records`` are the graph's records, if known.
    """
    records = records or Records(graph)
    sets = {node: read_set(records, node) for node in records.instances("bdd:ConstantSet")}
    reader, correct = InstanceReader(records, sets, places), _correct_places(records, sets)
    instances = map(reader.instance, sorted(records.instances("rbw:SceneInstance")))
    return tuple(replace(instance, correct_places=correct) for instance in instances)


def incomplete_variants(records: Records) -> dict[Iri, str]:
    """Return each variant that ``read_model`` leaves out, with the part that it lacks."""
    sets = {node: read_set(records, node) for node in records.instances("bdd:ConstantSet")}
    reader = _Reader(records, ClauseReader(records), VariationReader(records, sets))
    found: dict[Iri, str] = {}
    for node in records.instances("bdd:ScenarioVariant"):
        try:
            reader.variant(node)
        except Incomplete as error:
            found[node] = str(error)
    return found


def read_set(records: Records, node: str) -> tuple[Value, ...]:
    """Return the elements of a set in written order, including repetitions."""
    listed = records.all(node, "rbw:element-list")
    items = records.items(listed[0]) if listed else None
    elements = records.all(node, "bdd:elements")
    if items is None or set(items) != set(elements):
        items = elements
    return tuple(records.value(item) for item in items)


def story_order(records: Records) -> list[Iri]:
    """Return the stories of a graph, in written order if the graph records this order."""
    return sorted(records.instances("bdd:UserStory"), key=lambda node: (_position(records, node), node))


def _position(records: Records, node: str) -> float:
    position = records.literal(node, "rbw:position")
    return position if isinstance(position, int | float) else float("inf")


@dataclass(frozen=True, slots=True)
class _Reader:
    records: Records
    clauses: ClauseReader
    variations: VariationReader

    def story(self, node: Iri) -> Story:
        criteria = self.records.iris(self.records.ordered(node, "bdd:has-criteria", "rbw:criteria-list"))
        role, feature, benefit = (self.records.text(node, f"rbw:{part}") for part in ("role", "feature", "benefit"))
        return Story(node, role, feature, benefit, tuple(self._complete(criteria)))

    def _complete(self, criteria: Iterable[Iri]) -> Iterator[Variant]:
        for node in criteria:
            try:
                yield self.variant(node)
            except Incomplete:
                continue

    def variant(self, node: Iri) -> Variant:
        """Return a scenario variant; raises ``Incomplete``."""
        template = self._template(self.records.one(node, "bdd:of-template"))
        extra = self._extra_clauses(node)
        variation = self.variations.variation(self.records.one(node, "bdd:has-variation"))
        for name in (*used_names((*template.clauses, *extra)), *names_in_events(template.events)):
            if self.records.is_a(name, "bdd:ScenarioVariable") and name not in variation.variables:
                raise Incomplete(f"{node} gives {name} no value")
        scenes = self.records.iris(self.records.all(node, "rbw:scene"))
        return Variant(node, template, extra, self._scene(node), variation, tuple(scenes))

    def _extra_clauses(self, node: Iri) -> tuple[Clause, ...]:
        stated = self.records.all(node, "bdd:has-clause")
        # In published graphs, a variant without its own clauses has an empty node instead of the list.
        if not stated or self.records.is_blank(stated[0]):
            return ()
        return self.clauses.clauses(node)

    def _template(self, node: Iri) -> Template:
        start, end = (self.records.one(node, f"time:{side}-event") for side in ("after", "before"))
        return Template(node, self.clauses.clauses(node), start, end, self.clauses.events(node))

    def _scene(self, variant: Iri) -> SceneModel:
        members: dict[str, dict[Iri, None]] = {kind: {} for kind in MEMBERSHIPS}
        for node in self.records.iris(self.records.all(variant, "bdd:has-scene")):
            for kind, (_, term, _) in MEMBERSHIPS.items():
                found = self.records.iris(self.records.ordered(node, term, "rbw:member-list"))
                members[kind].update(dict.fromkeys(found))
        workspaces = tuple(members["workspace"])
        carriers: dict[Iri, dict[Iri, None]] = {}
        contains: dict[Iri, dict[Iri, None]] = {}
        for node in self._compositions(variant, workspaces):
            workspace = self.records.one(node, "env:of-workspace")
            for target, term in ((carriers, "env:has-object"), (contains, "env:has-workspace")):
                inner = self.records.iris(self.records.ordered(node, term, "rbw:entries"))
                if inner:
                    target.setdefault(workspace, {}).update(dict.fromkeys(inner))
        return SceneModel(
            tuple(members["object"]),
            workspaces,
            tuple(members["agent"]),
            {workspace: tuple(objects) for workspace, objects in carriers.items()},
            {workspace: tuple(inner) for workspace, inner in contains.items()},
            tuple(read_columns(self.records, variant, {member for kind in members.values() for member in kind})),
        )

    def _compositions(self, variant: Iri, workspaces: tuple[Iri, ...]) -> tuple[Iri, ...]:
        """Return the compositions of a variant's scene, or of its workspaces if the graph names no scene."""
        scenes = self.records.iris(self.records.all(variant, "rbw:scene"))
        if not scenes:
            every = self.records.subjects("env:of-workspace")
            return tuple(node for node in every if self.records.one(node, "env:of-workspace") in workspaces)
        found: dict[Iri, None] = {}
        waiting = list(scenes)
        while waiting:
            node = waiting.pop(0)
            if self.records.all(node, "env:of-workspace"):
                found[node] = None
            listed = self.records.all(node, "rbw:entries")
            entries = self.records.iris((self.records.items(listed[0]) if listed else None) or ())
            waiting += [entry for entry in entries if entry not in found]
        return tuple(found)
