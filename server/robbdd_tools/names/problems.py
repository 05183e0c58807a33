"""Diagnostics of names that are unknown, of the wrong kind, or declared twice."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import count
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, Related, Severity
from robbdd_tools.base.removals import removal
from robbdd_tools.names.index import language_of
from robbdd_tools.names.nearest import nearest
from robbdd_tools.names.resolve import define
from robbdd_tools.names.roles import ROLE_KINDS, may_declare
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.names.index import Declared, FileIndex
    from robbdd_tools.names.resolve import Resolution, Unresolved
    from robbdd_tools.names.scope import Scope
    from robbdd_tools.syntax.declaration import Reference
    from robbdd_tools.syntax.tree import Ref

_SETS = (SymbolKind.OBJECT_SET, SymbolKind.WORKSPACE_SET, SymbolKind.AGENT_SET, SymbolKind.CONSTANT_SET)


def unresolved(scope: Scope, resolution: Resolution, offset: int) -> Iterator[Diagnostic]:
    """Yield a diagnostic for each unresolved reference in the declaration at ``offset``."""
    for problem in resolution.unresolved:
        if problem.other is not None:
            yield _wrong_kind(scope, problem, offset)
            continue
        found = _unknown(scope, problem.reference, offset)
        if found.fixes or not _could_be_unread(scope, problem.reference):
            yield found


def repeated(scope: Scope) -> Iterator[Diagnostic]:
    """Yield a diagnostic for each repeated declaration in the file to which the scope belongs."""
    file = scope.own
    uri = file.document.uri
    for path in file.names.repeated:
        first, *others = file.declared(path)
        for other in others:
            if _same_variable(first, other):
                continue
            span = first.symbol.span.shifted(first.offset)
            message = f"'{path}' is already declared: give one of the two another name"
            related = (Related(uri, span, "the first declaration"),)
            place = other.symbol.span.shifted(other.offset)
            is_variable = other.symbol.kind in ROLE_KINDS["Variable"]
            fixes = tuple(_removed(file, first, other)) if is_variable else tuple(_renamed(file, path, place))
            yield Diagnostic(uri, place, Severity.ERROR, "duplicate-name", message, related, fixes)


def _removed(file: FileIndex, first: Declared, other: Declared) -> Iterator[Fix]:
    """Yield a fix that removes the second declaration of a variable. A renamed variable would lack values."""
    if first.symbol.kind is other.symbol.kind and other.symbol.span != other.symbol.extent:
        extent = other.symbol.extent.shifted(other.offset)
        yield removal(file.document, f"Remove the second declaration of '{other.symbol.name}'", extent)


def _renamed(file: FileIndex, path: str, place: Span) -> Iterator[Fix]:
    """Yield a fix that renames the second declaration. References still denote the first one."""
    name = path.rpartition(".")[2]
    free = free_name(name, file.names.entries)
    if file.document.text[place.start : place.end] == name:
        yield Fix(f"Change to '{free}'", (Edit(file.document.uri, place, free),))


def free_name(name: str, paths: Iterable[str]) -> str:
    """Return a variant of a name that no qualified name ends with."""
    taken = {path.rpartition(".")[2] for path in paths}
    return next(found for number in count(2) if (found := f"{name}-{number}") not in taken)


def _same_variable(first: Declared, second: Declared) -> bool:
    """Return whether two quantifiers of one declaration use the same variable name. This is allowed."""
    variable = first.symbol.kind is second.symbol.kind is SymbolKind.VARIABLE
    return variable and first.offset == second.offset and second.symbol.span == second.symbol.extent


def _could_be_unread(scope: Scope, reference: Reference) -> bool:
    """Return whether an unreadable import may declare the name. In this case, the error of the import is sufficient."""
    kinds = ROLE_KINDS[reference.ref.role]
    return any(may_declare(language_of(uri), kinds) for uri in scope.unread)


def _wrong_kind(scope: Scope, problem: Unresolved, offset: int) -> Diagnostic:
    assert problem.other is not None
    found = define(scope, problem.other)
    ref = problem.reference.ref
    return Diagnostic(
        scope.own.document.uri,
        ref.span.shifted(offset),
        Severity.ERROR,
        "wrong-kind",
        f"'{ref.path}' is {_a(found.kind)}, but {_wanted(ref.role)} belongs here{_as_variable(ref, found.kind)}",
        (Related(found.uri, found.span, f"'{ref.path}' is declared here"),),
        _renamings(scope, ref.span.shifted(offset), nearest(scope, problem.reference, ROLE_KINDS[ref.role])[0]),
    )


def _as_variable(ref: Ref, kind: SymbolKind) -> str:
    """Return what to write instead of a set in a phrase, whose sets are values of variables."""
    if ref.role != "Term" or kind not in _SETS:
        return ""
    return f": declare a 'set var', whose values are '{{ {{ … }} }}' or 'select N combinations from <{ref.path}>'"


def _unknown(scope: Scope, reference: Reference, offset: int) -> Diagnostic:
    ref = reference.ref
    uri = scope.own.document.uri
    span = ref.span.shifted(offset)
    close, any_known = nearest(scope, reference, ROLE_KINDS[ref.role])
    message = f"there is no {_wanted(ref.role, article=False)} '{ref.path}'"
    if close:
        message += f"; did you mean '{close[0]}'?"
    elif not any_known:
        message += ": none is declared here or in an imported file"
    fixes = _renamings(scope, span, close)
    return Diagnostic(uri, span, Severity.ERROR, "unknown-name", message, fixes=fixes)


def _renamings(scope: Scope, span: Span, names: Iterable[str]) -> tuple[Fix, ...]:
    uri = scope.own.document.uri
    return tuple(Fix(f"Change to '{name}'", (Edit(uri, span, name),)) for name in names)


def _wanted(role: str, article: bool = True) -> str:
    words = {"Element": "object, workspace or agent", "AnySet": "set", "Term": "variable"}.get(role)
    if words is None:
        words = str(ROLE_KINDS[role][0])
    return _a(words) if article else words


def _a(words: str) -> str:
    article = "an" if words[0] in "aeio" else "a"
    return f"{article} {words}"
