"""Finds what references lead to, and says what is wrong where they lead nowhere."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from difflib import get_close_matches

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, Related, Severity
from robbdd_tools.names.analysis import Definition
from robbdd_tools.names.index import Declared, FileIndex, Placed, language_of
from robbdd_tools.syntax.declaration import Reference, SymbolKind
from robbdd_tools.syntax.tree import Ref

_ELEMENTS = (SymbolKind.OBJECT, SymbolKind.WORKSPACE, SymbolKind.AGENT)
_ELEMENT_SETS = (SymbolKind.OBJECT_SET, SymbolKind.WORKSPACE_SET, SymbolKind.AGENT_SET)
ROLE_KINDS: Mapping[str, tuple[SymbolKind, ...]] = {
    "Namespace": (SymbolKind.NAMESPACE,),
    "Event": (SymbolKind.EVENT,),
    "Task": (SymbolKind.TASK,),
    "Template": (SymbolKind.TEMPLATE,),
    "Variable": (SymbolKind.VARIABLE, SymbolKind.SET_VARIABLE),
    "Scene": (SymbolKind.SCENE,),
    "Composition": (SymbolKind.COMPOSITION,),
    "Object": (SymbolKind.OBJECT,),
    "Workspace": (SymbolKind.WORKSPACE,),
    "Element": _ELEMENTS,
    "ObjectSet": (SymbolKind.OBJECT_SET,),
    "WorkspaceSet": (SymbolKind.WORKSPACE_SET,),
    "AgentSet": (SymbolKind.AGENT_SET,),
    "ConstantSet": (SymbolKind.CONSTANT_SET,),
    "AnySet": (*_ELEMENT_SETS, SymbolKind.CONSTANT_SET, SymbolKind.SET_VARIABLE),
}
"""What a reference may lead to, by the grammar rule that reads it."""

_SCENE_KINDS = {*_ELEMENTS, *_ELEMENT_SETS, SymbolKind.COMPOSITION, SymbolKind.SCENE}


@dataclass(frozen=True)
class Scope:
    """The files whose names a file can use: itself first, then its imports in order of nearness.

    ``unread`` are the URIs of imports that could not be read.
    """

    files: tuple[FileIndex, ...]
    unread: tuple[str, ...]

    def find(self, path: str) -> Iterator[tuple[FileIndex, Declared]]:
        """Yield the declarations of a qualified name, nearest first."""
        for file in self.files:
            declared = file.declared.get(path)
            if declared is not None:
                yield file, declared

    def define(self, file: FileIndex, declared: Declared) -> Definition:
        """Return a declaration of a file in this scope as a definition."""
        symbol = declared.symbol
        span, extent = symbol.span.shifted(declared.offset), symbol.extent.shifted(declared.offset)
        return Definition(file.document.uri, symbol, span, extent, self._iri(file, declared))

    def _iri(self, file: FileIndex, declared: Declared) -> str | None:
        symbol = declared.symbol
        if symbol.namespace is None:
            return None
        # A declaration's namespace is looked up from its own file; the nearest one outside is a file it imports.
        ordered = (file, *(other for other in self.files if other is not file))
        for other in ordered:
            found = other.declared.get(symbol.namespace)
            if found is not None and found.symbol.kind is SymbolKind.NAMESPACE:
                return _namespace_iri(other, found) + _local_name(declared)
        return None

    def visible(self, kinds: Iterable[SymbolKind], scopes: tuple[str, ...]) -> dict[str, tuple[FileIndex, Declared]]:
        """Return every name of some kinds as it would be written at a place, nearest declaration first."""
        wanted = set(kinds)
        names: dict[str, tuple[FileIndex, Declared]] = {}
        for position, file in enumerate(self.files):
            for path, declared in file.declared.items():
                if declared.symbol.kind not in wanted:
                    continue
                written = _shortened(path, scopes) if position == 0 else path
                names.setdefault(written, (file, declared))
        return names


def _shortened(path: str, scopes: tuple[str, ...]) -> str:
    for scope in scopes:
        if path.startswith(f"{scope}."):
            return path[len(scope) + 1 :]
    return path


def _namespace_iri(file: FileIndex, declared: Declared) -> str:
    for placed in file.declarations:
        if placed.offset == declared.offset:
            return getattr(getattr(placed.declaration.tree, "iri", None), "value", "")
    return ""


def _local_name(declared: Declared) -> str:
    symbol = declared.symbol
    return f"var-{symbol.name}" if symbol.kind in ROLE_KINDS["Variable"] else symbol.name


def resolve(scope: Scope, placed: Placed) -> tuple[dict[Ref, Definition], list[Diagnostic]]:
    """Resolve all references of one declaration of the scope's own file."""
    targets: dict[Ref, Definition] = {}
    diagnostics: list[Diagnostic] = []
    for reference in placed.declaration.references:
        found = _lookup(scope, reference)
        if isinstance(found, Definition):
            targets[reference.ref] = found
        elif found is not None:
            diagnostics.append(_wrong_kind(scope, placed, reference, scope.define(*found[0])))
        else:
            unknown = _unknown(scope, placed, reference)
            if unknown.fixes or not _could_be_unread(scope, reference):
                diagnostics.append(unknown)
    return targets, diagnostics


