"""Convert executions in the published vocabulary: ROS actions and topics, and scene instances with model files."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.graph.rdf.vocabulary import expand

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rdflib import Graph, URIRef
    from rdflib.term import Node

_ROS = (
    ("ros:Action", "bdd:BehaviourImplementation", "rbw:RosAction"),
    ("ros:Topic", "obs:ObservationPolicy", "rbw:TrinaryTopic"),
)
"""A published class, another class of the same node, and our class that means both."""
_FORMATS = {"mujoco": "mjcf", "urdf": "urdf", "usd": "usd"}
"""Word in the IRI of a model's published class → the model's format."""


def complete_executions(graph: Graph) -> None:
    """Add statements in our terms that mean the same as a graph's published statements about executions.

    Nothing is removed. The published form does not name the scene instance of an execution. If exactly one scene
    instance instantiates the scene of the executed variant's template, this one is used.
    """
    for ros, kind, own in _ROS:
        for node in set(_instances(graph, ros)) & set(_instances(graph, kind)):
            graph.add((node, _term("rdf:type"), _term(own)))
            for name in list(graph.objects(node, _term("ros:channel-name"))):
                graph.add((node, _term("rbw:ros-name"), name))
    own = set(_instances(graph, "rbw:SceneInstance"))
    for node in (node for node in _instances(graph, "exec:SceneInstance") if node not in own):
        _complete_instance(graph, node)
    for execution in _instances(graph, "bdd:ScenarioExecution"):
        if graph.value(execution, _term("rbw:scene-instance")) is None:
            found = set(_instances_of(graph, execution))
            if len(found) == 1:
                graph.add((execution, _term("rbw:scene-instance"), found.pop()))


def _complete_instance(graph: Graph, node: Node) -> None:
    from rdflib import BNode, Literal
    from rdflib.collection import Collection

    models: list[Node] = []
    for model in _values(graph, node, "exec:has-model"):
        path = graph.value(model, _term("exec:path"))
        words = " ".join(str(kind).lower() for kind in graph.objects(model, _term("rdf:type")))
        form = next((form for word, form in _FORMATS.items() if word in words), None)
        if path is not None and form is not None:
            graph.add((model, _term("rdf:type"), _term("rbw:Model")))
            graph.add((model, _term("rbw:path"), path))
            graph.add((model, _term("rbw:format"), Literal(form)))
            models.append(model)
    graph.add((node, _term("rdf:type"), _term("rbw:SceneInstance")))
    head = Collection(graph, BNode(), models).uri if models else _term("rdf:nil")
    graph.add((node, _term("rbw:models"), head))
    # The scenes of templates are also among the values, but only scenes of the language have their own members.
    templates = set(graph.objects(None, _term("bdd:has-scene")))
    for scene in _values(graph, node, "bdd:of-scene"):
        if scene not in templates:
            graph.add((node, _term("rbw:scene"), scene))


def _instances_of(graph: Graph, execution: Node) -> Iterator[Node]:
    """Yield the scene instances of the scene of the executed variant's template."""
    variants = _values(graph, execution, "bdd:of-variant")
    templates = [template for variant in variants for template in _values(graph, variant, "bdd:of-template")]
    scenes = {scene for template in templates for scene in _values(graph, template, "bdd:has-scene")}
    for node in _instances(graph, "exec:SceneInstance"):
        if scenes & set(_values(graph, node, "bdd:of-scene")):
            yield node


def _instances(graph: Graph, term: str) -> list[Node]:
    return sorted(graph.subjects(_term("rdf:type"), _term(term)), key=str)


def _values(graph: Graph, node: Node, term: str) -> list[Node]:
    return sorted(graph.objects(node, _term(term)), key=str)


def _term(curie: str) -> URIRef:
    from rdflib import URIRef

    return URIRef(expand(curie))
