"""Write user stories, variants and their variations as triples."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.graph.rdf.vocabulary import ELEMENT_TYPES, MEMBERSHIPS, SELECTIONS
from robbdd_tools.graph.write.clauses import ClauseWriter
from robbdd_tools.graph.write.requirements import add_verified
from robbdd_tools.graph.write.scenes import Memberships, Scenes
from robbdd_tools.graph.write.sink import Frame, Sink, namespace_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.when_paths import when_path

if TYPE_CHECKING:
    from rdflib import URIRef
    from rdflib.term import Node

    from robbdd_tools.graph.write.declarations import Reached
    from robbdd_tools.graph.write.property_sets import PropertySets


@dataclass(frozen=True, slots=True)
class Known:
    """Data that stories need: the scenes, the memberships in scenes, and the task of each template."""

    scenes: Scenes
    memberships: Memberships
    tasks: Mapping[URIRef, URIRef]


@dataclass(frozen=True, slots=True)
class _Place:
    """The identity of a variant: its story's namespace, its qualified name, its own name and its node."""

    namespace: str
    owner: str
    node: URIRef


def add_story(sink: Sink, known: Known, parts: Sequence[Reached], position: int) -> None:
    """Add a user story, or some parts of one. ``position`` is its index among all stories of the graph."""
    first = parts[0]
    frame = Frame(sink, first.file, first.placed if first.story is None else first.story)
    frame.begin()
    story = frame.tree
    node = frame.claimed(story.name.text, story.name) if isinstance(story, tree.Story) else None
    if node is None or not isinstance(story, tree.Story):
        return
    sink.add_types(node, ["bdd:UserStory"], frame.at(story.name))
    for term, text in (("role", story.role), ("feature", story.feature), ("benefit", story.benefit)):
        if text is not None:
            sink.add(node, f"rbw:{term}", sink.literal(text.value), frame.at(text))
    add_verified(frame, node, story.verifies)
    sink.add(node, "rbw:position", sink.literal(position))
    namespace = namespace_of(node, story.name.text)
    variants: list[URIRef] = []
    for inner, variant in _variants(frame, story, parts):
        owner = f"{story.name.text}.{variant.name.text}"
        criterion = inner.claimed(owner, variant.name)
        if criterion is not None:
            frame.begin()
            sink.add(node, "bdd:has-criteria", criterion, inner.at(variant.name))
            inner.begin()
            _add_variant(inner, known, variant, _Place(namespace, owner, criterion))
            variants.append(criterion)
    frame.begin()
    sink.add(node, "rbw:criteria-list", sink.make_list(variants))


def _variants(frame: Frame, story: tree.Story, parts: Sequence[Reached]) -> Iterator[tuple[Frame, tree.Variant]]:
    """Yield the scenarios in some parts of a story, or in the whole story, each with its frame."""
    if parts[0].story is None:
        yield from ((frame, variant) for variant in story.variants)
    for part in parts:
        if part.story is not None and isinstance(part.tree, tree.Variant):
            yield Frame(frame.sink, part.file, part.placed), part.tree


def _add_variant(frame: Frame, known: Known, variant: tree.Variant, place: _Place) -> None:
    sink, node = frame.sink, place.node
    template = frame.target(variant.template)
    sink.add_types(node, ["bdd:ScenarioVariant"], frame.at(variant.name))
    sink.add(node, "bdd:of-template", template, frame.at(variant.template))
    add_verified(frame, node, variant.verifies)
    if template is not None:
        writer = ClauseWriter(frame, known.scenes.selected, place.namespace, place.owner, f"{template}-scenario")
        clauses = writer.top(variant.given, "given") + writer.occurrences(variant.events, when_path("", 0))
        clauses += writer.top(variant.then, "then")
        sink.add(node, "bdd:has-clause", sink.make_list(clauses))
    _add_membership(frame, known, variant, node, template)
    _add_variation(frame, known, variant.variation, place, template)


def _add_membership(frame: Frame, known: Known, variant: tree.Variant, node: URIRef, template: URIRef | None) -> None:
    scene = frame.target(variant.scene)
    sink = frame.sink
    sink.add(node, "rbw:scene", scene, frame.at(variant.scene))
    template_scene = None if template is None else sink.iri(f"{template}-scene")
    if scene is None or template_scene is None:
        return
    own = known.scenes.members(scene)
    brought = known.scenes.named_set_members(frame, variant.variation)
    for kind in ELEMENT_TYPES:
        if own[kind]:
            members = tuple(dict.fromkeys([*own[kind], *brought[kind]]))
            membership = known.memberships.node(scene, kind, template_scene, members)
            sink.add(node, "bdd:has-scene", membership, frame.at(variant.scene))
        else:
            _add_loose_members(sink, scene, kind, brought[kind])


def _add_loose_members(sink: Sink, scene: URIRef, kind: str, members: tuple[URIRef, ...]) -> None:
    """Add the elements in a variation as members of the scene, if the scene has no members of their kind.

    They are added in the published form.
    """
    _, term, ending = MEMBERSHIPS[kind]
    node = sink.iri(scene + ending)
    if node is not None:
        for member in members:
            sink.add(node, term, member)


