"""The structure of a graph, as needed to draw it.

It consists of stories, variants, templates, clauses, events and nodes of behaviour trees.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import chain

from robbdd_tools.graph.acceptance_model import Iri
from robbdd_tools.graph.rdf.records import Records, items_of
from robbdd_tools.graph.rdf.vocabulary import COMPOSITES, HORIZON_VARIABLE, OCCURRENCE, SOME_TIME
from robbdd_tools.graph.read.variable_roles import words_of
from robbdd_tools.graph.write.built import BuiltGraph
from robbdd_tools.graph.write.source_map import Location
from robbdd_tools.protocol.time_words import occurrence_words

JOINED = {
    "rbw:Conjunction": "all of",
    "rbw:Disjunction": "at least one of",
    "rbw:Negation": "not",
    "bdd:ForAll": "for all",
    "bdd:ThereExists": "there is",
}
"""Class of a nested clause → the clause's label in a picture."""


@dataclass(frozen=True, slots=True)
class Node:
    """A node to draw.

    - ``concept``: ``story``, ``variant``, ``template``, ``given``, ``when``, ``then``, ``event``, or ``node`` for a
      node of a behaviour tree.
    - ``depth``: the number of groups and quantifiers around a clause, or of composites above a node of a behaviour
      tree.
    - ``location``: the source range of the node.
    """

    iri: str
    concept: str
    name: str
    lines: tuple[str, ...] = ()
    depth: int = 0
    location: Location | None = None


@dataclass(slots=True)
class Structure:
    """The nodes to draw, layer by layer, and the links between them.

    Nodes are in drawing order. A link consists of its start, its end and its meaning.
    """

    stories: list[Node] = field(default_factory=list[Node])
    variants: list[Node] = field(default_factory=list[Node])
    templates: list[Node] = field(default_factory=list[Node])
    clauses: list[Node] = field(default_factory=list[Node])
    events: list[Node] = field(default_factory=list[Node])
    tree_nodes: list[Node] = field(default_factory=list[Node])
    links: list[tuple[str, str, str]] = field(default_factory=list[tuple[str, str, str]])

    def nodes(self) -> Iterator[Node]:
        """Yield all nodes, layer by layer."""
        return chain(self.stories, self.variants, self.templates, self.clauses, self.events, self.tree_nodes)


def structure_of(built: BuiltGraph) -> Structure:
    """Return the structure of a graph; unused nodes come last."""
    return _Reader(built, Records(built.graph)).read()


