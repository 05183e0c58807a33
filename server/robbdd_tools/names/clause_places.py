"""The positions of the clauses of a file, each with its IRI in the graph."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.names.variant_places import variants_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.when_paths import part_path, when_path

if TYPE_CHECKING:
    from robbdd_tools.names.project import Snapshot

FOR_ALL = "for all"
"""Name of a loop. It contains a space, so no name in a text is equal to it."""
MAX_NESTED = 100
"""Maximum nesting depth of clauses. Graphs do not contain deeper ones."""


@dataclass(frozen=True, slots=True)
class PlacedClause:
    """A clause, a group of clauses or a quantifier: its whole absolute span, and its name or, if it has none, its kind.

    The result is shown at ``head``. For the behaviour of a ``When``, these are the first words up to the name.
    """

    iri: str
    name: str
    span: Span
    head: Span


def clauses_in(snapshot: Snapshot, uri: str) -> Iterator[PlacedClause]:
    """Yield the clauses of the templates and variants of a file.

    Nested clauses are after the clauses that contain them.
    """
    file = snapshot.file(uri)
    for placed in file.declarations if file is not None else ():
        template = placed.declaration.tree
        found = file.definitions.get(template.name.text) if file and isinstance(template, tree.Template) else None
        if isinstance(template, tree.Template) and found is not None and found.iri is not None:
            owner = template.name.text
            walk = _Walk(found.iri.removesuffix(owner), owner, placed.offset)
            yield from walk.body(template.body, "")
    for variant in variants_of(snapshot, uri):
        name = variant.definition.symbol.name
        walk = _Walk(variant.iri.removesuffix(name), variant.definition.symbol.path, variant.site.placed.offset)
        yield from walk.top(variant.node.given, "given", "")
        yield from walk.occurrences(variant.node.events, when_path("", 0))
        yield from walk.top(variant.node.then, "then", "")


@dataclass(frozen=True, slots=True)
class _Walk:
    """Finds the clauses of one owner. Paths of clauses are the same as in ``graph.write.clauses``."""

    namespace: str
    owner: str
    offset: int

    def body(self, body: tree.Body, path: str) -> Iterator[PlacedClause]:
        for number, part in enumerate(body.parts):
            yield from self._part(part, part_path(path, number))

    def _part(self, part: tree.Part, path: str) -> Iterator[PlacedClause]:
        yield from self.top(part.given, "given", path)
        if part.when is not None:
            for number, step in enumerate(part.when.steps):
                inner, use = when_path(path, number), step.behaviour
                yield from self.occurrences(step.events, inner)
                behaviour = self._placed("when-bhv", inner, use, use.name.text)
                yield replace(behaviour, head=Span(behaviour.span.start, use.name.span.end + self.offset))
        if part.for_all is not None:
            inner = f"{path}.all"
            yield self._placed("forall", inner, part.for_all, FOR_ALL)
            if inner.count(".") <= MAX_NESTED:
                yield from self.body(part.for_all.body, inner)
        yield from self.top(part.then, "then", path)

    def top(self, expression: tree.Expression | None, role: str, path: str) -> Iterator[PlacedClause]:
        if expression is not None:
            bare = tree.bare(expression)
            parts = bare.operands if isinstance(bare, tree.Conjunction) else (bare,)
            yield from self._each(parts, f"{path}.{role}")

    def occurrences(self, events: Sequence[tree.Occurrence], path: str) -> Iterator[PlacedClause]:
        for index, occurrence in enumerate(events):
            yield self._placed("when-evt", f"{path}.{index}", occurrence, "event")

    def _each(self, parts: Sequence[tree.Expression], path: str) -> Iterator[PlacedClause]:
        if path.count(".") <= MAX_NESTED:
            for index, part in enumerate(parts):
                yield from self._clause(tree.bare(part), f"{path}.{index}")

    def _clause(self, clause: tree.Expression, path: str) -> Iterator[PlacedClause]:
        match clause:
            case tree.Fluent():
                span = clause.span.shifted(self.offset)
                yield PlacedClause(self.namespace + clause.name.text, clause.name.text, span, span)
            case tree.TextClause():
                yield self._placed("text", path, clause, clause.text.value)
            case tree.Negation():
                yield self._placed("not", path, clause, "not")
                yield from self._each((clause.operand,), path)
            case tree.Conjunction():
                yield self._placed("and", path, clause, "and")
                yield from self._each(clause.operands, path)
            case tree.Disjunction():
                yield self._placed("or", path, clause, "or")
                yield from self._each(clause.operands, path)
            case tree.Exists():
                yield self._placed("exists", path, clause, "exists")
                body = tree.bare(clause.body)
                yield from self._each(body.operands if isinstance(body, tree.Conjunction) else (body,), path)

    def _placed(self, kind: str, path: str, node: tree.Node, name: str) -> PlacedClause:
        span = node.span.shifted(self.offset)
        return PlacedClause(f"{self.namespace}{kind}-{self.owner}{path}", name, span, span)
