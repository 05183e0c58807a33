"""Fixes for unresolved names and names of the wrong kind, added to the diagnostics of name resolution."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix
from robbdd_tools.base.document import Span
from robbdd_tools.checks.lines import import_edit, line_below, line_end
from robbdd_tools.features.unimported import Importable, loaded
from robbdd_tools.names.elements import Site
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
_SETS = (SymbolKind.OBJECT_SET, SymbolKind.WORKSPACE_SET, SymbolKind.AGENT_SET)


def with_fixes(snapshot: Snapshot, file: FileAnalysis, found: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """Yield the diagnostics of name resolution, each with the quick fixes that the loaded files allow."""
    for diagnostic in found:
        if diagnostic.code not in ("unknown-name", "wrong-kind"):
            yield diagnostic
            continue
        used = reference_at(file, diagnostic.span)
        fixes = () if used is None else _fixes(snapshot, file, *used, diagnostic.code)
        # A wrong keyword is more likely than a wrong name, and a similar name is more likely than a new declaration.
        every = (*fixes, *diagnostic.fixes) if diagnostic.code == "wrong-kind" else (*diagnostic.fixes, *fixes)
        yield replace(diagnostic, fixes=every)


def _fixes(
    snapshot: Snapshot, file: FileAnalysis, placed: PlacedDeclaration, reference: Reference, code: str
) -> tuple[Fix, ...]:
    if code == "wrong-kind":
        return tuple(_other_role(snapshot, file, placed, reference))
    others = loaded(snapshot, file.document.uri)
    return (*imports_of(file, reference, others), *_declarations(snapshot, file, placed, reference))


def reference_at(file: FileAnalysis, span: Span) -> tuple[PlacedDeclaration, Reference] | None:
    """Return the reference at a span."""
    for placed in file.declarations:
        if placed.span.contains(span.start):
            for reference in placed.declaration.references:
                if reference.ref.span.shifted(placed.offset) == span:
                    return placed, reference
    return None


def imports_of(file: FileAnalysis, reference: Reference, others: Iterable[Importable]) -> Iterator[Fix]:
    """Yield a fix for each file that declares the missing name with the right kind.

    The fix adds the import of that file.
    """
    kinds = ROLE_KINDS[reference.ref.role]
    for other in others:
        if any(kind in kinds for kind in other.names.get(reference.ref.path, ())):
            yield Fix(f"Import '{other.path}'", (import_edit(file, other.path),))


def _declarations(
    snapshot: Snapshot, file: FileAnalysis, placed: PlacedDeclaration, reference: Reference
) -> Iterator[Fix]:
    """Yield the declaration of a missing event, task, requirement or variable."""
    role, path = reference.ref.role, reference.ref.path
    namespace = placed.declaration.symbols[0].namespace if placed.declaration.symbols else None
    argument = "" if namespace == FILE_NAMESPACE else f"(ns={namespace}) "
    if role in ("Event", "Task", "Requirement") and "." not in path and namespace is not None:
        body = ' { "" }' if role == "Requirement" else ""
        above = (tree.Event, tree.Task, tree.Namespace, tree.Import)
        above = (tree.Requirement, *above) if role == "Requirement" else above
        edit = line_below(file, above, f"{role} {argument}{path}{body}")
        yield Fix(f"Declare the {role.lower()} '{path}'", (edit,))
    if role in ("Variable", "Term", "AnySet"):
        owner, _, name = path.rpartition(".")
        template = _template(snapshot, file, placed, owner)
        if template is not None and "." not in owner:
            yield from _variable(*template, name, "set var" if role == "AnySet" else "var")


def _template(
    snapshot: Snapshot, file: FileAnalysis, placed: PlacedDeclaration, owner: str
) -> tuple[Site, tree.Template] | None:
    """Return the template that declares a qualified variable.

    ``owner`` is the qualifier. Without a qualifier, it is the template in which the variable is used.
    """
    for entry in file.declarations if owner else (placed,):
        root = entry.declaration.tree
        if isinstance(root, tree.Template) and owner in ("", root.name.text):
            return Site(snapshot, file, entry), root
    return None


def _variable(site: Site, template: tree.Template, name: str, words: str) -> Iterator[Fix]:
    text = site.file.document.text
    parts = [*template.variables, *(part for part in (template.task, template.duration) if part is not None)]
    # The published form states the duration inside the body.
    before = [part for part in parts if part.span.start < template.body.span.start]
    if before:
        last = max(before[: len(template.variables)] or before, key=lambda node: node.span)
        end = site.span(last).end
        if isinstance(last, tree.Ref):
            end = text.index(">", end) + 1
    else:
        end = text.index("{", site.span(template.name).end) + 1
    end = line_end(site.file.document, end)
    edit = Edit(site.uri, Span(end, end), f"\n    {words} {name}")
    yield Fix(f"Declare '{words} {name}' in '{template.name.text}'", (edit,))


def _other_role(
    snapshot: Snapshot, file: FileAnalysis, placed: PlacedDeclaration, reference: Reference
) -> Iterator[Fix]:
    """Yield a fix that replaces the keyword before a link by the one that matches the kind of its target.

    For example, ``obj set <places>`` becomes ``ws set <places>``.
    """
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
