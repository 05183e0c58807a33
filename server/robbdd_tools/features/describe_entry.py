"""Describe completion proposals of every kind in Markdown, whether their file is loaded or not."""

from __future__ import annotations

from typing import TYPE_CHECKING
from urllib.parse import unquote

from robbdd_tools.base.files import file_state, uri_to_path
from robbdd_tools.base.quantity_units import UNITS
from robbdd_tools.catalog.settings import SETTINGS
from robbdd_tools.features.catalog_source import describe_catalog_entry
from robbdd_tools.features.describe import describe_import, describe_path, describe_words
from robbdd_tools.features.element_properties import describe_property
from robbdd_tools.features.literals import LITERAL_FORMS
from robbdd_tools.features.markdown import code, code_block
from robbdd_tools.features.model_parts_help import describe_file
from robbdd_tools.features.part_snippets import PART_SNIPPETS
from robbdd_tools.features.python_code import CODE_KINDS, describe_code
from robbdd_tools.features.snippets import declaration_snippets, keyword_form
from robbdd_tools.features.study_words import study_word_meaning
from robbdd_tools.names.index import language_of
from robbdd_tools.names.project import Project
from robbdd_tools.syntax.constructs import constructs_with
from robbdd_tools.syntax.study_content import STUDY

if TYPE_CHECKING:
    from robbdd_tools.names.project import Snapshot


def describe_entry(snapshot: Snapshot, kind: str, uri: str, path: str) -> str | None:
    """Describe a completion proposal.

    ``kind`` is the kind of the proposal. For a name, ``uri`` is the document that declares it and ``path`` is its
    qualified name. For a file, ``uri`` is its URI. For any other proposal, ``uri`` is the current document and ``path``
    is the label.
    """
    match kind:
        case "keyword":
            return _keyword(language_of(uri), path)
        case "snippet":
            return LITERAL_FORMS.get(path) or _snippet(language_of(uri), path)
        case "unit":
            return None if path not in UNITS else f"`{path}`, a unit of {UNITS[path][0]}"
        case "setting":
            setting = SETTINGS.get(path)
            return (
                None if setting is None else f"`{path}` of {setting.target}: {setting.doc}\n\nIt is {setting.wanted}."
            )
        case "property":
            return describe_property(snapshot, uri, path)
        case "catalog":
            return describe_catalog_entry(path)
        case "folder":
            return f"**folder** {code(unquote(uri.rstrip('/').rpartition('/')[2]))}"
        case kind if kind in CODE_KINDS:
            return describe_code(uri, path)
        case "file":
            return _file(snapshot, uri)
        case _:
            return describe_path(_with(snapshot, uri), uri, path)


def _keyword(language: str, words: str) -> str | None:
    if language == STUDY:
        return study_word_meaning(words)
    described = constructs_with(language, words.split()[0])
    if describe_words(words) is None and len(described) == 1:
        return described[0].markdown
    form = keyword_form(language, words)
    parts = (describe_words(words), None if form is None else code_block(form, language))
    return "\n\n".join(part for part in parts if part is not None) or None


def _snippet(language: str, label: str) -> str | None:
    if language == STUDY:
        return study_word_meaning("Study")
    declarations = (one.plain for one in declaration_snippets(language) if f"{one.label} …" == label)
    parts = (one.plain for one in PART_SNIPPETS.get(language, ()) if one.label == label)
    return next((code_block(body, language) for body in (*declarations, *parts)), None)


def _file(snapshot: Snapshot, uri: str) -> str:
    if language_of(uri):
        return describe_import(_with(snapshot, uri), uri)
    path = uri_to_path(uri)
    if path is not None and path.suffix.lower() in (".xml", ".mjcf", ".urdf") and path.is_file():
        return describe_file(path)
    state = file_state(uri)
    size = "" if state is None else f", {state.size:,} bytes"
    return f"**model file** `{unquote(uri.rpartition('/')[2])}`{size}"


def _with(snapshot: Snapshot, uri: str) -> Snapshot:
    """Return a snapshot that contains a file: the given snapshot, or a temporary one of that file."""
    if uri in snapshot.sources:
        return snapshot
    project = Project()
    project.load(uri)
    return project.snapshot()
