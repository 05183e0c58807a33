"""Write predicates of clauses and conditions as triples, and the definitions of named predicates."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.graph.rdf.vocabulary import NAMED_USE, STATES
from robbdd_tools.graph.write.sink import Frame, namespace_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.predicate_tree import written_phrase

if TYPE_CHECKING:
    from rdflib import URIRef
    from rdflib.term import Node

    from robbdd_tools.catalog.api import Slot

MAX_NESTED = 100
"""Maximum nesting depth of parentheses. Deeper ones are left out to protect the stack."""


def add_predicate(frame: Frame, node: URIRef, predicate: tree.PhraseUse | tree.NamedUse, named: tree.Node) -> None:
    """Add a predicate to the node of a clause or condition. ``named`` is the place to record for the node's class."""
    if isinstance(predicate, tree.PhraseUse):
        word = load_catalog().predicates[predicate.word]
        frame.sink.add_types(node, [word.rdf_type], frame.at(named))
        add_arguments(frame, node, word.slots, predicate)
        return
    sink = frame.sink
    sink.add_types(node, [NAMED_USE], frame.at(named))
    target = frame.target(predicate.predicate)
    sink.add(node, "rbw:named-predicate", target, frame.at(predicate.predicate))
    values: list[Node] = []
    for value in predicate.values:
        found = written_value(frame, value)
        if found is not None:
            sink.mark(node, "rbw:argument-list", found, frame.at(value))
            values.append(found)
    sink.add(node, "rbw:argument-list", sink.make_list(values), frame.at(predicate))


def add_arguments(frame: Frame, node: URIRef, slots: Iterable[Slot], phrase: tree.PhraseUse) -> None:
    """Add the terms that fill the slots of a catalog phrase."""
    written = dict(phrase.arguments)
    for slot in slots:
        argument = written.get(slot.name)
        if argument is not None:
            frame.sink.add(node, slot.property, written_value(frame, argument), frame.at(argument))


def add_named_predicate(frame: Frame, predicate: tree.NamedPredicate) -> None:
    """Write the definition of a named predicate."""
    node = frame.claimed(predicate.name.text, predicate.name)
    if node is None:
        return
    sink = frame.sink
    sink.add_types(node, ["rbw:NamedPredicate"], frame.at(predicate.name))
    sink.add(node, "rbw:phrase", sink.literal(written_phrase(predicate)), frame.at(predicate.name))
    parameters: list[Node] = []
    for parameter in predicate.parameters:
        declared = frame.node(f"{predicate.name.text}.{parameter.name.text}")
        if declared is not None:
            sink.add_types(declared, ["rbw:Parameter"], frame.at(parameter.name))
            sink.mark(node, "rbw:parameters", declared, frame.at(parameter.name))
            parameters.append(declared)
    sink.add(node, "rbw:parameters", sink.make_list(parameters))
    start = f"{namespace_of(node, predicate.name.text)}state-{predicate.name.text}"
    sink.add(node, "rbw:defined-as", _state(frame, predicate.body, start), frame.at(predicate.body))


def _state(frame: Frame, state: tree.State, name: str) -> URIRef | None:
    node = frame.sink.iri(name)
    if node is None or name.count(".") > MAX_NESTED:
        return None
    if isinstance(state, tree.AllStates | tree.AnyState) and len(state.operands) == 1:
        return _state(frame, state.operands[0], name)
    match state:
        case tree.PhraseUse() | tree.NamedUse():
            frame.sink.add_types(node, ["rbw:Condition"], frame.at(state))
            add_predicate(frame, node, state, state)
            return node
        case tree.NegatedState(operand=operand):
            operator, operands = "not", (operand,)
        case tree.AllStates(operands=operands):
            operator = "and"
        case tree.AnyState(operands=operands):
            operator = "or"
    frame.sink.add_types(node, [STATES[operator]], frame.at(state))
    inner = [_state(frame, one, f"{name}.{number}") for number, one in enumerate(operands)]
    frame.sink.add(node, "rbw:operands", frame.sink.make_list(inner))
    return node


def written_value(frame: Frame, argument: tree.Argument) -> Node | None:
    """Return the node of an argument: a variable, an element or a literal."""
    match argument:
        case tree.Ref():
            return frame.target(argument)
        case tree.Name():
            return frame.sink.literal(argument.text)
        case _:
            return frame.sink.value(argument)
