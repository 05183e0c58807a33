"""Loads the models that a command names, and prints what is wrong with them."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.document import Document, Span
from robbdd_tools.base.files import path_to_uri, read_text, uri_to_path
from robbdd_tools.base.printable import printable_json
from robbdd_tools.base.user_settings import user_file
from robbdd_tools.commands.output import print_note
from robbdd_tools.features.diagnostics import all_diagnostics
from robbdd_tools.graph.foreign import GRAPH_FORMATS, graph_format
from robbdd_tools.names.index import FileIndex, language_of
from robbdd_tools.names.project import Project, Snapshot
from robbdd_tools.syntax.parse import LANGUAGES

HOSTS = "context-hosts"
HOSTS_FORM = 'a list of host names, such as ["example.org"]'


def load(paths: Iterable[Path]) -> tuple[Snapshot, list[str]]:
    """Load files into a fresh project; returns its snapshot and the URIs of the files."""
    project = Project()
    uris = [path_to_uri(path) for path in paths]
    for uri in uris:
        project.load(uri)
    return project.snapshot(), uris


def model_files(paths: Iterable[Path]) -> list[Path]:
    """Replace each folder by the model files below it, in alphabetical order.

    What is not the project's own is passed over: hidden folders, installed packages and virtual environments.
    """
    files: dict[Path, None] = {}
    for path in paths:
        if path.is_dir():
            files |= dict.fromkeys(sorted(_own_files(path)))
        else:
            files.setdefault(path)
    return list(files)


def _own_files(folder: Path) -> Iterator[Path]:
    for parent, folders, names in os.walk(folder):
        here = Path(parent)
        folders[:] = [name for name in folders if not _is_foreign(here / name)]
        yield from (here / name for name in names if Path(name).suffix[1:] in LANGUAGES)


def _is_foreign(folder: Path) -> bool:
    return folder.name.startswith(".") or folder.name == "node_modules" or (folder / "pyvenv.cfg").is_file()


def not_a_model(paths: Iterable[Path]) -> str | None:
    """Return what to say when one of some files cannot be a model by its name; ``None`` when all can."""
    for path in paths:
        if not (language_of(path.name) or graph_format(path.name) or path.is_dir()):
            if not path.exists():
                return f"robbdd: there is no file or folder {path}"
            endings = ", ".join(f".{ending}" for ending in (*LANGUAGES, *GRAPH_FORMATS))
            return f"robbdd: {path} is not a model: its name must end in one of {endings}"
    return None


def fetch_contexts(paths: Iterable[Path], hosts: Iterable[str]) -> str | None:
    """Fetch the JSON-LD contexts of models from hosts that the user allows; returns what to say when one fails.

    Allowed are ``hosts`` and those of ``context-hosts`` in the user's own configuration; the setting of the model's
    project is reported as ignored. What was fetched is kept, so that reading the models later needs no network.
    """
    allowed = frozenset(hosts)
    for path in paths:
        if graph_format(path.name) == "json-ld":
            failure = _fetch(path, allowed)
            if failure is not None:
                return failure
    return None


def _fetch(path: Path, hosts: frozenset[str]) -> str | None:
    from robbdd_tools.graph.configuration import nearest_setting, user_setting
    from robbdd_tools.graph.contexts import ContextLoader
    from robbdd_tools.graph.serialize import UnreadableGraph, parse

    setting = user_setting(HOSTS, HOSTS_FORM)
    for fault in setting.faults if setting else ():
        return f"{_place(Project().snapshot(), fault.uri, fault.span)}: error: {fault.message} [{fault.code}]"
    allowed = hosts.union(setting.values if setting else ())
    stated = nearest_setting(path_to_uri(path), HOSTS, HOSTS_FORM)
    if stated is not None and not allowed.issuperset(stated.values):
        place = stated.fault(
            f"'{HOSTS}' is ignored here, as a folder cannot permit itself to use the network: "
            f"give '--allow-host HOST', or write the setting into {user_file()}"
        )
        print_note(f"{_place(Project().snapshot(), place.uri, place.span)}: warning: {place.message} [{place.code}]")
    text = read_text(path)
    if not allowed or not isinstance(text, str):
        return None
    try:
        parse(text, "json-ld", path_to_uri(path), ContextLoader(allowed))
    except UnreadableGraph as error:
        return f"robbdd: {path}: {error}"
    return None


def sound_model(path: Path) -> Snapshot | None:
    """Load one model for a command that needs it whole; prints its errors and returns ``None`` if it has any."""
    stranger = not_a_model([path])
    if stranger is not None:
        print_note(stranger)
        return None
    snapshot, (uri,) = load([path])
    errors = [found for found in all_diagnostics(snapshot, uri) if found.severity is Severity.ERROR]
    for error in errors:
        print_diagnostic(snapshot, error, print_note)
    return None if errors else snapshot


def print_diagnostic(snapshot: Snapshot, diagnostic: Diagnostic, print_: Callable[[str], None]) -> None:
    """Print a diagnostic as ``file:line:column: severity: message [code]`` with its related places below."""
    severity = diagnostic.severity.name.lower()
    place = _place(snapshot, diagnostic.uri, diagnostic.span)
    print_(f"{place}: {severity}: {diagnostic.message} [{diagnostic.code}]")
    for related in diagnostic.related:
        print_(f"    {_place(snapshot, related.uri, related.span)}: {related.message}")


def diagnostic_json(snapshot: Snapshot, diagnostic: Diagnostic) -> str:
    """Return a diagnostic as one line of the documented JSON."""
    related = [
        {"file": _shown(place.uri), "range": _range(snapshot, place.uri, place.span), "message": place.message}
        for place in diagnostic.related
    ]
    document = {
        "file": _shown(diagnostic.uri),
        "range": _range(snapshot, diagnostic.uri, diagnostic.span),
        "severity": diagnostic.severity.name.lower(),
        "code": diagnostic.code,
        "message": diagnostic.message,
        "related": related,
    }
    return printable_json(document)


def _document(snapshot: Snapshot, uri: str) -> Document:
    """Return a file of a snapshot, or one on disk that is no model: shapes, a configuration."""
    source = snapshot.sources.get(uri)
    if isinstance(source, FileIndex):
        return source.document
    path = uri_to_path(uri)
    text = read_text(path) if path is not None and source is None else ""
    return Document(uri, 0, text if isinstance(text, str) else "")


def _range(snapshot: Snapshot, uri: str, span: Span) -> dict[str, Any]:
    document = _document(snapshot, uri)
    start, end = document.position(span.start), document.position(span.end)
    return {
        "start": {"line": start.line + 1, "column": start.column + 1},
        "end": {"line": end.line + 1, "column": end.column + 1},
    }


def _place(snapshot: Snapshot, uri: str, span: Span) -> str:
    start = _document(snapshot, uri).position(span.start)
    return f"{_shown(uri)}:{start.line + 1}:{start.column + 1}"


def _shown(uri: str) -> str:
    """Return a path relative to the working folder where it lies below it."""
    path = uri_to_path(uri)
    if path is None:
        return uri
    try:
        return str(path.relative_to(Path.cwd()))
    except ValueError:
        return str(path)
