"""Names for what the published form leaves without one, so that every clause has an IRI and can be referred to.

A name is that of the template or variant, the role, and a number: ``fetch-given-1``. Names that stand in the text
are not given a second time.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import count

from robbdd_tools.base.document import Span
from robbdd_tools.syntax.bdd_tree import (
    BehaviourUse,
    Body,
    Conjunction,
    Disjunction,
    Exists,
    Expression,
    Fluent,
    Negation,
    Template,
    Variant,
    When,
)
from robbdd_tools.syntax.scene_tree import Name


def unnamed_at(span: Span) -> Name:
    """Return the placeholder for the name of a clause that has none: empty, at the clause's start."""
    return Name(Span(span.start, span.start), "")


def name_template(template: Template) -> Template:
    """Give a name to each clause and behaviour of a template that has none."""
    namer = _Namer(template.name.text, frozenset(_names(template.body)))
    return replace(template, body=namer.body(template.body, ""))


def name_variant(variant: Variant) -> Variant:
    """Give a name to each clause of a variant that has none."""
    taken = frozenset((*_names(variant.given), *_names(variant.then)))
    namer = _Namer(variant.name.text, taken)
    return replace(variant, given=namer.clauses(variant.given, "given"), then=namer.clauses(variant.then, "then"))


@dataclass(frozen=True, slots=True)
class _Namer:
    owner: str
    taken: frozenset[str]

    def body(self, body: Body, prefix: str) -> Body:
        inner = body.for_all
        if inner is not None:
            inner = replace(inner, body=self.body(inner.body, f"{prefix}each-"))
        return replace(
            body,
            given=self.clauses(body.given, f"{prefix}given"),
            when=None if body.when is None else self._when(body.when),
            for_all=inner,
            then=self.clauses(body.then, f"{prefix}then"),
        )

    def clauses(self, expression: Expression | None, role: str) -> Expression | None:
        if expression is None:
            return None
        candidates = (f"{self.owner}-{role}-{number}" for number in count(1))
        return self._named(expression, (name for name in candidates if name not in self.taken))

    def _named(self, expression: Expression, names: Iterator[str]) -> Expression:
        match expression:
            case Fluent():
                if expression.name.text:
                    return expression
                return replace(expression, name=replace(expression.name, text=next(names)))
            case Negation():
                return replace(expression, operand=self._named(expression.operand, names))
            case Exists():
                return replace(expression, body=self._named(expression.body, names))
            case Conjunction() | Disjunction():
                operands = tuple(self._named(operand, names) for operand in expression.operands)
                return replace(expression, operands=operands)
            case _:
                return expression

    def _when(self, when: When) -> When:
        behaviour: BehaviourUse = when.behaviour
        if behaviour.name.text:
            return when
        name = replace(behaviour.name, text=f"{self.owner}-{behaviour.action.word}")
        return replace(when, behaviour=replace(behaviour, name=name))


def _names(node: Body | Expression | None) -> Iterator[str]:
    """Yield the names of fluents that stand in the text."""
    match node:
        case Fluent():
            yield node.name.text
        case Negation():
            yield from _names(node.operand)
        case Exists():
            yield from _names(node.body)
        case Conjunction() | Disjunction():
            for operand in node.operands:
                yield from _names(operand)
        case Body():
            yield from _names(node.given)
            yield from _names(node.for_all and node.for_all.body)
            yield from _names(node.then)
        case _:
            pass