def _add_variation(
    frame: Frame, known: Known, variation: tree.Table | tree.Product, place: _Place, template: URIRef | None
) -> None:
    sink = frame.sink
    is_table = isinstance(variation, tree.Table)
    node = sink.iri(f"{place.namespace}{'tv-table' if is_table else 'tv-cart_prod'}-{place.owner}")
    if node is None:
        return
    kind = "bdd:TableVariation" if is_table else "bdd:CartesianProductVariation"
    sink.add_types(node, ["bdd:TaskVariation", kind], frame.at(variation))
    sink.add(place.node, "bdd:has-variation", node, frame.at(variation))
    if template is not None:
        sink.add(node, "task:of-task", known.tasks.get(template))
    writer = _VariationWriter(frame, known.scenes.selected, place, node)
    if isinstance(variation, tree.Table):
        writer.table(variation)
    else:
        writer.product(variation)


@dataclass(frozen=True, slots=True)
class _VariationWriter:
    frame: Frame
    sets: PropertySets
    place: _Place
    node: URIRef

    def table(self, table: tree.Table) -> None:
        sink = self.frame.sink
        variables = self._variables(table.header)
        rows: list[Node] = []
        for row in table.rows:
            cells = [self._choice(cell) for cell in row.cells]
            for variable, cell, written in zip(variables, cells, row.cells, strict=False):
                self._mark(variable, written, cell)
            head = sink.make_list(cells)
            rows.append(head)
            sink.mark_node(head, self.frame.at(row))
        sink.add(self.node, "bdd:rows", sink.make_list(rows), self.frame.at(table))

    def product(self, product: tree.Product) -> None:
        sink = self.frame.sink
        variables = self._variables([assignment.variable for assignment in product.assignments])
        entries: list[Node | None] = []
        for index, (variable, assignment) in enumerate(zip(variables, product.assignments, strict=True)):
            choices = assignment.choices
            if isinstance(choices, tree.Selection):
                entry = self._selection(choices, index)
            elif isinstance(choices, tree.SetList):
                entry = sink.make_list(self._values(variable, values) for values in choices.sets)
            else:
                entry = self._choice(choices)
            self._mark(variable, choices, entry)
            entries.append(entry)
        sink.add(self.node, "bdd:of-sets", sink.make_list(entries), self.frame.at(product))

    def _variables(self, refs: tuple[tree.Ref, ...] | list[tree.Ref]) -> list[URIRef | None]:
        sink = self.frame.sink
        targets = [self.frame.target(ref) for ref in refs]
        sink.add(self.node, "bdd:variable-list", sink.make_list(targets))
        for ref, target in zip(refs, targets, strict=True):
            if target is not None:
                sink.mark(self.node, "bdd:variable-list", target, self.frame.at(ref))
        return targets

    def _choice(self, piece: tree.Value | tree.SetExpression) -> Node | None:
        match piece:
            case tree.Link():
                return self.sets.target(self.frame, piece.reference, piece.where)
            case tree.ValueList():
                return self.frame.sink.make_list(self._value(value) for value in piece.values)
            case _:
                return self._value(piece)

    def _values(self, variable: URIRef | None, values: tree.ValueList) -> Node | None:
        entry = self._choice(values)
        self._mark(variable, values, entry)
        return entry

    def _value(self, value: tree.Value) -> Node | None:
        if isinstance(value, tree.Ref):
            return self.frame.target(value)
        return self.frame.sink.value(value)

    def _mark(self, variable: URIRef | None, written: tree.Node, node: Node | None) -> None:
        """Record the positions of a variable's value and, if it is a list, of each value in the list."""
        if variable is None or node is None:
            return
        sink = self.frame.sink
        place = written.reference if isinstance(written, tree.Link) else written
        sink.mark_choice(self.node, variable, node, self.frame.at(place))
        for value in written.values if isinstance(written, tree.ValueList) else ():
            element = self._value(value)
            if element is not None:
                sink.mark_choice(self.node, variable, element, self.frame.at(value))

    def _selection(self, selection: tree.Selection, index: int) -> URIRef | None:
        sink = self.frame.sink
        kind = "comb" if selection.kind == "combinations" else "perm"
        node = sink.iri(f"{self.place.namespace}{kind}-{self.place.owner}.{index}")
        if node is None:
            return None
        count = selection.count.value
        datatype = "xsd:positiveInteger" if isinstance(count, int) and count > 0 else None
        sink.add_types(node, [SELECTIONS[selection.kind]], self.frame.at(selection))
        source = self.sets.target(self.frame, selection.source, selection.where)
        sink.add(node, "bdd:from", source, self.frame.at(selection.source))
        sink.add(node, "bdd:length", sink.literal(count, datatype), self.frame.at(selection.count))
        # The published vocabulary has this property only on combinations.
        if kind == "comb" or selection.repeated:
            sink.add(node, "bdd:repetition-allowed", sink.literal(selection.repeated), self.frame.at(selection))
        return node
