"""Protocol methods that change texts: formatting, linked editing, refactorings, file moves."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator

from lsprotocol import types

from robbdd_tools.base.diagnostic import Edit, Fix, NewFile
from robbdd_tools.base.document import Document, Span
from robbdd_tools.features.format_range import format_on_type, format_range
from robbdd_tools.features.refactor_clauses import extracted_clauses
from robbdd_tools.features.refactor_declarations import modernised, split_scene
from robbdd_tools.features.refactor_literals import literal_as_variable
from robbdd_tools.features.refactor_variations import variation_refactorings
from robbdd_tools.features.rename import linked_places
from robbdd_tools.features.rename_files import ImportLines, affected_files, import_edits
from robbdd_tools.features.workspace_files import model_files
from robbdd_tools.lsp.convert import document_of
from robbdd_tools.lsp.server import RobbddServer
from robbdd_tools.names.index import FileIndex
from robbdd_tools.names.project import Snapshot
from robbdd_tools.syntax.parse import LANGUAGES


def register_editing(server: RobbddServer) -> None:
    """Add the methods to a server."""
    _register_formatting(server)
    _register_linked(server)
    _register_moves(server)


def refactorings(ls: RobbddServer, snapshot: Snapshot, uri: str, span: Span) -> Iterator[types.CodeAction]:
    """Yield the refactorings at a selection."""
    kinds = types.CodeActionKind
    found: list[tuple[Fix | None, types.CodeActionKind]] = []
    for fix in variation_refactorings(snapshot, uri, span):
        inline = fix.title.startswith("Write the values")
        found.append((fix, kinds.RefactorInline if inline else kinds.RefactorRewrite))
    found += [
        (extracted_clauses(snapshot, uri, span), kinds.RefactorExtract),
        (literal_as_variable(snapshot, uri, span), kinds.RefactorExtract),
        (modernised(snapshot, uri), kinds.RefactorRewrite),
        (split_scene(snapshot, uri, span.start), kinds.RefactorExtract),
    ]
    for fix, kind in found:
        edit = None if fix is None else edit_of(ls, snapshot, fix)
        if fix is not None and edit is not None:
            yield types.CodeAction(title=fix.title, kind=kind, edit=edit)


def edit_of(ls: RobbddServer, snapshot: Snapshot, fix: Fix) -> types.WorkspaceEdit | None:
    """Return the change that a fix or refactoring makes. Return ``None`` if it creates a file and the client cannot."""
    if fix.new_file is None:
        return ls.convert.workspace_edit(snapshot, fix.edits)
    return _with_new_file(ls, snapshot, fix, fix.new_file) if _creates_files(ls) else None


def _register_formatting(server: RobbddServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_FORMATTING)
    async def formatting(ls: RobbddServer, params: types.DocumentFormattingParams) -> list[types.TextEdit]:
        def find(snapshot: Snapshot) -> list[types.TextEdit]:
            document = document_of(snapshot, params.text_document.uri)
            return _edits(ls, document, format_range(document, Span(0, len(document.text))))

        return await ls.analyse(find)

    @server.feature(types.TEXT_DOCUMENT_RANGE_FORMATTING)
    async def part(ls: RobbddServer, params: types.DocumentRangeFormattingParams) -> list[types.TextEdit]:
        def find(snapshot: Snapshot) -> list[types.TextEdit]:
            document = document_of(snapshot, params.text_document.uri)
            return _edits(ls, document, format_range(document, ls.convert.span(document, params.range)))

        return await ls.analyse(find)

    options = types.DocumentOnTypeFormattingOptions(first_trigger_character="\n", more_trigger_character=["}", "|"])

    @server.feature(types.TEXT_DOCUMENT_ON_TYPE_FORMATTING, options)
    async def typed(ls: RobbddServer, params: types.DocumentOnTypeFormattingParams) -> list[types.TextEdit]:
        def find(snapshot: Snapshot) -> list[types.TextEdit]:
            document = document_of(snapshot, params.text_document.uri)
            offset = ls.convert.offset(document, params.position)
            return _edits(ls, document, format_on_type(document, offset, params.ch))

        return await ls.analyse(find)


def _register_linked(server: RobbddServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_LINKED_EDITING_RANGE)
    async def linked(ls: RobbddServer, params: types.LinkedEditingRangeParams) -> types.LinkedEditingRanges | None:
        def find(snapshot: Snapshot) -> types.LinkedEditingRanges | None:
            document = document_of(snapshot, params.text_document.uri)
            spans = linked_places(snapshot, document.uri, ls.convert.offset(document, params.position))
            if len(spans) < 2:
                return None
            ranges = [ls.convert.range(document, span) for span in spans]
            return types.LinkedEditingRanges(ranges=ranges, word_pattern=r"[\w\-]*")

        await ls.importers.looked_around()
        return await ls.analyse(find)


def _register_moves(server: RobbddServer) -> None:
    patterns = [f"**/*.{language}" for language in LANGUAGES]
    filters = [types.FileOperationFilter(pattern=types.FileOperationPattern(glob=glob)) for glob in patterns]
    folders = types.FileOperationPattern(glob="**", matches=types.FileOperationPatternKind.Folder)
    options = types.FileOperationRegistrationOptions(
        filters=[*filters, types.FileOperationFilter(pattern=folders, scheme="file")]
    )

    @server.feature(types.WORKSPACE_WILL_RENAME_FILES, options)
    async def will_rename(ls: RobbddServer, params: types.RenameFilesParams) -> types.WorkspaceEdit | None:
        moves = {file.old_uri: file.new_uri for file in params.files}
        roots = [folder.uri for folder in ls.workspace.folders.values()]

        on_disk = await asyncio.to_thread(lambda: list(affected_files(model_files(roots), moves)))

        def find(snapshot: Snapshot) -> types.WorkspaceEdit | None:
            files: dict[str, FileIndex | ImportLines] = {file.document.uri: file for file in on_disk}
            # Prefer the project's text to the disk: the file may be open and modified.
            files |= {uri: source for uri, source in snapshot.sources.items() if isinstance(source, FileIndex)}
            changes: dict[str, list[types.TextEdit]] = {}
            for edit in import_edits(files.values(), moves):
                changes.setdefault(edit.uri, []).append(ls.convert.edit(files[edit.uri].document, edit))
            return types.WorkspaceEdit(changes=changes) if changes else None

        return await ls.analyse(find)


def _edits(ls: RobbddServer, document: Document, edits: list[Edit]) -> list[types.TextEdit]:
    return [ls.convert.edit(document, edit) for edit in edits]


def _creates_files(ls: RobbddServer) -> bool:
    workspace = ls.client_capabilities.workspace
    abilities = workspace.workspace_edit if workspace is not None else None
    if abilities is None or not abilities.document_changes:
        return False
    return types.ResourceOperationKind.Create in (abilities.resource_operations or ())


def _with_new_file(ls: RobbddServer, snapshot: Snapshot, fix: Fix, new: NewFile) -> types.WorkspaceEdit:
    start = types.Position(line=0, character=0)
    filled = types.TextEdit(range=types.Range(start=start, end=start), new_text=new.text)
    changes: dict[str, list[types.TextEdit]] = {new.uri: [filled]}
    for edit in fix.edits:
        changes.setdefault(edit.uri, []).append(ls.convert.edit(document_of(snapshot, edit.uri), edit))
    documents = [
        types.TextDocumentEdit(
            text_document=types.OptionalVersionedTextDocumentIdentifier(uri=uri, version=None), edits=list(edits)
        )
        for uri, edits in changes.items()
    ]
    return types.WorkspaceEdit(document_changes=[types.CreateFile(uri=new.uri), *documents])
