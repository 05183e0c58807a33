"""Add clause names, behaviour names and durations that templates and variants in the published form omit.

A clause is named after its template or variant, its role, and a number (``fetch-given-1``), so that it has an IRI and
can be referred to. Names in the text are not generated again. A behaviour starts at the event of *before* in ``Given``
and ends at the event of *after* in ``Then``, if these events are certain. A scenario lasts as long as its behaviour.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import chain, count

from robbdd_tools.base.document import Span
from robbdd_tools.catalog.event_names import inner_event
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.syntax.bdd_tree import (
    BehaviourUse,
    Body,
    Conjunction,
    Disjunction,
    Exists,
    Expression,
    Fluent,
    Negation,
    Part,
    Template,
    TextClause,
    Variant,
    When,
)
from robbdd_tools.syntax.scene_tree import Name, Ref
from robbdd_tools.syntax.time_tree import After, Before, During, TimeConstraint


def unnamed_at(span: Span) -> Name:
    """Return the placeholder for a missing clause name, which is an empty name at the start of the clause."""
    return Name(Span(span.start, span.start), "")


def complete_template(template: Template) -> Template:
    """Return a template with all clauses and behaviours named, and with durations where the clauses imply them."""
    behaviours = {use.name.text for use in template.body.behaviours}
    namer = _Namer(template.name.text, frozenset(_names(template.body)), behaviours)
    body = namer.body(template.body, "")
    duration = template.duration
    written, completed = _behaviour(template.body), _behaviour(body)
    if duration is None and written is not None and completed is not None:
        published = template.namespace is None or not written.name.text
        duration = completed.duration if published else None
    return replace(template, duration=duration, body=body)


def complete_variant(variant: Variant) -> Variant:
    """Return a variant with all its clauses named."""
    taken = frozenset((*_names(variant.given), *_names(variant.then)))
    namer = _Namer(variant.name.text, taken)
    return replace(variant, given=namer.clauses(variant.given, "given"), then=namer.clauses(variant.then, "then"))


@dataclass(frozen=True, slots=True)
class _Namer:
    owner: str
    taken: frozenset[str]
    behaviours: set[str] = field(default_factory=set[str])

    def body(self, body: Body, prefix: str) -> Body:
        parts = (
            self._part(part, f"{prefix}part{number}-" if number > 1 else prefix, is_alone=len(body.parts) == 1)
            for number, part in enumerate(body.parts, start=1)
        )
        return replace(body, parts=tuple(parts))

    def _part(self, part: Part, prefix: str, *, is_alone: bool) -> Part:
        inner = part.for_all
        if inner is not None:
            inner = replace(inner, body=self.body(inner.body, f"{prefix}each-"))
        return replace(
            part,
            given=self.clauses(part.given, f"{prefix}given"),
            when=None if part.when is None else self._when(part.when, part if is_alone else None),
            for_all=inner,
            then=self.clauses(part.then, f"{prefix}then"),
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

    def _when(self, when: When, alone: Part | None) -> When:
        """Return a When with all names. ``alone`` is its part of the body if the body has no other part."""
        first = self._behaviour(when.behaviour)
        if first.duration is None and not when.more and alone is not None:
            first = replace(first, duration=_duration(first, alone))
        more = tuple(replace(step, behaviour=self._behaviour(step.behaviour)) for step in when.more)
        return replace(when, behaviour=first, more=more)

    def _behaviour(self, use: BehaviourUse) -> BehaviourUse:
        if use.name.text:
            return use
        base = f"{self.owner}-{use.action.word}"
        names = chain([base], (f"{base}-{number}" for number in count(2)))
        free = next(name for name in names if name not in self.behaviours)
        self.behaviours.add(free)
        return replace(use, name=replace(use.name, text=free))


def _behaviour(body: Body) -> BehaviourUse | None:
    """Return the behaviour of a body or its nested bodies, if there is only one."""
    behaviours = list(body.behaviours)
    return behaviours[0] if len(behaviours) == 1 else None


def _duration(behaviour: BehaviourUse, part: Part) -> During | None:
    before = [time.event for time in _times(part.given) if isinstance(time, Before)]
    after = [time.event for time in _times(part.then) if isinstance(time, After)]
    while_it_lasts = [time for time in _times(part.then) if isinstance(time, During)]
    events = load_catalog().behaviours[behaviour.action.word].events
    start = _bound(events, events[0], before, [time.start for time in while_it_lasts])
    end = _bound(events, events[-1], after, [time.end for time in while_it_lasts])
    return None if start is None or end is None else During(behaviour.span, start, end, some_time=False)


def _bound(events: tuple[str, ...], bound: str, *groups: list[Ref]) -> Ref | None:
    """Return the event in the text that is the start or the end of a behaviour, called ``bound`` in the catalog.

    It is the event with this name, if any. Otherwise, it is the only event in the first group that has any, or ``None``
    if that group has several. Events with the names of the behaviour's other events are ignored.
    """
    meanings = [[(ref, inner_event(ref.path, events)) for ref in group] for group in groups]
    named = [ref for group in meanings for ref, meaning in group if meaning == bound]
    if named:
        return named[0]
    for group in meanings:
        others = [ref for ref, meaning in group if meaning is None]
        if others:
            return others[0] if len({ref.path for ref in others}) == 1 else None
    return None


def _times(expression: Expression | None) -> Iterator[TimeConstraint]:
    """Yield the time constraints of an expression in the order of the text."""
    match expression:
        case Fluent() | TextClause():
            yield expression.time
        case Negation():
            yield from _times(expression.operand)
        case Exists():
            yield from _times(expression.body)
        case Conjunction() | Disjunction():
            for operand in expression.operands:
                yield from _times(operand)
        case None:
            pass


def _names(node: Body | Expression | None) -> Iterator[str]:
    """Yield the names of fluents written in the text."""
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
            for part in node.parts:
                yield from _names(part.given)
                yield from _names(part.for_all and part.for_all.body)
                yield from _names(part.then)
        case _:
            pass
