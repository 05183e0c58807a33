"""Syntax trees of named predicates: their definitions, and the phrases that use them."""

from __future__ import annotations

from dataclasses import dataclass

from robbdd_tools.syntax.scene_tree import Name, NamespaceArgument, Node, Number, Quantity, Ref, Text

Argument = Ref | Name | Quantity | Number | Text
"""A reference, a bare name or a literal in a slot of a phrase."""


@dataclass(frozen=True, slots=True)
class PhraseUse(Node):
    """A catalog phrase with the values of its slots. ``word`` is the name of the predicate or behaviour."""

    word: str
    arguments: tuple[tuple[str, Argument], ...]


@dataclass(frozen=True, slots=True)
class Parameter(Node):
    """``<name>`` in the phrase of a named predicate."""

    name: Name


@dataclass(frozen=True, slots=True)
class ParameterPiece(Node):
    """A parameter of a phrase and the words before it."""

    words: tuple[Name, ...]
    parameter: Parameter


@dataclass(frozen=True, slots=True)
class PhrasePiece(Node):
    """The value of a parameter and the words before it."""

    words: tuple[Name, ...]
    value: Argument


@dataclass(frozen=True, slots=True)
class NamedUse(Node):
    """The phrase of a named predicate with its values: ``<part> is-stored in <bin>``."""

    subject: Ref | None
    predicate: Ref
    pieces: tuple[PhrasePiece, ...]

    @property
    def values(self) -> tuple[Argument, ...]:
        """The values of the parameters in written order."""
        return (*(() if self.subject is None else (self.subject,)), *(piece.value for piece in self.pieces))


@dataclass(frozen=True, slots=True)
class NegatedState(Node):
    """``( not state )`` in the definition of a predicate."""

    operand: State


@dataclass(frozen=True, slots=True)
class AllStates(Node):
    """``( state and state … )`` in the definition of a predicate."""

    operands: tuple[State, ...]


@dataclass(frozen=True, slots=True)
class AnyState(Node):
    """``( state or state … )`` in the definition of a predicate."""

    operands: tuple[State, ...]


State = PhraseUse | NamedUse | NegatedState | AllStates | AnyState


@dataclass(frozen=True, slots=True)
class NamedPredicate(Node):
    """``Predicate (ns=…) <part> is-stored in <bin>: state``."""

    namespace: NamespaceArgument | None
    subject: Parameter | None
    name: Name
    pieces: tuple[ParameterPiece, ...]
    body: State

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The parameters in written order."""
        return (*(() if self.subject is None else (self.subject,)), *(piece.parameter for piece in self.pieces))


def phrase_shape(node: NamedPredicate | NamedUse) -> tuple[str, ...]:
    """Return the words of a phrase, with ``""`` for each parameter. The name of the predicate is one of the words."""
    lead = () if node.subject is None else ("",)
    own = node.name.text if isinstance(node, NamedPredicate) else node.predicate.path
    return (*lead, own, *(word for piece in node.pieces for word in (*(one.text for one in piece.words), "")))


def written_phrase(node: NamedPredicate) -> str:
    """Return the phrase of a named predicate, with its parameters in angle brackets."""
    names = iter(parameter.name.text for parameter in node.parameters)
    return " ".join(word or f"<{next(names)}>" for word in phrase_shape(node))
