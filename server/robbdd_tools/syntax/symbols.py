"""Names declared and used in a tree, and what can be saved of them from text that did not parse."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import fields
from typing import Any, cast

from robbdd_tools.base.document import Span
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import Reference, Symbol, SymbolKind

MOST_COPIES = 10_000
"""Members of a ``similar`` set that get a name; a larger count is a typing error."""

_SETS = {
    "object": SymbolKind.OBJECT_SET,
    "workspace": SymbolKind.WORKSPACE_SET,
    "agent": SymbolKind.AGENT_SET,
}
_TOP = {
    tree.Event: SymbolKind.EVENT,
    tree.Task: SymbolKind.TASK,
    tree.ConstantSet: SymbolKind.CONSTANT_SET,
    tree.Composition: SymbolKind.COMPOSITION,
    tree.Scene: SymbolKind.SCENE,
    tree.Template: SymbolKind.TEMPLATE,
    tree.Story: SymbolKind.STORY,
}


def symbols(root: tree.DeclarationTree) -> tuple[Symbol, ...]:
    """Return what a declaration declares, itself first, then its parts in the order of the text."""
    if isinstance(root, tree.Import):
        return ()
    if isinstance(root, tree.Namespace):
        return (Symbol(root.name.text, root.name.text, SymbolKind.NAMESPACE, root.name.span, root.span, None),)
    namespace = root.namespace.reference.path
    kind = _SETS[root.kind] if isinstance(root, tree.ElementSet | tree.SimilarSet) else _TOP[type(root)]
    own = Symbol(root.name.text, root.name.text, kind, root.name.span, root.span, namespace)
    return (own, *_parts(root, root.name.text, namespace))


def _parts(root: tree.DeclarationTree, path: str, namespace: str) -> Iterator[Symbol]:
    match root:
        case tree.ElementSet():
            for member in root.members:
                yield _symbol(path, member.name, SymbolKind(root.kind), member.span, namespace)
        case tree.SimilarSet():
            count = root.count.value if isinstance(root.count.value, int) else 0
            for index in range(min(count, MOST_COPIES)):
                name = f"{root.base.text}{index}"
                kind = SymbolKind(root.kind)
                yield Symbol(f"{path}.{name}", name, kind, root.base.span, root.span, namespace)
        case tree.Template():
            for variable in root.variables:
                kind = SymbolKind.SET_VARIABLE if variable.is_set else SymbolKind.VARIABLE
                yield _symbol(path, variable.name, kind, variable.span, namespace)
            yield from _clauses(root.body, path, namespace)
        case tree.Story():
            for variant in root.variants:
                yield _symbol(path, variant.name, SymbolKind.VARIANT, variant.span, namespace)
                yield from _clauses(variant, f"{path}.{variant.name.text}", namespace)
        case _:
            pass


def _clauses(node: tree.Node, path: str, namespace: str) -> Iterator[Symbol]:
    """Fluents, behaviours and quantified variables of a template or variant."""
    for part in walk(node):
        match part:
            case tree.Fluent():
                yield _symbol(path, part.name, SymbolKind.FLUENT, part.span, namespace)
            case tree.BehaviourUse():
                own = part.namespace.reference.path
                yield _symbol(path, part.name, SymbolKind.BEHAVIOUR, part.span, own)
            case tree.ForAll() | tree.Exists():
                yield _symbol(path, part.variable, SymbolKind.VARIABLE, part.variable.span, namespace)
            case _:
                pass


def _symbol(path: str, name: tree.Name, kind: SymbolKind, extent: Span, namespace: str) -> Symbol:
    return Symbol(f"{path}.{name.text}", name.text, kind, name.span, extent, namespace)


def references(root: tree.DeclarationTree) -> tuple[Reference, ...]:
    """Return every use of a name in a declaration, in the order of the text."""
    found: list[Reference] = []
    _collect(root, (), found)
    return tuple(sorted(found, key=lambda reference: reference.ref.span))


def _collect(node: tree.Node, scopes: tuple[str, ...], found: list[Reference]) -> None:
    if isinstance(node, tree.Ref):
        found.append(Reference(node, scopes))
        return
    if isinstance(node, tree.Template | tree.Story):
        scopes = (node.name.text,)
    elif isinstance(node, tree.Variant):
        scopes = (f"{scopes[0]}.{node.name.text}", *scopes)
    for child in children(node):
        _collect(child, scopes, found)


def children(node: tree.Node) -> Iterator[tree.Node]:
    """Yield the nodes directly below a node, in the order of the grammar."""
    for field in fields(node):
        yield from _nodes(getattr(node, field.name))


def walk(node: tree.Node) -> Iterator[tree.Node]:
    """Yield a node and all below it, in the order of the grammar."""
    yield node
    for child in children(node):
        yield from walk(child)


def _nodes(value: Any) -> Iterator[tree.Node]:
    if isinstance(value, tree.Node):
        yield value
    elif isinstance(value, tuple):
        for entry in cast(tuple[Any, ...], value):
            yield from _nodes(entry)


_NAMED = r"\s*(?:\(\s*ns\s*=\s*(?P<ns>[^\W\d][\w\-]*)\s*\)\s*)?(?P<name>[^\W\d][\w\-]*)"
_HEADERS = (
    (re.compile(r"(?:similar\s+)?obj\s+set" + _NAMED), SymbolKind.OBJECT_SET),
    (re.compile(r"(?:similar\s+)?ws\s+set" + _NAMED), SymbolKind.WORKSPACE_SET),
    (re.compile(r"(?:similar\s+)?agn\s+set" + _NAMED), SymbolKind.AGENT_SET),
    (re.compile(r"comp\b" + _NAMED), SymbolKind.COMPOSITION),
    (re.compile(r"scene\b" + _NAMED), SymbolKind.SCENE),
    (re.compile(r"Event\b" + _NAMED), SymbolKind.EVENT),
    (re.compile(r"Task\b" + _NAMED), SymbolKind.TASK),
    (re.compile(r"const\s+set" + _NAMED), SymbolKind.CONSTANT_SET),
    (re.compile(r"Scenario\s+Template" + _NAMED), SymbolKind.TEMPLATE),
    (re.compile(r"User\s+Story" + _NAMED), SymbolKind.STORY),
    (re.compile(r"ns\s+(?P<name>[^\W\d][\w\-]*)(?P<ns>)"), SymbolKind.NAMESPACE),
)
_PART = re.compile(
    r"(?<![\w\-.<])(?:(?P<kind>object|workspace|agent|set\s+var|var|Scenario)\s+(?P<name>[^\W\d][\w\-]*)"
    r"|(?P<fluent>[^\W\d][\w\-]*)\s*:\s*holds\b)"
)
_PARTS = {
    "object": SymbolKind.OBJECT,
    "workspace": SymbolKind.WORKSPACE,
    "agent": SymbolKind.AGENT,
    "var": SymbolKind.VARIABLE,
    "set var": SymbolKind.SET_VARIABLE,
    "Scenario": SymbolKind.VARIANT,
}


def salvage(text: str) -> tuple[Symbol, ...]:
    """Return the names that a broken declaration evidently declares, so that its users see no second error."""
    for pattern, kind in _HEADERS:
        match = pattern.match(text)
        if match:
            whole = Span(0, len(text.rstrip()))
            path, namespace = match["name"], match["ns"] or None
            own = Symbol(path, path, kind, Span(*match.span("name")), whole, namespace)
            return (own, *_salvage_parts(text, match.end(), path, namespace))
    return ()


def _salvage_parts(text: str, start: int, path: str, namespace: str | None) -> Iterator[Symbol]:
    for match in _PART.finditer(text, start):
        group = "fluent" if match["fluent"] else "name"
        kind = SymbolKind.FLUENT if match["fluent"] else _PARTS[" ".join(match["kind"].split())]
        name, span = match[group], Span(*match.span(group))
        yield Symbol(f"{path}.{name}", name, kind, span, Span(*match.span()), namespace)
