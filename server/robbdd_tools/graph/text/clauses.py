"""Write templates and clauses of a graph as RobBDD text."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from robbdd_tools.base.quantity_units import is_quantity
from robbdd_tools.catalog.api import Behaviour, Kind, Predicate, Slot
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.graph.acceptance_model import (
    BehaviourClause,
    Clause,
    Condition,
    DefinedEvent,
    EventClause,
    Exists,
    Fluent,
    ForAll,
    Iri,
    Junction,
    TextClause,
    TextFluent,
)
from robbdd_tools.graph.clause_parts import count_of_parts, part_numbers
from robbdd_tools.graph.rdf.records import Incomplete, items_of
from robbdd_tools.graph.rdf.vocabulary import STATES
from robbdd_tools.graph.read.clauses import ClauseReader
from robbdd_tools.graph.text.named_predicates import named_phrase
from robbdd_tools.graph.text.names import NAME, Names, indented, quoted
from robbdd_tools.graph.text.property_text import set_reference
from robbdd_tools.graph.text.requirements import verified
from robbdd_tools.monitor.time import Before, During, TimeConstraint
from robbdd_tools.protocol.time_words import occurrence_words
from robbdd_tools.syntax.when_paths import part_path, when_path

_SLOT = re.compile(r"<(\w+)>|[$#](\w+)")


@dataclass(slots=True)
class ClauseText:
    """Writes the clauses of one owner, which is a template or a variant. ``owner`` is its qualified name.

    ``variables`` maps the available variables to their references. ``bound`` maps the variables of quantifiers to their
    names. A node without a name in the text gets an IRI from its path, as in a graph that is built from the text.
    """

    names: Names
    owner: str
    namespace: str
    variables: dict[str, str] = field(default_factory=dict[str, str])
    bound: dict[str, str] = field(default_factory=dict[str, str])

    def body(self, clauses: Sequence[Clause], path: str = "") -> str:
        """Return the text of a body. Raises ``Incomplete`` if it has no When, or a Given clause after the last one."""
        numbers = part_numbers(clauses)
        count = count_of_parts(clauses, numbers)
        if not count:
            raise Incomplete("it has neither a When with a behaviour nor a 'for all'")
        if count == 1:
            return self._part(clauses, path)
        if max(numbers) >= count:
            raise Incomplete("it has a Given clause after its last When")
        parts = ([c for c, own in zip(clauses, numbers, strict=True) if own == number] for number in range(count))
        return "".join(self._part(part, part_path(path, number)) for number, part in enumerate(parts))

    def _part(self, clauses: Sequence[Clause], path: str) -> str:
        loop = next((clause for clause in clauses if isinstance(clause, ForAll)), None)
        given = self.conditions(clauses, "given", path)
        if loop is not None:
            middle = self._for_all(loop, f"{path}.all")
        else:
            parts = enumerate(_when_parts(clauses))
            inner = [line for number, part in parts for line in self._when_part(part, number, path)]
            middle = "When:\n" + indented("\n".join(inner))
        return "".join(f"{text}\n" for text in (given, middle, self.conditions(clauses, "then", path)) if text)

    def conditions(self, clauses: Iterable[Clause], role: str, path: str = "") -> str:
        """Return ``Given: …`` or ``Then: …``, or an empty text if the role has no clause."""
        silent = (ForAll, BehaviourClause, EventClause)
        chosen = [clause for clause in clauses if not isinstance(clause, silent) and clause.role == role]
        while len(chosen) == 1 and isinstance(chosen[0], Junction) and chosen[0].operator == "and":
            chosen = list(chosen[0].operands)
        if not chosen:
            return ""
        return f"{role.capitalize()}:\n{indented(self._joined('and', self._each(chosen, f'{path}.{role}')))}"

    def _when_part(self, part: _WhenPart, number: int, path: str) -> list[str]:
        inner = when_path(path, number)
        lines = [*self.events(part.events, inner), self._behaviour(part.behaviour, inner)]
        if number:
            lines[0] = f"{'then' if part.behaviour.together is None else 'meanwhile'} {lines[0]}"
        return lines

    def events(self, events: Iterable[EventClause], path: str) -> list[str]:
        """Return the text ``event <e> occurs`` for each event in the part of a When that has the path ``path``."""
        lines: list[str] = []
        for index, clause in enumerate(events):
            self._named(clause.iri, "when-evt", f"{path}.{index}")
            lines.append(f"event {self.names.lazily(clause.event, 'event')} occurs")
        return lines

    def time(self, time: TimeConstraint, variable: Iri | None = None) -> str:
        """Return a time constraint as text. ``variable`` is the variable of its horizon, if any."""
        if isinstance(time, During):
            lead = "at some time " if time.some_time else ""
            return f"{lead}from {self._event(time.start)} until {self._event(time.end)}"
        seconds = "" if time.horizon is None else str(time.horizon).removesuffix(".0")
        seconds = seconds if variable is None else self._variable(variable)
        horizon = f"{seconds} seconds " if seconds else ""
        horizon = f"within {horizon}" if horizon and time.some_time else horizon
        relation = "before" if isinstance(time, Before) else "after"
        return f"{horizon}{relation} {occurrence_words(time.which)}{self._event(time.event)}"

    def _event(self, event: str) -> str:
        return self.names.lazily(event, "event")

    def _each(self, clauses: Iterable[Clause], path: str) -> list[str]:
        return [self._expression(clause, f"{path}.{index}") for index, clause in enumerate(clauses)]

    def _joined(self, operator: str, parts: list[str]) -> str:
        if len(parts) == 1:
            return parts[0]
        return "(\n" + indented(f"\n{operator} ".join(parts)) + "\n)"

    def _expression(self, clause: Clause, path: str) -> str:
        match clause:
            case Fluent() | TextFluent():
                name = self.names.declare(clause.iri, "clause", owner=self.owner, namespace=self.namespace)
                time = self.time(clause.time, clause.seconds)
                predicate = f"{self._predicate(clause)}{self._condition(clause, name)}"
                return f"{name}: holds({predicate}, {time}){self._verified(clause)}"
            case TextClause():
                self._named(clause.iri, "text", path)
                return f"{quoted(clause.text)} {self.time(clause.time, clause.seconds)}{self._verified(clause)}"
            case Junction(operator="not"):
                self._named(clause.iri, "not", path)
                return f"( not {self._joined('and', self._each(clause.operands, path))} )"
            case Junction():
                self._named(clause.iri, clause.operator, path)
                return self._joined(clause.operator, self._each(clause.operands, path))
            case Exists():
                self._named(clause.iri, "exists", path)
                in_set = self._set(clause.in_set)
                name = self._bind(clause.variable)
                inner = self._joined("and", self._each(clause.clauses, path))
                return f"( var {name} exists in {in_set} ) such that {{\n{indented(inner)}\n}}"
            case _:
                raise Incomplete(f"{clause.iri} is not allowed in Given or Then")

    def _verified(self, clause: Clause) -> str:
        return verified(self.names, clause.iri, " verifies")

    def _predicate(self, clause: Fluent | TextFluent) -> str:
        if isinstance(clause, Fluent) and clause.named is not None:
            return named_phrase(self.names, clause.named, clause.iri, self._variable)
        if isinstance(clause, Fluent):
            return self._phrase(load_catalog().predicates[clause.predicate], clause.iri, clause.arguments)
        for name in clause.arguments:
            if not NAME.fullmatch(name):
                raise Incomplete(f"{clause.iri} has a placeholder '{name}', which is not a valid name")
        nodes = items_of(self.names.records, clause.iri, "bdd:argument-variables")
        values = zip(clause.arguments.items(), nodes, strict=True)
        written = (
            (name, self._variable(value) if isinstance(value, Iri) else self.names.value(node))
            for (name, value), node in values
        )
        arguments = "".join(f", {name}={value}" for name, value in written)
        return f"pred({quoted(clause.template)}{arguments})"

    def _condition(self, clause: Fluent | TextFluent, name: str) -> str:
        return f" whenever {self._conditions(clause.conditions, 'whenever', name)}" if clause.conditions else ""

    def defined_event(self, event: DefinedEvent) -> str:
        """Return the definition of an event of a template as text."""
        name = self.names.paths[event.iri].rpartition(".")[2]
        seconds = f"{event.seconds:g}" if event.variable is None else self._variable(event.variable)
        lasting = f" for {seconds} seconds" if event.seconds or event.variable is not None else ""
        return f"event {name} when {self._conditions(event.conditions, 'occurs-when', name)}{lasting}"

    def _conditions(self, conditions: Sequence[Condition], kind: str, name: str) -> str:
        for number, one in enumerate(conditions):
            self._named(one.iri, kind, f".{name}{f'.{number}' if number else ''}")
        return " and ".join(map(self._one_condition, conditions))

    def _one_condition(self, condition: Condition) -> str:
        if condition.named is not None:
            return named_phrase(self.names, condition.named, condition.iri, self._variable)
        return self._phrase(load_catalog().predicates[condition.predicate], condition.iri, condition.arguments)

    def state(self, node: Iri) -> str:
        """Return a part of the definition of a named predicate. Raises ``Incomplete``."""
        records = self.names.records
        for operator, kind in STATES.items():
            if records.is_a(node, kind):
                parts = [self.state(Iri(str(one))) for one in records.list_of(node, "rbw:operands")]
                return f"( not {parts[0]} )" if operator == "not" else self._grouped(operator, parts)
        return self._one_condition(ClauseReader(records).condition(node))

    def _grouped(self, operator: str, parts: list[str]) -> str:
        return "(\n" + indented(f"\n{operator} ".join(parts)) + "\n)"

    def _phrase(self, word: Predicate | Behaviour, iri: Iri, arguments: Mapping[str, Iri | str]) -> str:
        """Return the phrase of a clause, a condition or a behaviour; ``iri`` is its node."""
        slots = {slot.name: slot for slot in word.slots}
        return _SLOT.sub(
            lambda match: self._argument(iri, slots[match[1] or match[2]], arguments[match[1] or match[2]]), word.phrase
        )

    def _argument(self, iri: Iri, slot: Slot, value: Iri | str) -> str:
        if isinstance(value, Iri):
            return self._variable(value)
        if slot.kind is Kind.VALUE:
            return self.names.value(self.names.records.all(iri, slot.property)[0])
        if not NAME.fullmatch(value) and not is_quantity(value):
            raise Incomplete(f"'{value}' is neither a name nor a quantity")
        return value

    def _variable(self, variable: str) -> str:
        return self.variables.get(variable) or self.names.reference(variable)

    def _set(self, node: str) -> str:
        return self.variables.get(node) or set_reference(self.names, node)

    def _bind(self, variable: Iri) -> str:
        """Declare the variable of a quantifier, so that clauses inside the quantifier can refer to it.

        Several quantifiers may share a variable.
        """
        if variable in self.bound:
            return self.bound[variable]
        name = self.names.declare(variable, "each", owner=self.owner, namespace=self.namespace, before="var-")
        self.variables[variable] = f"<{name}>"
        self.bound[variable] = name
        return name

    def _for_all(self, loop: ForAll, path: str) -> str:
        self._named(loop.iri, "forall", path)
        in_set = self._set(loop.in_set)
        name = self._bind(loop.variable)
        return f"for all ( var {name} in {in_set} ) {{\n{indented(self.body(loop.clauses, path).rstrip())}\n}}"

    def _behaviour(self, clause: BehaviourClause, path: str) -> str:
        names = self.names
        self._named(clause.iri, "when-bhv", path)
        node = names.records.one(clause.iri, "bhv:of-behaviour")
        namespace, local = names.split(node)
        name = local or "behaviour"
        action = self._phrase(load_catalog().behaviours[clause.behaviour], clause.iri, clause.arguments)
        duration = self.time(During(clause.start, clause.end))
        head = f"Behaviour (ns={names.prefix(namespace)}) {name}"
        link = "" if clause.node is None else f"\n    node: {names.reference(clause.node)}"
        for external in names.records.iris(names.records.all(node, "rbw:external-node"))[:1] if not link else ():
            link = f"\n    node: {quoted(external)}"
        moments = [f"\n    emits {moment} as {names.lazily(event, 'event')}" for moment, event in clause.emits]
        for index, emission in enumerate(items_of(names.records, clause.iri, "rbw:emission-list")):
            self._named(Iri(str(emission)), "emits", f"{path}.{index}")
        return f"{head} {{\n    duration: {duration}\n    {action}{''.join(moments)}{link}\n}}"

    def _named(self, node: Iri, kind: str, path: str) -> None:
        made = f"{self.namespace}{kind}-{self.owner}{path}"
        if made != node:
            self.names.renamed[node] = made


@dataclass(frozen=True, slots=True)
class _WhenPart:
    events: tuple[EventClause, ...]
    behaviour: BehaviourClause


def _when_parts(clauses: Iterable[Clause]) -> Iterator[_WhenPart]:
    """Yield the behaviours of a When, each with the events before it. Raises ``Incomplete`` if events come last."""
    events: tuple[EventClause, ...] = ()
    for clause in clauses:
        if isinstance(clause, EventClause):
            events = (*events, clause)
        elif isinstance(clause, BehaviourClause):
            yield _WhenPart(events, clause)
            events = ()
    if events:
        raise Incomplete("its When waits for an event after its last behaviour")


def template_text(names: Names, reader: ClauseReader, template: Iri, variables: Sequence[Iri]) -> str:
    """Return the text of a template, including the declarations of its variables. Raises ``Incomplete``."""
    records = names.records
    namespace = names.split(template)[0]
    name = names.paths[template]
    writer = ClauseText(names, name, namespace)
    lines: list[str] = []
    for variable in variables:
        own = names.declare(variable, "variable", owner=name, namespace=namespace, before="var-")
        writer.variables[variable] = f"<{own}>"
        lines.append(f"{'set ' if records.is_a(variable, 'bdd:Set') else ''}var {own}\n")
    start, end = (records.one(template, f"time:{side}-event") for side in ("after", "before"))
    head = f"duration: {writer.time(During(start, end))}\n"
    for scenario in records.iris(records.all(template, "bdd:of-scenario")):
        for task in records.iris(records.all(scenario, "task:of-task"))[:1]:
            head += f"task: {names.lazily(task, 'task')}\n"
    head += f"{links}\n" if (links := verified(names, template, "verifies:")) else ""
    lines += [f"{writer.defined_event(event)}\n" for event in reader.events(template)]
    body = writer.body(reader.clauses(template))
    inner = indented((head + "".join(lines) + body).rstrip())
    return f"Scenario Template (ns={names.prefix(namespace)}) {name} {{\n{inner}\n}}"
