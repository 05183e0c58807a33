"""Write Given, When and Then as triples: fluents, groups, quantifiers, behaviours."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.graph.rdf.vocabulary import (
    EVENT_LIST,
    FURTHER_BEHAVIOUR,
    HORIZON_VARIABLE,
    JUNCTIONS,
    OCCURRENCE,
    SOME_TIME,
    TIME_TYPES,
    TOGETHER,
)
from robbdd_tools.graph.write.behaviour_trees import link_behaviour
from robbdd_tools.graph.write.named_predicates import add_arguments, add_predicate, written_value
from robbdd_tools.graph.write.requirements import add_verified
from robbdd_tools.graph.write.sink import Frame, Sink
from robbdd_tools.graph.write.source_map import Location
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.when_paths import part_path, when_path

if TYPE_CHECKING:
    from rdflib import URIRef
    from rdflib.term import Node

    from robbdd_tools.graph.write.property_sets import PropertySets

MAX_NESTED = 100
"""Maximum nesting depth of parentheses. Deeper ones are left out to protect the stack."""


@dataclass(frozen=True, slots=True)
class ClauseWriter:
    """Writes the clauses of one owner, which is a template or a variant.

    ``namespace`` is the namespace of the owner, and ``owner`` is its qualified name (``story.variant``). ``scenario``
    is the node of the template's scenario, and ``first`` its first behaviour. A node without a name is named after its
    path, which consists of the kind, the owner and the steps to the node. They are joined by dots, because no written
    name contains a dot.
    """

    frame: Frame
    sets: PropertySets
    namespace: str
    owner: str
    scenario: str
    first: tree.BehaviourUse | None = None

    @property
    def _sink(self) -> Sink:
        return self.frame.sink

    def body(self, body: tree.Body, path: str = "") -> list[Node]:
        """Write Given, When or for all, and Then of each part. Return their clauses in order."""
        nodes: list[Node] = []
        for number, part in enumerate(body.parts):
            inner = part_path(path, number)
            nodes += self.top(part.given, "given", inner)
            if part.when is not None:
                nodes += self._when(part.when, inner)
            if part.for_all is not None:
                nodes += self._for_all(part.for_all, f"{inner}.all")
            nodes += self.top(part.then, "then", inner)
        return nodes

    def top(self, expression: tree.Expression | None, role: str, path: str = "") -> list[Node]:
        """Write the clauses of one role. The operands of an outermost *and* become separate entries of the list."""
        if expression is None:
            return []
        path = f"{path}.{role}"
        expression = tree.bare(expression)
        if isinstance(expression, tree.Conjunction):
            return self._each(expression.operands, role, path)
        return self._each([expression], role, path)

    def _when(self, when: tree.When, path: str) -> list[Node]:
        nodes: list[Node] = []
        together: Node | None = None
        for number, step in enumerate(when.steps):
            inner = when_path(path, number)
            nodes += self.occurrences(step.events, inner)
            written = self._behaviour(step.behaviour, inner)
            for node in written:
                if isinstance(step, tree.Further) and step.link == "meanwhile" and together is not None:
                    self._sink.add(node, TOGETHER, together, self.frame.at(step))
                together = node
            nodes += written
        return nodes

    def occurrences(self, events: Sequence[tree.Occurrence], path: str) -> list[Node]:
        """Write the clauses ``event <e> occurs``. ``path`` is the path of the part of the ``When``."""
        nodes: list[Node] = []
        for index, occurrence in enumerate(events):
            node = self._generated("when-evt", f"{path}.{index}")
            if node is not None:
                self._start(node, ["rbw:WhenEvent"], "when", self.frame.at(occurrence))
                event = self.frame.target(occurrence.event)
                self._sink.add(node, "rbw:event", event, self.frame.at(occurrence.event))
                nodes.append(node)
        return nodes

    def _each(self, expressions: Iterable[tree.Expression], role: str, path: str) -> list[Node]:
        if path.count(".") > MAX_NESTED:
            return []
        written = [
            self._clause(tree.bare(expression), role, f"{path}.{index}") for index, expression in enumerate(expressions)
        ]
        return [node for node in written if node is not None]

    def _clause(self, expression: tree.Expression, role: str, path: str) -> URIRef | None:
        match expression:
            case tree.Fluent():
                return self._fluent(expression, role)
            case tree.TextClause():
                return self._text(expression, role, path)
            case tree.Exists():
                return self._exists(expression, role, path)
            case tree.Negation():
                return self._junction(expression, "not", [expression.operand], role, path)
            case tree.Conjunction():
                return self._junction(expression, "and", expression.operands, role, path)
            case tree.Disjunction():
                return self._junction(expression, "or", expression.operands, role, path)

    def _fluent(self, fluent: tree.Fluent, role: str) -> URIRef | None:
        node = self.frame.claimed(f"{self.owner}.{fluent.name.text}", fluent.name)
        if node is None:
            return None
        self._start(node, ["bdd:FluentClause"], role, self.frame.at(fluent.name))
        if isinstance(fluent.predicate, tree.TextPredicate):
            self._text_predicate(node, fluent.predicate)
        else:
            add_predicate(self.frame, node, fluent.predicate, fluent.name)
        self._conditions(node, "rbw:whenever", f"whenever-{self.owner}.{fluent.name.text}", fluent.conditions)
        self._time(node, fluent.time)
        add_verified(self.frame, node, fluent.verifies)
        return node

    def events(self, template: URIRef, events: Sequence[tree.DefinedEvent]) -> None:
        """Write the events that a template defines."""
        nodes: list[Node] = []
        for event in events:
            node = self.frame.claimed(f"{self.owner}.{event.name.text}", event.name)
            if node is not None:
                at = self.frame.at(event.name)
                self._sink.add_types(node, ["time:Event", "rbw:DefinedEvent"], at)
                name = f"occurs-when-{self.owner}.{event.name.text}"
                self._conditions(node, "rbw:occurs-when", name, event.conditions)
                add_horizon(self.frame, node, event.seconds)
                nodes.append(node)
        if nodes:
            self._sink.add(template, EVENT_LIST, self._sink.make_list(nodes))

    def _conditions(
        self, owner: URIRef, term: str, name: str, conditions: Sequence[tree.PhraseUse | tree.NamedUse]
    ) -> None:
        """Write conditions as nodes of their owner. The first one is called ``name``; others also have a number."""
        for number, condition in enumerate(conditions):
            node = self._sink.iri(f"{self.namespace}{name}{f'.{number}' if number else ''}")
            if node is not None:
                self._sink.add_types(node, ["rbw:Condition"], self.frame.at(condition))
                add_predicate(self.frame, node, condition, condition)
                self._sink.add(owner, term, node, self.frame.at(condition))

    def _text_predicate(self, node: URIRef, predicate: tree.TextPredicate) -> None:
        sink, at = self._sink, self.frame.at
        sink.add_types(node, ["bdd:StringTemplatePredicate"], at(predicate))
        template = sink.literal(predicate.template.value)
        sink.add(node, "bdd:template-string", template, at(predicate.template))
        resolved = [(argument, written_value(self.frame, argument.value)) for argument in predicate.arguments]
        known = [(argument, target) for argument, target in resolved if target is not None]
        names = sink.make_list(sink.literal(argument.name.text) for argument, _ in known)
        sink.add(node, "bdd:argument-names", names, at(predicate))
        sink.add(node, "bdd:argument-variables", sink.make_list(target for _, target in known), at(predicate))
        for argument, target in known:
            sink.mark(node, "bdd:argument-names", sink.literal(argument.name.text), at(argument.name))
            sink.mark(node, "bdd:argument-variables", target, at(argument.value))

    def _text(self, clause: tree.TextClause, role: str, path: str) -> URIRef | None:
        node = self._generated("text", path)
        if node is not None:
            self._start(node, ["rbw:TextClause"], role, self.frame.at(clause.text))
            self._sink.add(node, "rbw:text", self._sink.literal(clause.text.value), self.frame.at(clause.text))
            self._time(node, clause.time)
            add_verified(self.frame, node, clause.verifies)
        return node

    def _junction(
        self, written: tree.Node, operator: str, operands: Iterable[tree.Expression], role: str, path: str
    ) -> URIRef | None:
        node = self._generated(operator, path)
        if node is not None:
            self._start(node, [JUNCTIONS[operator]], role, self.frame.at(written))
            self._sink.add(node, "rbw:operands", self._sink.make_list(self._each(operands, role, path)))
        return node

    def _exists(self, exists: tree.Exists, role: str, path: str) -> URIRef | None:
        node = self._generated("exists", path)
        if node is not None:
            self._start(node, ["bdd:ThereExists"], role, self.frame.at(exists.variable))
            self._quantified(node, exists)
            body = tree.bare(exists.body)
            operands = body.operands if isinstance(body, tree.Conjunction) else (body,)
            self._sink.add(node, "bdd:has-clause", self._sink.make_list(self._each(operands, role, path)))
        return node

    def _for_all(self, for_all: tree.ForAll, path: str) -> list[Node]:
        node = self._generated("forall", path)
        if node is None or path.count(".") > MAX_NESTED:
            return []
        self._start(node, ["bdd:ForAll"], "when", self.frame.at(for_all.variable))
        self._quantified(node, for_all)
        self._sink.add(node, "bdd:has-clause", self._sink.make_list(self.body(for_all.body, path)))
        return [node]

    def _quantified(self, node: URIRef, quantifier: tree.Exists | tree.ForAll) -> None:
        name, in_set = quantifier.variable, quantifier.in_set
        variable = self.frame.node(f"{self.owner}.{name.text}")
        if variable is not None:
            self._sink.add_types(variable, ["bdd:ScenarioVariable"], self.frame.at(name))
        self._sink.add(node, "bdd:ref-variable", variable, self.frame.at(name))
        self._sink.add(
            node, "bdd:in-set", self.sets.target(self.frame, in_set, quantifier.where), self.frame.at(in_set)
        )

    def _behaviour(self, use: tree.BehaviourUse, path: str) -> list[Node]:
        behaviour = self.frame.node(f"{self.owner}.{use.name.text}")
        node = self._generated("when-bhv", path)
        scenario = self._sink.iri(self.scenario)
        if behaviour is None or node is None or scenario is None:
            return []
        word = load_catalog().behaviours[use.action.word]
        if self._sink.claim_behaviour(behaviour, word.name, self.frame.at(use.name)):
            self._sink.add_types(behaviour, ["bhv:Behaviour", *word.rdf_types], self.frame.at(use.name))
        # The published vocabulary has one behaviour for each scenario.
        of_scenario = "bhv:of-behaviour" if use is self.first else FURTHER_BEHAVIOUR
        self._sink.add(scenario, of_scenario, behaviour, self.frame.at(use.name))
        link_behaviour(self.frame, behaviour, use)
        self._start(node, ["bdd:WhenBehaviour"], "when", self.frame.at(use.name))
        self._sink.add(node, "bhv:of-behaviour", behaviour, self.frame.at(use.name))
        add_arguments(self.frame, node, word.slots, use.action)
        if use.duration is not None:
            self._time(node, use.duration)
        self._emissions(node, use, path)
        return [node]

    def _emissions(self, node: URIRef, use: tree.BehaviourUse, path: str) -> None:
        """Write the mapping of a behaviour's own events to events of the model."""
        sink, at = self._sink, self.frame.at
        found: list[Node] = []
        for index, emission in enumerate(use.emissions):
            part, event = self._generated("emits", f"{path}.{index}"), self.frame.target(emission.event)
            if part is not None and event is not None:
                sink.add_types(part, ["rbw:Emission"], at(emission.moment))
                sink.add(part, "rbw:moment", sink.literal(emission.moment.text), at(emission.moment))
                sink.add(part, "rbw:event", event, at(emission.event))
                found.append(part)
        if found:
            sink.add(node, "rbw:emission-list", sink.make_list(found))

    def _time(self, node: URIRef, time: tree.TimeConstraint) -> None:
        add_time(self.frame, node, time)

    def _start(self, node: URIRef, types: Iterable[str], role: str, location: Location) -> None:
        self._sink.add_types(node, types, location)
        self._sink.add(node, "bdd:clause-of", self._sink.iri(f"{self.scenario}-{role}"))

    def _generated(self, kind: str, path: str) -> URIRef | None:
        return self._sink.iri(f"{self.namespace}{kind}-{self.owner}{path}")


