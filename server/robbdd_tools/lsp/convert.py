"""Convert between the data types of RobBDD and those of the protocol.

Only this module knows the units in which the client counts characters (UTF-8, UTF-16 or UTF-32).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache

from lsprotocol import types

from robbdd_tools.base.data import data_file
from robbdd_tools.base.diagnostic import Diagnostic, Edit
from robbdd_tools.base.document import Document, Span
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.features.name_completion import Completion
from robbdd_tools.names.project import Snapshot
from robbdd_tools.syntax.declaration import SymbolKind

SOURCE = "robbdd"
Texts = Snapshot | Mapping[str, Document]
"""Source of documents."""
_KINDS = types.CompletionItemKind
_COMPLETION_KINDS: Mapping[str, types.CompletionItemKind] = {
    "keyword": _KINDS.Keyword,
    "snippet": _KINDS.Snippet,
    "file": _KINDS.File,
    "folder": _KINDS.Folder,
    "catalog": _KINDS.Value,
    "topic": _KINDS.Interface,
    "type": _KINDS.Class,
    "field": _KINDS.Field,
    "frame": _KINDS.Reference,
    "joint": _KINDS.Reference,
    "node": _KINDS.Reference,
    "setting": _KINDS.Property,
    "property": _KINDS.Property,
    "unit": _KINDS.Unit,
    "class": _KINDS.Class,
    "function": _KINDS.Function,
    "module": _KINDS.Module,
    "value": _KINDS.Constant,
    SymbolKind.EVENT: _KINDS.Event,
    SymbolKind.PREDICATE: _KINDS.Function,
    SymbolKind.PARAMETER: _KINDS.Variable,
    SymbolKind.VARIABLE: _KINDS.Variable,
    SymbolKind.SET_VARIABLE: _KINDS.Variable,
    SymbolKind.TEMPLATE: _KINDS.Class,
    SymbolKind.SCENE: _KINDS.Module,
    SymbolKind.NAMESPACE: _KINDS.Module,
    SymbolKind.TASK: _KINDS.Constant,
    SymbolKind.REQUIREMENT: _KINDS.Reference,
}

_SYMBOL_KINDS: Mapping[str, types.SymbolKind] = {
    SymbolKind.NAMESPACE: types.SymbolKind.Namespace,
    SymbolKind.EVENT: types.SymbolKind.Event,
    SymbolKind.PREDICATE: types.SymbolKind.Boolean,
    SymbolKind.PARAMETER: types.SymbolKind.Variable,
    SymbolKind.TASK: types.SymbolKind.Constant,
    SymbolKind.REQUIREMENT: types.SymbolKind.Key,
    SymbolKind.TEMPLATE: types.SymbolKind.Class,
    SymbolKind.VARIABLE: types.SymbolKind.Variable,
    SymbolKind.SET_VARIABLE: types.SymbolKind.Variable,
    SymbolKind.FLUENT: types.SymbolKind.Boolean,
    SymbolKind.BEHAVIOUR: types.SymbolKind.Method,
    SymbolKind.STORY: types.SymbolKind.Package,
    SymbolKind.VARIANT: types.SymbolKind.Function,
    SymbolKind.SCENE: types.SymbolKind.Module,
}


@dataclass(frozen=True, slots=True)
class Converter:
    """The conversions for one client. ``encoding`` is the encoding agreed at initialisation.

    If ``with_pages`` is true, each diagnostic links to the page about its code.
    """

    encoding: types.PositionEncodingKind | str = types.PositionEncodingKind.Utf16
    with_pages: bool = False

    @classmethod
    def of(cls, encoding: str | None, client: types.ClientCapabilities) -> Converter:
        """Return the conversions for a client with the given capabilities."""
        published = client.text_document.publish_diagnostics if client.text_document is not None else None
        with_pages = bool(published is not None and published.code_description_support)
        return cls(encoding or types.PositionEncodingKind.Utf16, with_pages)

    def offset(self, document: Document, position: types.Position) -> int:
        """Return the code-point offset of a client position.

        A position beyond the end of a line is moved to the end of the line.
        """
        if position.line >= len(document.line_starts):
            return len(document.text)
        line = document.line_text(position.line)
        if line.isascii():
            return document.line_starts[position.line] + min(position.character, len(line))
        units = 0
        for column, letter in enumerate(line):
            if units >= position.character:
                return document.line_starts[position.line] + column
            units += self.units(letter)
        return document.line_starts[position.line] + len(line)

    def position(self, document: Document, offset: int) -> types.Position:
        """Return the client position of a code-point offset."""
        place = document.position(offset)
        line = document.line_text(place.line)[: place.column]
        return types.Position(line=place.line, character=self.units(line))

    def range(self, document: Document, span: Span) -> types.Range:
        """Return the client range of a span."""
        return types.Range(start=self.position(document, span.start), end=self.position(document, span.end))

    def span(self, document: Document, range: types.Range) -> Span:
        """Return the span of a client range in code points."""
        return Span(self.offset(document, range.start), self.offset(document, range.end))

    def location(self, snapshot: Texts, uri: str, span: Span) -> types.Location:
        """Return the client location of a span in any file of a snapshot."""
        return types.Location(uri=uri, range=self.range(document_of(snapshot, uri), span))

    def diagnostic(self, snapshot: Texts, diagnostic: Diagnostic) -> types.Diagnostic:
        """Return a diagnostic for the client."""
        document = document_of(snapshot, diagnostic.uri)
        related = [
            types.DiagnosticRelatedInformation(
                location=self.location(snapshot, place.uri, place.span), message=place.message
            )
            for place in diagnostic.related
        ]
        return types.Diagnostic(
            range=self.range(document, diagnostic.span),
            message=diagnostic.message,
            severity=types.DiagnosticSeverity(diagnostic.severity),
            code=diagnostic.code,
            source=SOURCE,
            related_information=related or None,
            tags=_tags(diagnostic.code),
            code_description=self.code_description(diagnostic.code),
        )

    def code_description(self, code: str) -> types.CodeDescription | None:
        """Return the link to the page about a diagnostic code, if the client can show it."""
        page = code_page(code) if self.with_pages else None
        return None if page is None else types.CodeDescription(href=page)

    def completion(
        self, document: Document, completion: Completion, client: types.ClientCompletionItemOptions | None
    ) -> types.CompletionItem | None:
        """Return a completion in the client's form. The client matches it against the text that it replaces."""
        snippets = client is not None and bool(client.snippet_support)
        if completion.kind == "snippet" and not snippets:
            return None
        uri, path = completion.origin or (document.uri, completion.label)
        data = {"kind": str(completion.kind), "uri": uri, "path": path}
        range = self.range(document, completion.span)
        edit: types.TextEdit | types.InsertReplaceEdit = types.TextEdit(range=range, new_text=completion.text)
        if client is not None and client.insert_replace_support:
            whole = self.range(document, completion.whole)
            edit = types.InsertReplaceEdit(new_text=completion.text, insert=range, replace=whole)
        is_snippet = completion.kind == "snippet"
        return types.CompletionItem(
            label=completion.label,
            kind=_COMPLETION_KINDS.get(completion.kind, _KINDS.Value),
            detail=completion.detail or None,
            filter_text=completion.label if is_snippet else completion.text,
            sort_text=f"{completion.rank} {completion.label}",
            insert_text_format=types.InsertTextFormat.Snippet if is_snippet else None,
            text_edit=edit,
            additional_text_edits=[self.edit(document, entry) for entry in completion.edits] or None,
            data=data,
        )

    def edit(self, document: Document, edit: Edit) -> types.TextEdit:
        """Return the client's form of an edit of one document."""
        return types.TextEdit(range=self.range(document, edit.span), new_text=edit.text)

    def workspace_edit(self, snapshot: Snapshot, edits: Iterable[Edit]) -> types.WorkspaceEdit:
        """Return the client's form of edits in any files of a snapshot."""
        changes: dict[str, list[types.TextEdit]] = {}
        for edit in edits:
            changes.setdefault(edit.uri, []).append(self.edit(document_of(snapshot, edit.uri), edit))
        return types.WorkspaceEdit(changes=changes)

    def units(self, text: str) -> int:
        """Return the length of a text in the client's units."""
        if text.isascii() or self.encoding == types.PositionEncodingKind.Utf32:
            return len(text)
        if self.encoding == types.PositionEncodingKind.Utf8:
            return len(text.encode("utf-8", "surrogatepass"))
        return len(text.encode("utf-16-le", "surrogatepass")) // 2