def _lookup(scope: Scope, reference: Reference) -> Definition | list[tuple[FileIndex, Declared]] | None:
    """Return the definition; or declarations of another kind that have the name; or ``None``."""
    kinds = ROLE_KINDS[reference.ref.role]
    paths = [*(f"{prefix}.{reference.ref.path}" for prefix in reference.scopes), reference.ref.path]
    others: list[tuple[FileIndex, Declared]] = []
    for path in paths:
        for file, declared in scope.find(path):
            if declared.symbol.kind in kinds:
                return scope.define(file, declared)
            others.append((file, declared))
    return others or None


def _could_be_unread(scope: Scope, reference: Reference) -> bool:
    """Tell whether an import that could not be read may declare the name; its own error is enough then."""
    kinds = set(ROLE_KINDS[reference.ref.role])
    languages = {language_of(uri) for uri in scope.unread}
    return bool(kinds & _SCENE_KINDS and "scene" in languages) or "bdd" in languages


def _wrong_kind(scope: Scope, placed: Placed, reference: Reference, found: Definition) -> Diagnostic:
    ref = reference.ref
    return Diagnostic(
        scope.files[0].document.uri,
        ref.span.shifted(placed.offset),
        Severity.ERROR,
        "wrong-kind",
        f"'{ref.path}' is {_a(found.kind)}, but {_wanted(ref.role)} belongs here",
        (Related(found.uri, found.span, f"'{ref.path}' is declared here"),),
    )


def _unknown(scope: Scope, placed: Placed, reference: Reference) -> Diagnostic:
    ref = reference.ref
    uri = scope.files[0].document.uri
    span = ref.span.shifted(placed.offset)
    names = scope.visible(ROLE_KINDS[ref.role], reference.scopes)
    close = get_close_matches(ref.path, names, n=3, cutoff=0.6)
    message = f"there is no {_wanted(ref.role, article=False)} '{ref.path}'"
    if close:
        message += f"; did you mean '{close[0]}'?"
    elif not names:
        message += ": none is declared here or in an imported file"
    fixes = tuple(Fix(f"Change to '{name}'", (Edit(uri, span, name),)) for name in close)
    return Diagnostic(uri, span, Severity.ERROR, "unknown-name", message, fixes=fixes)


def _wanted(role: str, article: bool = True) -> str:
    words = {"Element": "object, workspace or agent", "AnySet": "set"}.get(role)
    if words is None:
        words = str(ROLE_KINDS[role][0])
    return _a(words) if article else words


def _a(words: str) -> str:
    article = "an" if words[0] in "aeio" else "a"
    return f"{article} {words}"
