"""Write a graph as RobBDD text that a person can read and edit."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.graph.acceptance_model import ForAll, Iri
from robbdd_tools.graph.rdf.prefixes import user_prefixes
from robbdd_tools.graph.rdf.records import Incomplete, Records, items_of
from robbdd_tools.graph.rdf.vocabulary import EVENT_LIST
from robbdd_tools.graph.read.acceptance import story_order
from robbdd_tools.graph.read.clauses import ClauseReader, used_names
from robbdd_tools.graph.text.behaviour_trees import tree_text
from robbdd_tools.graph.text.clauses import ClauseText, template_text
from robbdd_tools.graph.text.named_predicates import declare_predicate, predicate_text
from robbdd_tools.graph.text.names import Names, quoted
from robbdd_tools.graph.text.requirements import requirement_texts
from robbdd_tools.graph.text.scenes import SceneText
from robbdd_tools.graph.text.stories import StoryText

if TYPE_CHECKING:
    from rdflib import Graph

OWL_INSTANT = "http://www.w3.org/2006/time#Instant"
"""Some models use this type for events."""


_LARGER = (
    *("bdd:ScenarioTemplate", "bdd:UserStory", "bdd:ScenarioVariant", "bdd:FluentClause", "bdd:ScenarioVariable"),
    *("bdd:Scene", "bdd:Set", "bhv:Behaviour", "bt:BehaviourTree", "env:Object", "env:Workspace", "agn:Agent"),
    "rbw:DefinedEvent",
    "rbw:Requirement",
)
"""Nodes of these types are not written as events or tasks. If they also have such a type, it is lost."""


@dataclass(frozen=True, slots=True)
class ModelText:
    """The text of a model.

    ``scene`` is the content of its scene file, or empty if the model needs none. ``renamed`` maps nodes to their new
    IRIs in the text. ``left_out`` maps each node that cannot be written to the reason.
    """

    criteria: str
    scene: str
    renamed: Mapping[str, str]
    left_out: Mapping[str, str]


def write_model(graph: Graph, scene_name: str) -> ModelText:
    """Return a graph as text. ``scene_name`` is the path by which the text imports the scene file.

    Raises ``Incomplete`` for a scene or a name that cannot be written.
    """
    records = Records(graph)
    stated = {namespace: prefix for prefix, namespace in user_prefixes(graph).items()}
    names = Names(records, stated)
    scenes = SceneText(names)
    scene_blocks = scenes.text()
    scene_spaces = dict(names.used)
    criteria = _criteria(names, scenes)
    head = [f"import {quoted(scene_name)}\n"] if scene_blocks else []
    kept = stated if records.subjects("rbw:prefix") else {}
    for namespace in kept:
        names.prefix(namespace)
    own = {namespace: prefix for namespace, prefix in names.used.items() if namespace not in scene_spaces}
    text = "\n".join([*head, *_namespaces(own), *criteria.blocks])
    scene = "\n".join([*_namespaces(scene_spaces), *(f"{block}\n" for block in scene_blocks)])
    return ModelText(text, scene if scene_blocks else "", names.renamed, criteria.left_out)


@dataclass(frozen=True, slots=True)
class _Criteria:
    blocks: list[str]
    left_out: dict[str, str]


def _namespaces(spaces: Mapping[str, str]) -> list[str]:
    lines = [f"ns {prefix} = {quoted(namespace)}" for namespace, prefix in sorted(spaces.items(), key=lambda s: s[1])]
    return [*lines, ""] if lines else []


def _criteria(names: Names, scenes: SceneText) -> _Criteria:
    records = names.records
    left_out: dict[str, str] = {}
    requirements = list(requirement_texts(names))
    for kind, types in (("task", ("task:Task",)), ("event", ("time:Event", OWL_INSTANT))):
        for node in sorted({node for type_ in types for node in records.instances(type_)}):
            if not any(records.is_a(node, other) for other in _LARGER):
                names.lazily(node, kind)
    templates, stories = records.instances("bdd:ScenarioTemplate"), story_order(records)
    for node in templates:
        names.declare(node, "template")
        for event in records.iris(items_of(records, node, EVENT_LIST)):
            names.declare(event, "event", owner=names.paths[node], namespace=names.split(node)[0])
    for node in stories:
        names.declare(node, "story")
    reader = ClauseReader(records)
    blocks: list[str] = list(_predicates(names, left_out))
    for node in records.instances("bt:BehaviourTree"):
        try:
            blocks.append(tree_text(names, node) + "\n")
        except Incomplete as error:
            left_out[node] = str(error)
    outside: dict[str, dict[str, str]] = {}
    for node in templates:
        try:
            variables = _variables(records, reader, node)
            blocks.append(template_text(names, reader, node, variables) + "\n")
            outside[node] = {variable: names.reference(variable) for variable in variables}
        except Incomplete as error:
            left_out[node] = str(error)
    writer = StoryText(names, scenes, reader, outside, left_out)
    for node in stories:
        try:
            blocks.append(writer.text(node) + "\n")
        except Incomplete as error:
            left_out[node] = str(error)
    sets = [scenes.constant_set(node) for node in scenes.constant_sets]
    simple = [
        f"{word} {names.scope_of(node)} {names.paths[node]}"
        for kind, word in (("task", "Task"), ("event", "Event"))
        for node in names.declared.get(kind, ())
    ]
    return _Criteria([*simple, *requirements, *sets, "", *blocks], left_out)


def _predicates(names: Names, left_out: dict[str, str]) -> Iterator[str]:
    """Yield the declarations of named predicates. All their names are declared first: they may refer to each other."""
    declared: list[Iri] = []
    for node in names.records.instances("rbw:NamedPredicate"):
        try:
            declare_predicate(names, node)
            declared.append(node)
        except Incomplete as error:
            left_out[node] = str(error)
    for node in declared:
        try:
            owner, namespace = names.paths[node], names.split(node)[0]
            yield (
                predicate_text(
                    names, node, lambda state, own, at=(owner, namespace): ClauseText(names, *at, own).state(state)
                )
                + "\n"
            )
        except Incomplete as error:
            left_out[node] = str(error)


def _variables(records: Records, reader: ClauseReader, template: Iri) -> list[Iri]:
    """Return the variables of a template.

    If the graph does not list them, return the unbound variables of its clauses.
    """
    if records.all(template, "rbw:variables"):
        return list(records.iris(items_of(records, template, "rbw:variables")))
    clauses = reader.clauses(template)
    bound = {clause.variable for clause in clauses if isinstance(clause, ForAll)}
    used: dict[Iri, None] = dict.fromkeys(used_names(clauses))
    for variant in records.instances("bdd:ScenarioVariant"):
        if template in records.iris(records.all(variant, "bdd:of-template")):
            for variation in records.iris(records.all(variant, "bdd:has-variation")):
                used |= dict.fromkeys(records.iris(items_of(records, variation, "bdd:variable-list")))
    return [node for node in used if node not in bound and records.is_a(node, "bdd:ScenarioVariable")]
