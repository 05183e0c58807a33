"""Fixes for names that lead nowhere or to the wrong kind of thing, added to the findings of name resolution."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from difflib import get_close_matches
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix
from robbdd_tools.base.document import Document, Span
from robbdd_tools.features.unimported import Importable, beside, import_path, loaded
from robbdd_tools.features.workspace_files import model_files_near
from robbdd_tools.names.elements import Site
from robbdd_tools.names.imports import IMPORTABLE
from robbdd_tools.names.index import language_of
from robbdd_tools.names.resolve import candidates
from robbdd_tools.names.roles import ROLE_KINDS
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import FILE_NAMESPACE, SymbolKind
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis, PlacedDeclaration
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import Reference

_KEYWORDS: Mapping[SymbolKind, str] = {
    SymbolKind.OBJECT_SET: "obj set",
    SymbolKind.WORKSPACE_SET: "ws set",
    SymbolKind.AGENT_SET: "agn set",
    SymbolKind.CONSTANT_SET: "set",
    SymbolKind.OBJECT: "obj",
    SymbolKind.WORKSPACE: "ws",
    SymbolKind.COMPOSITION: "ws comp",
}
LEAST_ALIKE = 0.6
"""Share of common letters from which a file's name is a suggestion."""
_SETS = (SymbolKind.OBJECT_SET, SymbolKind.WORKSPACE_SET, SymbolKind.AGENT_SET)


