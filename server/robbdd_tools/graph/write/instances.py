"""Write executable scenes as triples: distributions, placements of bodies, and models of the elements of a scene."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from robbdd_tools.graph.write.executions import add_python
from robbdd_tools.graph.write.kinematics import Trees, TreeWriter
from robbdd_tools.graph.write.rotations import NO_ROTATION, numbers_of, rotation_of
from robbdd_tools.graph.write.units import ANGLES, LENGTHS
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from rdflib import URIRef
    from rdflib.term import Node

    from robbdd_tools.graph.write.sink import Frame

Placed = list[tuple["tree.ChunkTree | None", "Frame"]]
"""Syntax trees of declarations, each with the frame for its triples."""


def add_instances(placed: Placed) -> None:
    """Write all declarations of executable scenes. Trees are written first, because names are resolved in them."""
    trees = Trees()
    templates = {root.name.text: root for root, _ in placed if isinstance(root, tree.KinematicTree)}
    for root, frame in placed:
        frame.begin()
        match root:
            case tree.KinematicTree():
                node = None if root.namespace is None else frame.claimed(root.name.text, root.name)
                trees.owners[root.name.text] = (node, root)
            case tree.TreeInstance():
                template = templates.get(root.template.path)
                if template is not None:
                    trees.owners[root.name.text] = (frame.claimed(root.name.text, root.name), template)
            case tree.SceneInstance():
                for entry in root.entries:
                    if isinstance(entry, tree.Graph):
                        path = f"{root.name.text}.{entry.name.text}"
                        trees.owners[path] = (frame.claimed(path, entry.name), entry)
            case _:
                pass
    for root, frame in placed:
        frame.begin()
        _add(frame, trees, root)


def _add(frame: Frame, trees: Trees, root: tree.ChunkTree | None) -> None:
    match root:
        case tree.Distribution():
            _add_distribution(frame, root)
        case tree.KinematicTree() | tree.TreeInstance():
            node, owner = trees.owners.get(root.name.text, (None, None))
            if node is not None and owner is not None:
                frame.sink.add_types(node, ["rbw:KinematicTree"], frame.at(root.name))
                template = owner.name.text if isinstance(root, tree.TreeInstance) else ""
                TreeWriter(frame, trees, owner, node, root.name.text, (), template).write()
        case tree.SceneInstance():
            _InstanceWriter(frame, trees, root).write()
        case _:
            pass


def _add_distribution(frame: Frame, root: tree.Distribution) -> None:
    node = frame.claimed(root.name.text, root.name)
    if node is None:
        return
    sink, law = frame.sink, root.law
    match law:
        case tree.UniformRotation():
            sink.add_types(node, ["rbw:UniformRotation"], frame.at(root.name))
            return
        case tree.Uniform():
            sink.add_types(node, ["rbw:UniformDistribution"], frame.at(root.name))
            numbers = {"rbw:lower": law.lower, "rbw:upper": law.upper}
        case tree.Normal():
            sink.add_types(node, ["rbw:NormalDistribution"], frame.at(root.name))
            spread = "rbw:covariance" if isinstance(law.spread, tree.Vector) else "rbw:standard-deviation"
            numbers = {"rbw:mean": law.mean, spread: law.spread}
    sink.add(node, "rbw:dimension", sink.literal(law.dimension.value), frame.at(law.dimension))
    for term, value in numbers.items():
        found = numbers_of(value) if isinstance(value, tree.Vector) else (float(value.value),)
        sink.add(node, term, sink.make_list([sink.literal(number) for number in found]), frame.at(value))


class _InstanceWriter:
    """Writes one scene instance."""

    def __init__(self, frame: Frame, trees: Trees, root: tree.SceneInstance) -> None:
        self._frame = frame
        self._sink = frame.sink
        self._trees = trees
        self._root = root
        self._elements: list[URIRef | None] = []

    def write(self) -> None:
        root, sink, frame = self._root, self._sink, self._frame
        node = frame.claimed(root.name.text, root.name)
        if node is None:
            return
        sink.add_types(node, ["rbw:SceneInstance"], frame.at(root.name))
        sink.add(node, "rbw:scene", frame.target(root.scene), frame.at(root.scene))
        graphs: list[URIRef | None] = []
        frictions: list[URIRef | None] = []
        for entry in root.entries:
            if isinstance(entry, tree.Graph):
                graphs.append(self._graph(entry))
            elif isinstance(entry, tree.PairFriction):
                frictions.append(self._friction(sink.iri(f"{node}.friction{len(frictions)}"), entry))
            elif isinstance(entry, tree.Modelled):
                self._element(node, entry)
        sink.add(node, "rbw:graphs", sink.make_list(graphs))
        sink.add(node, "rbw:models", sink.make_list(self._models(node, root.entries)))
        sink.add(node, "rbw:realisations", sink.make_list(self._elements))
        if frictions:
            sink.add(node, "rbw:frictions", sink.make_list(frictions))

    def _graph(self, graph: tree.Graph) -> URIRef | None:
        path = f"{self._root.name.text}.{graph.name.text}"
        node, _ = self._trees.owners[path]
        if node is not None:
            self._sink.add_types(node, ["rbw:KinematicGraph"], self._frame.at(graph.name))
            TreeWriter(self._frame, self._trees, graph, node, path, (self._root.name.text,)).write()
        return node

    def _friction(self, node: URIRef | None, pair: tree.PairFriction) -> URIRef | None:
        sink, frame = self._sink, self._frame
        if node is not None:
            sink.add_types(node, ["rbw:PairFriction"], frame.at(pair))
            for term, reference in (("rbw:first", pair.first), ("rbw:second", pair.second)):
                sink.add(node, term, frame.target(reference), frame.at(reference))
            sink.add(node, "rbw:coefficient", sink.literal(float(pair.value.value)), frame.at(pair.value))
        return node

    def _element(self, instance: URIRef, modelled: tree.Modelled) -> None:
        """Write the models of an element or of each element of a set.

        Sets inside a set are written after it, so that their models replace the models of the outer set.
        """
        sink, place = self._sink, self._frame.at(modelled.reference)
        target = self._frame.target(modelled.reference)
        node = sink.iri(f"{instance}.{len(self._elements)}")
        if target is None or node is None:
            return
        self._elements.append(node)
        sink.add_types(node, ["rbw:Realisation"], place)
        sink.add(node, "rbw:realises", target, place)
        sink.add(node, "rbw:models", sink.make_list(self._models(instance, modelled.entries)))
        sensors = [self._sensor(instance, entry) for entry in modelled.entries]
        sink.add(node, "rbw:sensors", sink.make_list(sensors))
        boxes = [entry for entry in modelled.entries if isinstance(entry, tree.WorkspaceBox)]
        if boxes:
            written = [self._box(sink.iri(f"{node}.box{number}"), box) for number, box in enumerate(boxes)]
            sink.add(node, "rbw:boxes", sink.make_list(written))
        for entry in modelled.entries:
            if isinstance(entry, tree.Modelled):
                self._element(instance, entry)

    def _box(self, node: URIRef | None, box: tree.WorkspaceBox) -> URIRef | None:
        sink, frame = self._sink, self._frame
        if node is None:
            return None
        sink.add_types(node, ["rbw:WorkspaceBox"], frame.at(box))
        self._lengths(node, "rbw:edges", box.size, box.size_unit)
        self._offset(node, box)
        return node

    def _offset(self, node: URIRef, part: tree.WorkspaceBox | tree.Gripper) -> None:
        """Write where a part is in the frame of another one; ``NO_ROTATION`` if its orientation is none."""
        sink = self._sink
        self._lengths(node, "rbw:position", part.offset, part.offset_unit)
        if part.orientation is not None:
            value = part.orientation.value
            turn = (None if isinstance(value, tree.Sample) else rotation_of(value)) or NO_ROTATION
            sink.add(node, "rbw:orientation", sink.make_list(map(sink.literal, turn)), self._frame.at(value))

    def _lengths(self, node: URIRef, term: str, vector: tree.Vector | None, unit: str | None) -> None:
        if vector is not None:
            metres = [self._sink.literal(number * LENGTHS[unit or "m"]) for number in numbers_of(vector)]
            self._sink.add(node, term, self._sink.make_list(metres), self._frame.at(vector))

    def _models(self, instance: URIRef, entries: Iterable[tree.Node]) -> list[URIRef | None]:
        return [self._model(instance, entry) for entry in entries if isinstance(entry, tree.Model)]

    def _model(self, instance: URIRef, model: tree.Model) -> URIRef | None:
        sink, frame = self._sink, self._frame
        node = sink.iri(f"{instance}.{model.name.text}")
        if node is None:
            return None
        sink.add_types(node, ["rbw:Model"], frame.at(model.name))
        sink.add(node, "rbw:format", sink.literal(model.kind))
        self._source(node, model.source)
        mappings = [self._mapping(node, number, one) for number, one in enumerate(model.mappings)]
        sink.add(node, "rbw:mappings", sink.make_list(mappings))
        self._arm(node, model)
        return node

    def _source(self, node: URIRef, source: tree.ModelSource) -> None:
        sink, frame = self._sink, self._frame
        match source:
            case tree.SystemPath(path=path):
                sink.add(node, "rbw:path", sink.literal(path.value), frame.at(path))
            case tree.RosPath(package=package, path=path):
                sink.add(node, "rbw:ros-package", sink.literal(package.value), frame.at(package))
                sink.add(node, "rbw:path", sink.literal(path.value), frame.at(path))
            case tree.CatalogEntry(name=name):
                sink.add(node, "rbw:catalog-name", sink.literal(name.value), frame.at(name))
            case tree.PythonAttribute():
                add_python(frame, node, source)

    def _mapping(self, model: URIRef, number: int, mapping: tree.Mapping) -> URIRef | None:
        sink = self._sink
        node = sink.iri(f"{model}.{number}")
        if node is not None:
            target = self._named(mapping.reference)
            sink.add(node, "rbw:stands-for", target, self._frame.at(mapping.reference))
            # By default, the body or tree has the same name in the file.
            where = mapping.target or mapping.reference
            name = mapping.reference.path.rpartition(".")[2] if mapping.target is None else mapping.target.value
            sink.add(node, "rbw:name", sink.literal(name), self._frame.at(where))
            sink.mark_node(node, self._frame.at(where))
        return node

    def _arm(self, node: URIRef, model: tree.Model) -> None:
        """Write the data about an arm that replace the data in its file."""
        sink, frame, gripper = self._sink, self._frame, model.gripper
        if model.tool is not None:
            sink.add(node, "rbw:tool", sink.literal(model.tool.value), frame.at(model.tool))
        if gripper is not None:
            self._gripper(node, gripper)
        if model.opening is not None:
            self._opening(node, model.opening)
        for term, vector, unit in (
            ("home", model.home, model.home_unit),
            ("velocity-limits", model.velocity, model.velocity_unit),
        ):
            if vector is not None:
                factor = ANGLES[(unit or "rad").partition("/")[0]]
                numbers: list[Node | None] = [sink.literal(number * factor) for number in numbers_of(vector)]
                sink.add(node, f"rbw:{term}", sink.make_list(numbers), frame.at(vector))

    def _gripper(self, node: URIRef, gripper: tree.Gripper) -> None:
        sink, frame = self._sink, self._frame
        self._mounted_gripper(node, gripper)
        if gripper.actuator is not None:
            name = sink.literal(gripper.actuator.value)
            sink.add(node, "rbw:gripper-actuator", name, frame.at(gripper.actuator))
        for term, number in (("gripper-open", gripper.open), ("gripper-closed", gripper.close)):
            if number is not None:
                sink.add(node, f"rbw:{term}", sink.literal(float(number.value)), frame.at(number))
        if gripper.stroke is not None:
            stroke = float(gripper.stroke.value) * LENGTHS[gripper.stroke_unit or "m"]
            sink.add(node, "rbw:stroke-metres", sink.literal(stroke), frame.at(gripper.stroke))
        if gripper.pads:
            pads = sink.make_list([sink.literal(pad.value) for pad in gripper.pads])
            sink.add(node, "rbw:gripper-pads", pads, frame.at(gripper))

    def _mounted_gripper(self, arm: URIRef, gripper: tree.Gripper) -> None:
        """Write the file of a gripper that has one of its own, and where it is fixed to the arm."""
        sink, frame = self._sink, self._frame
        node = sink.iri(f"{arm}.gripper")
        if gripper.source is None or gripper.mount is None or node is None:
            return
        sink.add_types(node, ["rbw:MountedGripper"], frame.at(gripper))
        self._source(node, gripper.source)
        sink.add(node, "rbw:mount", sink.literal(gripper.mount.value), frame.at(gripper.mount))
        self._offset(node, gripper)
        sink.add(arm, "rbw:mounted-gripper", node, frame.at(gripper))

    def _opening(self, node: URIRef, opening: tree.Opening) -> None:
        sink, frame = self._sink, self._frame
        if opening.joint is not None:
            sink.add(node, "rbw:opening-joint", sink.literal(opening.joint.value), frame.at(opening.joint))
        ends = (("closed", opening.closed, opening.closed_unit), ("open", opening.open, opening.open_unit))
        for end, number, unit in ends:
            if number is not None:
                sink.add(node, f"rbw:opening-{end}", sink.quantity(f"{number.value:g} {unit}"), frame.at(number))

    def _sensor(self, instance: URIRef, sensor: tree.Node) -> URIRef | None:
        sink, frame = self._sink, self._frame
        if not isinstance(sensor, tree.Camera | tree.Sensor):
            return None
        node = sink.iri(f"{instance}.{sensor.name.text}")
        if node is None:
            return None
        kind = "camera" if isinstance(sensor, tree.Camera) else sensor.kind
        sink.add_types(node, ["rbw:Sensor"], frame.at(sensor.name))
        sink.add(node, "rbw:sensor-kind", sink.literal(kind))
        sink.add(node, "rbw:at-frame", self._named(sensor.frame), frame.at(sensor.frame))
        sink.add(node, "rbw:rate-hertz", sink.literal(float(sensor.rate.value)), frame.at(sensor.rate))
        if isinstance(sensor, tree.Camera):
            pixels = [sink.literal(number) for number in numbers_of(sensor.resolution)]
            sink.add(node, "rbw:resolution-pixels", sink.make_list(pixels))
            sink.add(node, "rbw:camera-type", sink.literal(sensor.type))
            angle = float(sensor.fov.value) * ANGLES[sensor.fov_unit]
            sink.add(node, "rbw:field-of-view-radians", sink.literal(angle))
        else:
            sink.add(node, "rbw:quantities", sink.make_list([sink.literal(word) for word in sensor.observes]))
        return node

    def _named(self, reference: tree.Ref) -> URIRef | None:
        return self._sink.iri(self._trees.node(reference.path, (self._root.name.text,)))
