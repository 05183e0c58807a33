"""Build the analysis of one file in one revision."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, Severity, sort_key
from robbdd_tools.names.analysis import FileAnalysis, ImportLink, PlacedDeclaration
from robbdd_tools.names.definition import Definition
from robbdd_tools.names.namespaces import without_namespace
from robbdd_tools.names.problems import repeated, unresolved
from robbdd_tools.names.resolve import Resolution, Target, Targets, resolve_file

if TYPE_CHECKING:
    from robbdd_tools.names.index import FileIndex
    from robbdd_tools.names.scope import Scope
    from robbdd_tools.syntax.declaration import SyntaxFault, SyntaxFix


class Definitions(Mapping[str, Definition]):
    """The first declaration of each qualified name in a file itself.

    Definitions are made when they are accessed.
    """

    def __init__(self, scope: Scope) -> None:
        self._scope = scope
        self._names = scope.own.names.entries

    def __getitem__(self, path: str) -> Definition:
        file = self._scope.own
        return self._scope.define(file, file.at(self._names[path][0]))

    def __contains__(self, path: object) -> bool:
        return path in self._names

    def __iter__(self) -> Iterator[str]:
        """Yield the names in text order, regardless of earlier edits."""
        return iter(sorted(self._names, key=lambda path: self._names[path][0].place))

    def __len__(self) -> int:
        return len(self._names)


@dataclass(frozen=True, slots=True)
class Resolved:
    """The analysis of a file, with data that the analysis of its next revision may reuse."""

    scope: Scope
    resolutions: tuple[Resolution, ...]
    analysis: FileAnalysis


def analyse(
    scope: Scope, imports: tuple[ImportLink, ...], broken: list[Diagnostic], before: Resolved | None
) -> Resolved:
    """Analyse the file to which a scope belongs.

    ``imports`` are its imports, and ``broken`` are the diagnostics on its import lines. ``before`` is the analysis of
    its previous revision.
    """
    index = scope.own
    known = () if before is None else before.resolutions
    resolutions = resolve_file(scope, before and before.scope, known)
    made: dict[Target, Definition] = {}
    placed = tuple(
        PlacedDeclaration(entry.declaration, entry.offset, Targets(scope, resolution, made))
        for entry, resolution in zip(index.declarations, resolutions, strict=True)
    )
    diagnostics = [*syntax_errors(index), *repeated(scope), *without_namespace(index), *broken]
    for entry, resolution in zip(index.declarations, resolutions, strict=True):
        if resolution.unresolved:
            diagnostics += unresolved(scope, resolution, entry.offset)
    diagnostics.sort(key=sort_key)
    analysis = FileAnalysis(index.document, placed, imports, Definitions(scope), tuple(diagnostics))
    return Resolved(scope, resolutions, analysis)


def syntax_errors(index: FileIndex) -> list[Diagnostic]:
    """Return the syntax errors of a file."""
    return [
        _syntax_error(index.document.uri, fault, placed.offset)
        for placed in index.declarations
        if placed.declaration.faults
        for fault in placed.declaration.faults
    ]


def _syntax_error(uri: str, fault: SyntaxFault, offset: int) -> Diagnostic:
    fixes: tuple[Fix, ...] = ()
    if fault.fix is not None:
        span = fault.fix.span.shifted(offset)
        fixes = (Fix(fault.fix.title or _title(fault.fix), (Edit(uri, span, fault.fix.text),)),)
    return Diagnostic(uri, fault.span.shifted(offset), Severity.ERROR, "syntax", fault.message, fixes=fixes)


def _title(fix: SyntaxFix) -> str:
    written = fix.text.strip()
    if not written:
        return "Remove it"
    return f"{'Insert' if fix.span.start == fix.span.end else 'Change to'} '{written}'"
