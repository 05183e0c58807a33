"""Write executions as triples: implementations of behaviours, observations, policies and executed variants."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from robbdd_tools.graph.write.robot_logs import add_log
from robbdd_tools.graph.write.units import ANGLES, LENGTHS
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from rdflib import URIRef

    from robbdd_tools.graph.write.sink import Frame

_FORMS: dict[type[tree.Node], str] = {
    tree.LessThan: "less-than",
    tree.GreaterThan: "greater-than",
    tree.Between: "between",
    tree.Equals: "equals",
}


def add_execution(frame: Frame, root: tree.ChunkTree | None, position: int) -> None:
    """Write a declaration of a ``.bddx``; ignore any other declaration.

    ``position`` is its index among all declarations.
    """
    match root:
        case tree.Implementation():
            _add_implementation(frame, root)
        case tree.Provider():
            _add_provider(frame, root)
        case tree.Observation():
            _add_observation(frame, root)
        case tree.Policy():
            _add_policy(frame, root)
        case tree.RobotLog():
            add_log(frame, root)
        case tree.Execution():
            _add_execution(frame, root, position)
        case _:
            pass


def add_python(frame: Frame, node: URIRef, source: tree.PythonAttribute) -> None:
    """State that a node is an attribute of a Python module."""
    frame.sink.add_types(node, ["py:ModuleAttribute"], frame.at(source))
    _say(frame, node, "py:module-name", source.module.text, source.module)
    _say(frame, node, "py:attribute-name", source.attribute.text, source.attribute)


def _say(frame: Frame, node: URIRef, term: str, value: str | float | None, place: tree.Node) -> None:
    if value is not None:
        frame.sink.add(node, term, frame.sink.literal(value), frame.at(place))


def _number(frame: Frame, node: URIRef, term: str, number: tree.Number | None, factor: float = 1.0) -> None:
    """Add a number in SI units as a double."""
    if number is not None:
        _say(frame, node, term, float(number.value) * factor, number)


def _part(frame: Frame, node: URIRef, name: str, term: str) -> URIRef | None:
    """Add a part of a node with its own name."""
    part = frame.sink.iri(f"{node}.{name}")
    frame.sink.add(node, term, part)
    return part


def _add_implementation(frame: Frame, root: tree.Implementation) -> None:
    node = frame.claimed(root.name.text, root.name)
    if node is None:
        return
    frame.sink.add_types(node, ["bdd:BehaviourImplementation"], frame.at(root.name))
    match root.source:
        case tree.CatalogEntry(name=name):
            _say(frame, node, "rbw:catalog-name", name.value, name)
        case tree.RosAction(action=action):
            frame.sink.add_types(node, ["rbw:RosAction"], frame.at(root.name))
            _say(frame, node, "rbw:ros-name", action.value, action)
        case tree.PythonAttribute() as source:
            add_python(frame, node, source)
        case tree.ProcessSystem(command=command, limit=limit):
            frame.sink.add_types(node, ["rbw:ExternalProcess"], frame.at(root.name))
            _say(frame, node, "rbw:command", command.value, command)
            _number(frame, node, "rbw:answer-seconds", limit)
        case tree.EndpointSystem(address=address, limit=limit):
            frame.sink.add_types(node, ["rbw:ExternalEndpoint"], frame.at(root.name))
            _say(frame, node, "rbw:address", address.value, address)
            _number(frame, node, "rbw:answer-seconds", limit)


def _add_provider(frame: Frame, root: tree.Provider) -> None:
    node = frame.claimed(root.name.text, root.name)
    if node is None:
        return
    source, place = root.source, frame.at(root.name)
    frame.sink.add_types(node, ["obs:ObservationProvider"], place)
    match source:
        case tree.GroundTruth():
            frame.sink.add_types(node, ["rbw:GroundTruth"], place)
            _number(frame, node, "rbw:latency-seconds", source.latency)
            _number(frame, node, "rbw:missed-share", source.misses, 0.01)
            if source.view is not None:
                _add_view(frame, node, source.view)
        case tree.RosTopic():
            frame.sink.add_types(node, ["rbw:RosTopic"], place)
            _say(frame, node, "rbw:ros-name", source.topic.value, source.topic)
            _say(frame, node, "rbw:message-type", source.type.value, source.type)
        case tree.Transforms():
            frame.sink.add_types(node, ["rbw:RosTransforms"], place)
            _say(frame, node, "rbw:ros-name", source.frame.value, source.frame)
        case tree.SimulatedStates():
            frame.sink.add_types(node, ["rbw:RosEntityStates"], place)
    if not isinstance(source, tree.SimulatedStates):
        _number(frame, node, "rbw:noise-metres", source.noise, LENGTHS.get(source.noise_unit or "m", 1.0))
    if not isinstance(source, tree.RosTopic):
        _number(frame, node, "rbw:rate-hertz", source.rate)


def _add_view(frame: Frame, node: URIRef, view: tree.SensorView) -> None:
    sensor = view.sensor.reference
    frame.sink.add(node, "rbw:seen-from", frame.target(sensor), frame.at(sensor))
    for term, distance in (("rbw:nearest-metres", view.nearest), ("rbw:farthest-metres", view.farthest)):
        _number(frame, node, term, distance.value, LENGTHS[distance.unit])
    _number(frame, node, "rbw:field-of-view-radians", view.angle, ANGLES["deg"])


def _add_observation(frame: Frame, root: tree.Observation) -> None:
    node = frame.claimed(root.name.text, root.name)
    if node is None:
        return
    sink = frame.sink
    sink.add_types(node, ["obs:Observation"], frame.at(root.name))
    sink.add(node, "rbw:provider", frame.target(root.provider), frame.at(root.provider))
    _add_listed(frame, node, "rbw:observes", "rbw:observed-list", [link.reference for link in root.targets])
    if root.time_extractor is not None:
        part = _part(frame, node, "time-extractor", "rbw:time-extractor")
        if part is not None:
            add_python(frame, part, root.time_extractor)
    if root.entity_mapper is not None:
        _add_mapper(frame, node, root.entity_mapper)


def _add_mapper(frame: Frame, node: URIRef, mapper: tree.PythonAttribute | tree.StringMapper) -> None:
    part = _part(frame, node, "entity-mapper", "rbw:entity-mapper")
    if part is None:
        return
    if isinstance(mapper, tree.PythonAttribute):
        add_python(frame, part, mapper)
        return
    entries: list[URIRef | None] = []
    for number, entry in enumerate(mapper.entries):
        entry_node = frame.sink.iri(f"{part}.{number}")
        if entry_node is not None:
            _say(frame, entry_node, "rbw:name", entry.text.value, entry.text)
            target = frame.target(entry.target.reference)
            frame.sink.add(entry_node, "rbw:stands-for", target, frame.at(entry.target.reference))
        entries.append(entry_node)
    frame.sink.add(part, "rbw:mappings", frame.sink.make_list(entries))


def _add_policy(frame: Frame, root: tree.Policy) -> None:
    node = frame.claimed(root.name.text, root.name)
    if node is None:
        return
    sink = frame.sink
    sink.add_types(node, ["obs:ObservationPolicy"], frame.at(root.name))
    sink.add(node, "bdd:of-clause", frame.target(root.fluent), frame.at(root.fluent))
    _number(frame, node, "time:horizon-seconds", root.horizon)
    _number(frame, node, "rbw:certain-beyond-sigma", root.sigma)
    if isinstance(root.rule, tree.TrinaryTopic):
        sink.add_types(node, ["rbw:TrinaryTopic"], frame.at(root.name))
        _say(frame, node, "rbw:ros-name", root.rule.topic.value, root.rule.topic)
        return
    _add_listed(frame, node, "rbw:observation", "rbw:observation-list", root.rule.observations)
    evaluator = _part(frame, node, "evaluator", "rbw:evaluator")
    if evaluator is None:
        return
    if isinstance(root.rule.evaluator, tree.PythonAttribute):
        add_python(frame, evaluator, root.rule.evaluator)
    else:
        _add_distance(frame, evaluator, root.rule.evaluator)


def _add_distance(frame: Frame, node: URIRef, rule: tree.LinearDistance) -> None:
    sink, condition = frame.sink, rule.condition
    sink.add_types(node, ["rbw:LinearDistance"], frame.at(rule))
    _say(frame, node, "rbw:comparison", _FORMS[type(condition)], condition)
    match condition:
        case tree.LessThan(bound=bound) | tree.GreaterThan(bound=bound):
            distances = [bound]
        case tree.Between():
            distances = [condition.lower, condition.upper]
        case tree.Equals():
            distances = [condition.value, condition.tolerance]
    metres = [sink.literal(float(one.value.value) * LENGTHS[one.unit]) for one in distances]
    sink.add(node, "rbw:bounds-metres", sink.make_list(metres))
    _number(frame, node, "rbw:max-time-offset-seconds", rule.max_time_offset)


def _add_execution(frame: Frame, root: tree.Execution, position: int) -> None:
    node = frame.claimed(root.name.text, root.name)
    if node is None:
        return
    sink = frame.sink
    sink.add_types(node, ["bdd:ScenarioExecution"], frame.at(root.name))
    sink.add(node, "rbw:position", sink.literal(position))
    for term, reference in (
        ("bdd:of-variant", root.variant),
        ("rbw:scene-instance", root.scene),
        ("bdd:has-behaviour-implementation", root.behaviour),
    ):
        sink.add(node, term, frame.target(reference), frame.at(reference))
    _add_listed(frame, node, "obs:has-policy", "rbw:policy-list", root.policies)
    if root.repeat is not None:
        _say(frame, node, "rbw:repeat", root.repeat.value, root.repeat)
    if root.seed is not None:
        _say(frame, node, "rbw:seed", root.seed.value, root.seed)
    _number(frame, node, "rbw:timeout-seconds", root.timeout)
    if root.log is not None:
        sink.add(node, "rbw:log", frame.target(root.log), frame.at(root.log))


def _add_listed(frame: Frame, node: URIRef, term: str, list_term: str, references: Iterable[tree.Ref]) -> None:
    """Add the targets of references, and their written order."""
    found: list[URIRef] = []
    for reference in references:
        target = frame.target(reference)
        if target is not None:
            frame.sink.add(node, term, target, frame.at(reference))
            found.append(target)
    if found:
        frame.sink.add(node, list_term, frame.sink.make_list(found))