@dataclass(slots=True)
class _Reader:
    built: BuiltGraph
    records: Records
    found: Structure = field(default_factory=Structure)
    _seen: set[str] = field(default_factory=set[str])

    def read(self) -> Structure:
        records, found = self.records, self.found
        stories = sorted(records.instances("bdd:UserStory"), key=lambda story: (self._position(story), story))
        for story in stories:
            found.stories.append(self._node(story, "story", self._said(story)))
            for variant in records.iris(records.ordered(story, "bdd:has-criteria", "rbw:criteria-list")):
                self._variant(story, variant)
        for template in records.instances("bdd:ScenarioTemplate"):
            self._template(template)
        for event in records.instances("time:Event"):
            self._event(event)
        for tree in records.instances("bt:BehaviourTree"):
            self._tree(tree)
        return found

    def _tree(self, tree: Iri) -> None:
        above: dict[Iri, int] = {}
        for node in self.records.iris(items_of(self.records, tree, "rbw:node-list")):
            if node in self._seen:
                continue
            self._seen.add(node)
            depth = above.get(node, 0)
            kinds = tuple(kind for kind, class_ in COMPOSITES.items() if self.records.is_a(node, class_))
            self.found.tree_nodes.append(self._node(node, "node", kinds, depth))
            for child in self.records.iris(items_of(self.records, node, "bt:children")):
                above[child] = depth + 1
                self.found.links.append((node, child, ""))

    def _position(self, story: Iri) -> int:
        value = self.records.literal(story, "rbw:position")
        return value if isinstance(value, int) else 0

    def _said(self, story: Iri) -> tuple[str, ...]:
        parts = (("As a", "rbw:role"), ("I want", "rbw:feature"), ("So that", "rbw:benefit"))
        texts = ((word, self.records.text(story, term)) for word, term in parts)
        return tuple(f"{word} {text}" for word, text in texts if text)

    def _variant(self, story: Iri, variant: Iri) -> None:
        records, found = self.records, self.found
        found.links.append((story, variant, ""))
        if variant in self._seen:
            return
        self._seen.add(variant)
        scenes = tuple(f"scene {self._name(scene)}" for scene in records.iris(records.all(variant, "rbw:scene")))
        found.variants.append(self._node(variant, "variant", scenes))
        for template in records.iris(records.all(variant, "bdd:of-template")):
            found.links.append((variant, template, ""))
            self._template(template)
        self._clauses(variant, variant, 0)

    def _template(self, template: Iri) -> None:
        if template in self._seen:
            return
        self._seen.add(template)
        self.found.templates.append(self._node(template, "template", self._time(template)))
        self._clauses(template, template, 0)
        self._timed(template, "duration")

    def _clauses(self, owner: Iri, above: Iri, depth: int) -> None:
        records = self.records
        for term in ("bdd:has-clause", "rbw:operands"):
            for clause in records.iris(items_of(records, owner, term)):
                self.found.links.append((above, clause, ""))
                if clause in self._seen:
                    continue
                self._seen.add(clause)
                lines = (*self._sentence(clause), *self._time(clause))
                self.found.clauses.append(self._node(clause, self._role(clause), lines, depth))
                self._timed(clause, "time")
                for behaviour in records.iris(records.all(clause, "bhv:of-behaviour")):
                    nodes = records.iris(records.all(behaviour, "rbw:coordination-node"))
                    self.found.links += [(clause, node, "") for node in nodes]
                self._clauses(clause, clause, depth + 1)

    def _role(self, clause: Iri) -> str:
        roles = self.records.iris(self.records.all(clause, "bdd:clause-of"))
        kinds = {kind.rpartition("#")[2].lower() for role in roles for kind in self.records.types(role)}
        return next((role for role in ("given", "when", "then") if role in kinds), "then")

    def _sentence(self, clause: Iri) -> tuple[str, ...]:
        records = self.records
        for word in words_of(records, clause):
            slots = {slot.name: slot.property for slot in word.slots}
            parts = re.split(r"[<$]([\w-]+)>?", word.phrase)
            filled = [self._names(clause, slots[part]) if number % 2 else part for number, part in enumerate(parts)]
            return ("".join(filled),)
        for term in ("bdd:template-string", "rbw:text"):
            if text := records.text(clause, term):
                return (f"“{text}”",)
        kind = next((words for kind, words in JOINED.items() if records.is_a(clause, kind)), "")
        variable, set_ = self._names(clause, "bdd:ref-variable"), self._names(clause, "bdd:in-set")
        if kind:
            return (f"{kind} {variable} in {set_}" if variable else kind,)
        return tuple(f"{self._name(event)} occurs" for event in records.iris(records.all(clause, "rbw:event")))

    def _names(self, node: Iri, term: str) -> str:
        return ", ".join(self._name(str(value)) for value in self.records.all(node, term))

    def _time(self, node: Iri) -> tuple[str, ...]:
        records = self.records
        before, after = (records.iris(records.all(node, f"time:{kind}-event")) for kind in ("before", "after"))
        horizon = records.text(node, "time:horizon-seconds")
        horizon = horizon or self._names(node, HORIZON_VARIABLE)
        lead = "within" if records.is_a(node, SOME_TIME) else "for"
        span = f"{lead} {horizon} s " if horizon else ""
        if before and after:
            return (f"from {self._name(after[0])} until {self._name(before[0])}",)
        return tuple(
            f"{span}{word} {occurrence_words(records.text(node, OCCURRENCE))}{self._name(event)}"
            for word, events in (("before", before), ("after", after))
            for event in events
        )

    def _timed(self, node: Iri, meaning: str) -> None:
        for term in ("time:after-event", "time:before-event", "rbw:event"):
            for event in self.records.iris(self.records.all(node, term)):
                self._event(event)
                self.found.links.append((node, event, meaning))

    def _event(self, event: Iri) -> None:
        if event not in self._seen:
            self._seen.add(event)
            self.found.events.append(self._node(event, "event"))

    def _node(self, iri: Iri, concept: str, lines: tuple[str, ...] = (), depth: int = 0) -> Node:
        generated = iri not in self.built.names and concept in ("given", "when", "then")
        return Node(
            iri, concept, "" if generated and lines else self._name(iri), lines, depth, self.built.sources.node(iri)
        )

    def _name(self, iri: str) -> str:
        path = self.built.names.get(iri)
        if path is not None:
            return re.split(r"[.:]", path)[-1]
        return re.split(r"[/#]", iri)[-1].removeprefix("var-")