def add_time(frame: Frame, node: URIRef, time: tree.TimeConstraint) -> None:
    """Add a time constraint to the node that it constrains."""
    kind = type(time).__name__.lower()
    sink = frame.sink
    some_time = [SOME_TIME] if time.some_time else []
    sink.add_types(node, ["time:TimeConstraint", TIME_TYPES[kind], *some_time], frame.at(time))
    if isinstance(time, tree.During):
        sink.add(node, "time:after-event", frame.target(time.start), frame.at(time.start))
        sink.add(node, "time:before-event", frame.target(time.end), frame.at(time.end))
        return
    sink.add(node, f"time:{kind}-event", frame.target(time.event), frame.at(time.event))
    if time.which:
        sink.add(node, OCCURRENCE, sink.literal(time.which), frame.at(time.event))
    add_horizon(frame, node, time.horizon)


def add_horizon(frame: Frame, node: URIRef, seconds: tree.Number | tree.Ref | None) -> None:
    """Add a number of seconds to a node, or the variable whose value it is."""
    sink = frame.sink
    if isinstance(seconds, tree.Ref):
        sink.add(node, HORIZON_VARIABLE, frame.target(seconds), frame.at(seconds))
    elif seconds is not None:
        sink.add(node, "time:horizon-seconds", sink.literal(float(seconds.value)), frame.at(seconds))
