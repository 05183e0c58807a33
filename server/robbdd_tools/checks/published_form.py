"""``published-form``: a declaration has the form of the 2025 paper. The fix rewrites it in the current form.

The fix edits pieces of the text, so that comments stay in place. Data that the published form omits and that cannot be
derived is left to the author, for example the task of a template.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.names.indirect_names import ELEMENT_ROLES
from robbdd_tools.names.namespaces import namespace_of, only_namespace
from robbdd_tools.names.uses import clauses_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import Placed

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.names.resolve import Resolution
    from robbdd_tools.syntax.declaration import Declaration

_NAMED = (
    *(tree.ElementSet, tree.SimilarSet, tree.Composition, tree.Scene),
    *(tree.Event, tree.Task, tree.Requirement, tree.ConstantSet, tree.BehaviourTree, tree.Template, tree.Story),
)
Change = tuple[Span, str]
"""A span of a declaration's text (empty: insertion) and its replacement."""


def published_form(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report each declaration that has a part in the published form."""
    uri = file.document.uri
    index = snapshot.scope(uri).own
    own = only_namespace(index.names)
    for placed in file.declarations:
        root = placed.declaration.tree
        if not isinstance(root, _NAMED) or placed.declaration.faults:
            continue
        namespace = own if own or root.namespace else namespace_of(index, placed.declaration.symbols[0])
        changes = [*_changes(placed.declaration, namespace), *_through_scenes(placed.targets.resolution)]
        if changes:
            edits = tuple(Edit(uri, span.shifted(placed.offset), text) for span, text in changes)
            message = f"'{root.name.text}' is written in the published form: the fix rewrites it in the current one"
            place = root.name.span.shifted(placed.offset)
            fix = Fix("Rewrite it in the current form", edits)
            yield Diagnostic(uri, place, Severity.HINT, "published-form", message, fixes=(fix,))


def _through_scenes(resolution: Resolution) -> list[Change]:
    """Return the changes of references that name an element by its scene (``lab_scene.cube``)."""
    if not resolution.parts:
        return list(_own_through_scenes(resolution))
    return [
        (span.shifted(placed.offset), path)
        for placed, part in zip(resolution.declaration.parts, resolution.parts, strict=True)
        for span, path in _own_through_scenes(part)
    ]


@kept_with_key
def _own_through_scenes(resolution: Resolution) -> tuple[Change, ...]:
    found = ((ref, target.path) for ref, target in resolution.targets.items() if ref.role in ELEMENT_ROLES)
    return tuple((ref.span, path) for ref, path in found if "." in ref.path and path != ref.path)


@kept_with_key
def _known_changes(_: Declaration) -> dict[str | None, tuple[Change, ...]]:
    """Return the changes by the namespace of the file."""
    return {}


def _changes(declaration: Declaration, namespace: str | None) -> tuple[Change, ...]:
    known = _known_changes(declaration)
    if namespace not in known:
        known[namespace] = _found_changes(declaration, namespace)
    return known[namespace]


def _found_changes(declaration: Declaration, namespace: str | None) -> tuple[Change, ...]:
    rewriter = _Rewriter(declaration.text, "" if namespace is None else f"(ns={namespace}) ")
    changes = list(rewriter.declaration(declaration.tree))
    if isinstance(declaration.tree, tree.Story):
        for part in declaration.parts or (Placed(declaration, 0),):
            changes += [(span.shifted(part.offset), text) for span, text in _in_scenarios(part.declaration)]
    return tuple(_merged(changes))


@kept_with_key
def _in_scenarios(declaration: Declaration) -> tuple[Change, ...]:
    """Return the changes in the variants of a story, or of a part of one."""
    variants = (clauses.node for clauses in clauses_of(declaration) if isinstance(clauses.node, tree.Variant))
    rewriter = _Rewriter(declaration.text, "")
    return tuple(change for variant in variants for change in rewriter.variant(variant))


def _merged(changes: Iterable[Change]) -> Iterator[Change]:
    """Join insertions at the same place in the given order, and put them before a replacement that starts there."""
    kept: list[Change] = []
    for span, text in sorted(changes, key=lambda change: change[0].start):
        if kept and kept[-1][0].start == kept[-1][0].end == span.start:
            text = kept.pop()[1] + text
        kept.append((span, text))
    yield from kept


def _put(offset: int, text: str) -> Change:
    return Span(offset, offset), text


@dataclass(frozen=True, slots=True)
class _Rewriter:
    text: str
    namespace: str

    def declaration(self, root: object) -> Iterator[Change]:
        """Yield the changes of a declaration. The changes inside the scenarios of a story are left out."""
        if isinstance(root, _NAMED) and root.namespace is None and self.namespace:
            yield _put(root.name.span.start, self.namespace)
        if isinstance(root, tree.Template):
            if root.duration is not None and root.duration.span.start >= root.body.span.start:
                opening = self.text.index("{", root.name.span.end) + 1
                yield _put(opening, f" {_during(root.duration)}")
            yield from self._body(root.body)
        elif isinstance(root, tree.Story):
            first = root.variants[0].span.start
            shown = root.name if root.benefit is None else root.benefit
            if "Scenarios" not in self._code(shown.span.end, first):
                yield _put(first, "Scenarios: ")

    def _body(self, body: tree.Body) -> Iterator[Change]:
        for part in body.parts:
            yield from self._clauses(part.given)
            if part.when is not None:
                for use in part.when.behaviours:
                    yield from self._behaviour(use)
            if part.for_all is not None:
                yield from self._body(part.for_all.body)
            yield from self._clauses(part.then)

    def _clauses(self, expression: tree.Expression | None) -> Iterator[Change]:
        if not isinstance(expression, tree.Conjunction) or expression.span.start < expression.operands[0].span.start:
            yield from self._expression(expression)
            return
        for position, operand in enumerate(expression.operands):
            yield _put(operand.span.start, "and " if position else "( ")
            yield from self._expression(operand)
        yield _put(expression.operands[-1].span.end, " )")

    def _expression(self, expression: tree.Expression | None) -> Iterator[Change]:
        match expression:
            case tree.Fluent() if expression.name.span.start == expression.name.span.end:
                yield from self._fluent(expression)
            case tree.Negation():
                yield from self._expression(expression.operand)
            case tree.Exists():
                yield from self._expression(expression.body)
            case tree.Conjunction() | tree.Disjunction():
                for operand in expression.operands:
                    yield from self._expression(operand)
            case _:
                pass

    def _fluent(self, fluent: tree.Fluent) -> Iterator[Change]:
        start = fluent.span.start
        if self.text.startswith("holds", start):
            yield _put(start, f"{fluent.name.text}: ")
            return
        yield _put(start, f"{fluent.name.text}: holds(")
        yield _put((fluent.predicate, *fluent.conditions)[-1].span.end, ",")
        yield _put(fluent.span.end, ")")

    def _behaviour(self, use: tree.BehaviourUse) -> Iterator[Change]:
        shown = use.duration is not None and use.duration.span == use.span
        duration = "" if use.duration is None else _during(use.duration)
        if use.name.span.start == use.name.span.end:
            yield use.span, f"Behaviour {self.namespace}{use.name.text} {{ {duration}{_phrase(use.action)} }}"
            return
        if use.namespace is None and self.namespace:
            yield _put(use.name.span.start, self.namespace)
        if shown:
            yield _put(use.action.span.start, duration)
        if _words(self.text[use.action.span.start : use.action.span.end]) != _words(_phrase(use.action)):
            yield use.action.span, _phrase(use.action)

    def variant(self, variant: tree.Variant) -> Iterator[Change]:
        word = re.compile(r"Variant\s+").search(self.text, variant.span.start, variant.name.span.start)
        if word:
            yield Span(*word.span()), ""
        yield from self._clauses(variant.given)
        yield from self._clauses(variant.then)
        if not isinstance(variant.variation, tree.Product):
            return
        before = [part.span.end for part in (variant.scene, variant.given, *variant.events, variant.then) if part]
        if "variation" not in self._code(max(before), variant.variation.span.start):
            yield _put(variant.variation.span.start, "variation: ")
        for assignment in variant.variation.assignments:
            yield from self._assignment(assignment)

    def _assignment(self, assignment: tree.Assignment) -> Iterator[Change]:
        head = re.compile(r"\s*>\s*can\s+be\s*:").match(self.text, assignment.variable.span.end)
        if head is None or not isinstance(assignment.choices, tree.ValueList):
            return
        yield Span(assignment.span.start, head.end()), f"var <{assignment.variable.path}>: {{"
        behind = head.end()
        for position, value in enumerate(assignment.choices.values):
            begin = self.text.rindex("<", behind, value.span.start) if isinstance(value, tree.Ref) else value.span.start
            yield Span(self.text.rindex("-", behind, begin), begin), ", " if position else ""
            behind = self.text.index(">", value.span.end) + 1 if isinstance(value, tree.Ref) else value.span.end
        yield _put(behind, " }")

    def _code(self, start: int, end: int) -> str:
        return re.sub(r"//[^\n]*", "", self.text[start:end])


def _during(duration: tree.During) -> str:
    return f"duration: from <{duration.start.path}> until <{duration.end.path}> "


def _phrase(action: tree.PhraseUse) -> str:
    """Return an action in the current form."""
    written = {name: f"<{value.path}>" for name, value in action.arguments if isinstance(value, tree.Ref)}
    phrase = load_catalog().behaviours[action.word].phrase
    return re.sub(r"<(\w+)>", lambda slot: written.get(slot[1], slot[0]), phrase)


def _words(text: str) -> list[str]:
    return re.sub(r"[<>]", " ", re.sub(r"//[^\n]*", "", text)).split()