def with_fixes(snapshot: Snapshot, file: FileAnalysis, found: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """Yield the findings of name resolution with the fixes that the loaded files allow."""
    for diagnostic in found:
        if diagnostic.code not in ("unknown-name", "wrong-kind"):
            yield diagnostic
            continue
        used = _reference(file, diagnostic.span)
        fixes = () if used is None else _fixes(snapshot, file, *used, diagnostic.code)
        yield replace(diagnostic, fixes=(*diagnostic.fixes, *fixes)) if fixes else diagnostic


def fixes_from_disk(snapshot: Snapshot, uri: str, diagnostic: Diagnostic) -> tuple[Fix, ...]:
    """Return the fixes that need a look at the disk: imports of an unknown name, files that an import may mean."""
    file = snapshot.file(uri)
    if file is None:
        return ()
    if diagnostic.code == "import":
        return tuple(_existing_paths(file, diagnostic.span))
    used = _reference(file, diagnostic.span) if diagnostic.code == "unknown-name" else None
    return () if used is None else tuple(_imports(file, used[1], beside(snapshot, uri)))


def _existing_paths(file: FileAnalysis, span: Span) -> Iterator[Fix]:
    """Yield the paths of files around a file that are like the one of an import which leads nowhere."""
    uri, text = file.document.uri, file.document.text
    kinds = IMPORTABLE.get(language_of(uri), ())
    near = [found for found in model_files_near(uri) if found != uri and language_of(found) in kinds]
    paths = sorted(path for found in near if (path := import_path(uri, found)) is not None)
    written = text[span.start : span.end]
    alike = get_close_matches(_stem(written), list(dict.fromkeys(map(_stem, paths))), n=3, cutoff=LEAST_ALIKE)
    for stem in alike:
        for path in paths:
            if _stem(path) == stem and path != written:
                yield Fix(f"Change to '{path}'", (Edit(uri, span, path),))


def _stem(path: str) -> str:
    """Return the name of a file without its folder and ending."""
    return path.rpartition("/")[2].partition(".")[0]


def import_edit(file: FileAnalysis, path: str) -> Edit:
    """Return the edit that adds an import to a file."""
    return _below(file, (tree.Import,), f'import "{path}"')


def _fixes(
    snapshot: Snapshot, file: FileAnalysis, placed: PlacedDeclaration, reference: Reference, code: str
) -> tuple[Fix, ...]:
    if code == "wrong-kind":
        return tuple(_other_role(snapshot, file, placed, reference))
    others = loaded(snapshot, file.document.uri)
    return (*_imports(file, reference, others), *_declarations(snapshot, file, placed, reference))


def _reference(file: FileAnalysis, span: Span) -> tuple[PlacedDeclaration, Reference] | None:
    """Return the reference that stands at a place."""
    for placed in file.declarations:
        if placed.span.contains(span.start):
            for reference in placed.declaration.references:
                if reference.ref.span.shifted(placed.offset) == span:
                    return placed, reference
    return None


def _imports(file: FileAnalysis, reference: Reference, others: Iterable[Importable]) -> Iterator[Fix]:
    """Yield an import of each file that declares a name as it is used."""
    kinds = ROLE_KINDS[reference.ref.role]
    for path, index in others:
        if any(kind in kinds for kind in index.names.kinds.get(reference.ref.path, ())):
            yield Fix(f"Import '{path}'", (import_edit(file, path),))


def _declarations(
    snapshot: Snapshot, file: FileAnalysis, placed: PlacedDeclaration, reference: Reference
) -> Iterator[Fix]:
    """Yield the declaration of an event, task or variable that is missing."""
    role, path = reference.ref.role, reference.ref.path
    namespace = placed.declaration.symbols[0].namespace if placed.declaration.symbols else None
    argument = "" if namespace == FILE_NAMESPACE else f"(ns={namespace}) "
    if role in ("Event", "Task") and "." not in path and namespace is not None:
        edit = _below(file, (tree.Event, tree.Task, tree.Namespace, tree.Import), f"{role} {argument}{path}")
        yield Fix(f"Declare the {role.lower()} '{path}'", (edit,))
    if role in ("Variable", "AnySet"):
        owner, _, name = path.rpartition(".")
        template = _template(snapshot, file, placed, owner)
        if template is not None and "." not in owner:
            yield from _variable(*template, name, "set var" if role == "AnySet" else "var")


def _template(
    snapshot: Snapshot, file: FileAnalysis, placed: PlacedDeclaration, owner: str
) -> tuple[Site, tree.Template] | None:
    """Return the template that a qualified variable belongs to; without a qualifier the one around it."""
    for entry in file.declarations if owner else (placed,):
        root = entry.declaration.tree
        if isinstance(root, tree.Template) and owner in ("", root.name.text):
            return Site(snapshot, file, entry), root
    return None


def _variable(site: Site, template: tree.Template, name: str, words: str) -> Iterator[Fix]:
    before = [*template.variables, *(part for part in (template.task, template.duration) if part is not None)]
    if not before:
        return
    last = max(before[: len(template.variables)] or before, key=lambda node: node.span)
    document = site.file.document
    end = site.span(last).end
    if isinstance(last, tree.Ref):
        end = document.text.index(">", end) + 1
    end = _line_end(document, end)
    edit = Edit(site.uri, Span(end, end), f"\n    {words} {name}")
    yield Fix(f"Declare '{words} {name}' in '{template.name.text}'", (edit,))


def _other_role(
    snapshot: Snapshot, file: FileAnalysis, placed: PlacedDeclaration, reference: Reference
) -> Iterator[Fix]:
    """Yield the keyword that fits what a link names: ``ws set <places>`` instead of ``obj set <places>``."""
    root = placed.declaration.tree
    nodes = walk(root) if root is not None else ()
    link = next((node for node in nodes if isinstance(node, tree.Link) and node.reference == reference.ref), None)
    scope = snapshot.scope(file.document.uri)
    found = [declared for path in candidates(reference) for _, declared in scope.find(path)]
    if link is None or root is None or not found:
        return
    kind = found[0].symbol.kind
    match root:
        case tree.Scene():
            allowed = (*_SETS, SymbolKind.COMPOSITION)
        case tree.Composition():
            allowed = (SymbolKind.OBJECT, SymbolKind.WORKSPACE, SymbolKind.COMPOSITION)
        case _:
            allowed = (*_SETS, SymbolKind.CONSTANT_SET)
    start = link.span.start + placed.offset
    end = file.document.text.rfind("<", start, reference.ref.span.start + placed.offset)
    if kind in allowed and end >= 0:
        edit = Edit(file.document.uri, Span(start, end), f"{_KEYWORDS[kind]} ")
        yield Fix(f"Change to '{_KEYWORDS[kind]} <{reference.ref.path}>'", (edit,))


def _below(file: FileAnalysis, kinds: tuple[type[tree.Node], ...], line: str) -> Edit:
    """Return the edit that adds a line below the last declaration of the first kind of which there is one."""
    document = file.document
    for kind in kinds:
        ends = [
            placed.declaration.tree.span.end + placed.offset
            for placed in file.declarations
            if isinstance(placed.declaration.tree, kind)
        ]
        if ends:
            end = _line_end(document, ends[-1])
            return Edit(document.uri, Span(end, end), f"\n{line}")
    start = 1 if document.text.startswith("\ufeff") else 0
    return Edit(document.uri, Span(start, start), f"{line}\n")


def _line_end(document: Document, offset: int) -> int:
    """Return the end of the line of an offset if only white space and a comment follow there, else the offset."""
    place = document.position(offset)
    rest = document.line_text(place.line)[place.column :]
    is_last = not rest.strip() or rest.lstrip().startswith("//")
    return offset + len(rest) if is_last else offset
