"""Build one graph from a file and from the parts of its imports that it uses.

All declarations of the file itself are included, and those declarations of imported files that are reachable from them.
User input never raises an error. A broken declaration, an unresolved name or an invalid IRI adds no triples.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import groupby
from typing import TYPE_CHECKING

from robbdd_tools.base.graph_formats import graph_format
from robbdd_tools.catalog.term_prefixes import PREFIXES
from robbdd_tools.graph.rdf.prefixes import bind_prefixes, prefix_for
from robbdd_tools.graph.write.behaviour_trees import add_behaviour_tree
from robbdd_tools.graph.write.built import BuiltGraph as BuiltGraph
from robbdd_tools.graph.write.built import Clash
from robbdd_tools.graph.write.clauses import ClauseWriter, add_time
from robbdd_tools.graph.write.declarations import Key, Reached, Uses, reachable_declarations, unreliable_declarations
from robbdd_tools.graph.write.executions import add_execution
from robbdd_tools.graph.write.foreign import read_graph_file
from robbdd_tools.graph.write.identities import SHARED, Identities, identities
from robbdd_tools.graph.write.imported_faults import imported_faults
from robbdd_tools.graph.write.imported_graphs import NOTHING, ImportedGraph, imported_graph
from robbdd_tools.graph.write.instances import add_instances
from robbdd_tools.graph.write.named_predicates import add_named_predicate
from robbdd_tools.graph.write.property_sets import PropertySets
from robbdd_tools.graph.write.requirements import add_requirement, add_verified
from robbdd_tools.graph.write.scenes import (
    Memberships,
    Scenes,
    add_composition,
    add_composition_contents,
    add_element_set,
    add_scene,
    add_set,
    add_similar_set,
)
from robbdd_tools.graph.write.sink import Frame, Sink, namespace_of
from robbdd_tools.graph.write.source_map import Location
from robbdd_tools.graph.write.stories import Known, add_story
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from rdflib import URIRef
    from rdflib.term import Node

    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot

TEMPLATE_PARTS = ("-scene", "-scenario", "-scenario-given", "-scenario-when", "-scenario-then")
SCENARIO_PARTS = {"given": "bdd:Given", "when": "bdd:When", "then": "bdd:Then"}


def build_graph(snapshot: Snapshot, uri: str, together: Collection[str] = ()) -> BuiltGraph:
    """Return the graph of a file in a snapshot (empty if the file cannot be read).

    A file with a graph format's extension is parsed as a graph. All declarations of the imported files ``together`` are
    included.
    """
    file = snapshot.file(uri) if graph_format(uri) else None
    if file is not None:
        return read_graph_file(file.document, [snapshot.document(other) for other in snapshot.joined.get(uri, ())])
    uses = Uses(snapshot.closure(uri), together)
    imported = imported_graph(snapshot, uri)
    reached = reachable_declarations(uses, imported.nodes)
    built = build_declarations(uri, uses, reached, identities(snapshot, reached), imported)
    return replace(built, faults=tuple(imported_faults(snapshot, uri, imported, built.graph)))


def build_declarations(
    uri: str, uses: Uses, reached: Sequence[Reached], known: Identities, imported: ImportedGraph = NOTHING
) -> BuiltGraph:
    """Return the graph of some declarations of a file, with the statements of the graphs that it imports.

    ``reached`` are all reachable declarations, or a complete part of them. A part is complete if it contains everything
    that its declarations use and all declarations that name the same nodes. ``known`` are the nodes that all
    declarations of the file name.
    """
    sink = Sink()
    for node, declarers in known.shared.items():
        sink.sources.mark([(node,)], declarers[0].location)
    _add_foundations(sink, reached, imported)
    prefixes = _add_prefixes(sink, reached)
    names = known.names
    if imported.documents:
        _add_imported(sink, imported, prefixes)
        names = {**imported.names, **names}
    bind_prefixes(sink.graph, prefixes)
    clashes = tuple(Clash(str(node), location, first) for node, location, first in sink.clashes)
    uncertain = unreliable_declarations(uses, reached, [clash.location for clash in clashes])
    return BuiltGraph(
        uri,
        sink.graph,
        sink.sources.build(),
        names,
        clashes,
        tuple(Location(entry.uri, entry.placed.span) for entry in uncertain),
        frozenset(_nodes_of(uncertain)),
        authors=sink.authors,
    )


def _nodes_of(entries: Iterable[Reached]) -> Iterator[str]:
    """Yield the nodes that only one of these declarations describes, including the parts of a template.

    Variables and behaviours are left out, because templates of a namespace share them. So an error in one template
    does not affect them in another template.
    """
    declared: dict[str, list[Definition]] = {}
    for entry in entries:
        if entry.uri not in declared:
            declared[entry.uri] = sorted(entry.file.definitions.values(), key=_start)
        inside = declared[entry.uri]
        span = entry.placed.span
        for definition in inside[bisect_left(inside, span.start, key=_start) :]:
            if definition.span.start >= span.end:
                break
            if definition.iri is not None and definition.kind not in SHARED:
                yield definition.iri
                if definition.kind is SymbolKind.TEMPLATE:
                    yield from (definition.iri + part for part in TEMPLATE_PARTS)


def _start(definition: Definition) -> int:
    return definition.span.start


def _add_foundations(sink: Sink, reached: Sequence[Reached], imported: ImportedGraph) -> None:
    """Write all declarations: first independent ones, then the contents of compositions, and then stories."""
    tasks: dict[URIRef, URIRef] = {}
    wholes = [tuple(parts) for _, parts in groupby(reached, key=_whole)]
    placed = [(entry.tree, Frame(sink, entry.file, entry.placed)) for entry, *_ in wholes]
    scenes = Scenes(PropertySets(placed, imported))
    for root, frame in placed:
        frame.begin()
        if isinstance(root, tree.Template):
            _add_template(frame, scenes.selected, root, tasks)
        elif root is not None:
            _add_simple(frame, scenes, root)
    for root, frame in placed:
        if isinstance(root, tree.Composition):
            frame.begin()
            add_composition_contents(frame, scenes, root)
    known = Known(scenes, Memberships(sink), tasks)
    stories = (parts for parts in wholes if parts[0].story is not None or isinstance(parts[0].tree, tree.Story))
    for position, parts in enumerate(stories):
        add_story(sink, known, parts, position)
    add_instances(placed)
    for position, (root, frame) in enumerate(placed):
        frame.begin()
        add_execution(frame, root, position)


def _whole(entry: Reached) -> Key:
    """Return the key of a declaration. For a part of a story, return the key of the story."""
    return entry.key if entry.story is None else (entry.uri, entry.story.offset)


def _add_simple(frame: Frame, scenes: Scenes, root: tree.ChunkTree) -> None:
    match root:
        case tree.Event() | tree.Task():
            node = frame.claimed(root.name.text, root.name)
            if node is not None:
                kind = "time:Event" if isinstance(root, tree.Event) else "task:Task"
                frame.sink.add_types(node, [kind], frame.at(root.name))
        case tree.Requirement():
            add_requirement(frame, root)
        case tree.ConstantSet():
            _add_constant_set(frame, root)
        case tree.NamedPredicate():
            add_named_predicate(frame, root)
        case tree.BehaviourTree():
            add_behaviour_tree(frame, root)
        case tree.ElementSet():
            add_element_set(frame, scenes, root)
        case tree.SimilarSet():
            add_similar_set(frame, scenes, root)
        case tree.Composition():
            add_composition(frame, scenes, root)
        case tree.Scene():
            add_scene(frame, scenes, root)
        case _:
            pass


def _add_constant_set(frame: Frame, declared: tree.ConstantSet) -> None:
    node = frame.claimed(declared.name.text, declared.name)
    if node is None:
        return
    elements: list[Node] = []
    for value in declared.values:
        target = frame.target(value) if isinstance(value, tree.Ref) else frame.sink.value(value)
        if target is not None:
            frame.sink.mark(node, "bdd:elements", target, frame.at(value))
            elements.append(target)
    add_set(frame, node, declared.name, elements)


def _add_template(frame: Frame, selected: PropertySets, template: tree.Template, tasks: dict[URIRef, URIRef]) -> None:
    node = frame.claimed(template.name.text, template.name)
    if node is None:
        return
    sink, place = frame.sink, frame.at(template.name)
    scenario, scene = sink.iri(f"{node}-scenario"), sink.iri(f"{node}-scene")
    if scenario is None or scene is None:
        return
    sink.add_types(node, ["bdd:ScenarioTemplate"], place)
    if template.duration is not None:
        add_time(frame, node, template.duration)
    sink.add(node, "bdd:of-scenario", scenario)
    sink.add(node, "bdd:has-scene", scene)
    sink.add_types(scene, ["bdd:Scene"], place)
    _add_scenario(sink, scenario, place)
    task = None if template.task is None else frame.target(template.task)
    if template.task is not None and task is not None:
        sink.add(scenario, "task:of-task", task, frame.at(template.task))
        tasks[node] = task
    add_verified(frame, node, template.verifies)
    _add_variables(frame, node, template)
    name, body = template.name.text, template.body
    writer = ClauseWriter(frame, selected, namespace_of(node, name), name, scenario, next(body.behaviours, None))
    sink.add(node, "bdd:has-clause", sink.make_list(writer.body(body)))
    writer.events(node, template.events)


def _add_scenario(sink: Sink, scenario: URIRef, place: Location) -> None:
    sink.add_types(scenario, ["bdd:Scenario"], place)
    for role, kind in SCENARIO_PARTS.items():
        part = sink.iri(f"{scenario}-{role}")
        if part is not None:
            sink.add(scenario, f"bdd:{role}", part)
            sink.add_types(part, [kind], place)


def _add_variables(frame: Frame, node: URIRef, template: tree.Template) -> None:
    variables: list[URIRef] = []
    for variable in template.variables:
        declared = frame.node(f"{template.name.text}.{variable.name.text}")
        if declared is not None:
            types = ["bdd:ScenarioVariable", "bdd:Set"] if variable.is_set else ["bdd:ScenarioVariable"]
            frame.sink.add_types(declared, types, frame.at(variable.name))
            frame.sink.mark(node, "rbw:variables", declared, frame.at(variable.name))
            variables.append(declared)
    frame.sink.add(node, "rbw:variables", frame.sink.make_list(variables))


def _add_prefixes(sink: Sink, reached: Iterable[Reached]) -> dict[str, str]:
    """Add a prefix for each namespace, so that names can be shortened in every graph format.

    The prefixes of the file itself are added first. If a prefix already denotes another namespace, it gets a number.
    """
    prefixes: dict[str, str] = {}
    added: set[URIRef] = set()
    for root in _namespaces(reached):
        namespace = sink.iri(root.iri.value)
        if namespace is None or namespace in added:
            continue
        added.add(namespace)
        prefix = prefix_for(root.name.text, prefixes)
        prefixes[prefix] = str(namespace)
        sink.add(namespace, "rbw:prefix", sink.literal(prefix))
    return prefixes


def _add_imported(sink: Sink, imported: ImportedGraph, prefixes: dict[str, str]) -> None:
    """Add the statements of imported graphs. Their prefixes are added after the prefixes of the models."""
    declared = frozenset(str(node) for node in sink.graph.subjects())
    for triple in imported.triples:
        sink.graph.add(triple)
    for key, place in imported.places.items():
        if len(key) > 1 or declared.isdisjoint(key):
            sink.sources.mark([key], place)
    for name, prefix in imported.prefixes.items():
        namespace = sink.iri(name)
        if namespace is not None and name not in prefixes.values() and name not in PREFIXES.values():
            prefixes[prefix_for(prefix, prefixes)] = name
            sink.add(namespace, "rbw:prefix", sink.literal(next(reversed(prefixes))))


def _namespaces(reached: Iterable[Reached]) -> Iterator[tree.Namespace]:
    own_first = sorted(reached, key=lambda entry: not entry.own)
    return (entry.tree for entry in own_first if isinstance(entry.tree, tree.Namespace))