def document_of(texts: Texts, uri: str) -> Document:
    """Return the document of a file.

    For an unreadable file, the document is empty, so that all places in it are the start.
    """
    return texts.document(uri) if isinstance(texts, Snapshot) else texts.get(uri, Document(uri, 0, ""))


def _tags(code: str) -> list[types.DiagnosticTag] | None:
    if code.startswith("unused-"):
        return [types.DiagnosticTag.Unnecessary]
    return [types.DiagnosticTag.Deprecated] if code == "published-form" else None


@cache
def code_page(code: str) -> str | None:
    """Return the URI of the page about a diagnostic code, or about the family of codes to which it belongs.

    The pages are installed with the package, so they match its version and can be read offline.
    """
    for name in (code, code.partition("-")[0]):
        try:
            return path_to_uri(data_file("docs/diagnostics", f"{name}.md"))
        except FileNotFoundError:
            continue
    return None


def symbol_kind(kind: str) -> types.SymbolKind:
    """Return the protocol's symbol kind closest to one of ours."""
    return _SYMBOL_KINDS.get(kind, types.SymbolKind.Object)


def markup(markdown: str, formats: Sequence[types.MarkupKind] | None) -> types.MarkupContent:
    """Return a text in the format that the client prefers. Without support for Markdown, this is plain text."""
    if formats and types.MarkupKind.Markdown in formats:
        return types.MarkupContent(kind=types.MarkupKind.Markdown, value=markdown)
    plain = re.sub(r"^```.*\n?|\*\*|`|^> ", "", markdown, flags=re.MULTILINE)
    return types.MarkupContent(kind=types.MarkupKind.PlainText, value=plain)
