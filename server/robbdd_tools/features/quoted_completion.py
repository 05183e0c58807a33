"""Completion inside quotes: the path of an import, the path of a model file, or a name in the catalog."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from urllib.parse import quote, urljoin

from robbdd_tools.base.files import path_to_uri, uri_to_path
from robbdd_tools.base.model_paths import package_share, packages
from robbdd_tools.checks.catalog_entry import known_entries
from robbdd_tools.logs.log_files import SUFFIXES
from robbdd_tools.names.imports import importable_extensions
from robbdd_tools.names.index import language_of

_IMPORT = re.compile(r"import\s*[\"']([^\"']*)\Z")
_MODEL = re.compile(r"\bsys\s+path\s*=\s*[\"']([^\"']*)\Z")
_ENTRY = re.compile(r"\bcatalog\s*[\"']([^\"']*)\Z")
_LOG = re.compile(r"\bpath\s*:\s*[\"']([^\"']*)\Z")
_ANNOTATIONS = re.compile(r"\bannotations\s*:\s*[\"']([^\"']*)\Z")
_PACKAGE = re.compile(r"\bros\s+pkg\s*=\s*[\"']([^\"']*)\Z")
_PACKAGED = re.compile(r"\bros\s+pkg\s*=\s*[\"']([^\"']*)[\"']\s*,\s*path\s*=\s*[\"']([^\"']*)\Z")
MODEL_ENDINGS: Mapping[str, frozenset[str]] = {
    "mjcf": frozenset({".xml", ".mjcf"}),
    "urdf": frozenset({".urdf", ".xml"}),
    "usd": frozenset({".usd", ".usda", ".usdc"}),
}
"""File extensions of each model format."""


def quoted(uri: str, line: str) -> Iterator[tuple[str, str, str, str]]:
    """Yield the completions inside the open quotes at the end of a line.

    Each one has a name, a kind, the part of the name that is already typed, and the URI of its file (or ``""``).
    """
    if match := _ENTRY.search(line):
        yield from ((name, "catalog", match[1], "") for name in sorted(known_entries(language_of(uri))))
        return
    if match := _PACKAGE.search(line):
        yield from ((name, "folder", match[1], "") for name in packages())
        return
    if match := _PACKAGED.search(line):
        folder, _, last = match[2].rpartition("/")
        share = package_share(match[1])[0]
        for entry in () if share is None else _listed(share / folder):
            if entry.is_dir() or entry.suffix.lower() in frozenset[str]().union(*MODEL_ENDINGS.values()):
                name, kind = (f"{entry.name}/", "folder") if entry.is_dir() else (entry.name, "file")
                yield name, kind, last, path_to_uri(entry)
        return
    wanted = frozenset(f".{kind}" for kind in importable_extensions(language_of(uri)))
    match = _IMPORT.search(line)
    for form, endings in ((_LOG, SUFFIXES), (_ANNOTATIONS, (".csv",))):
        if match is None and (match := form.search(line)):
            wanted = frozenset(endings)
    if match is None:
        match, wanted = _MODEL.search(line), frozenset[str]().union(*MODEL_ENDINGS.values())
    if match is not None:
        yield from files_in_quotes(uri, match[1], wanted)


def files_in_quotes(uri: str, typed: str, endings: Collection[str]) -> Iterator[tuple[str, str, str, str]]:
    """Yield the folders, and the files with the given extensions, that may continue a path, as in ``quoted``."""
    folder, _, last = typed.rpartition("/")
    for name, kind in _entries(uri, folder and f"{folder}/", endings):
        # A name on disk may contain bytes that are not UTF-8, and the typed text may end with half a character.
        above = f"{quote(folder, errors='surrogatepass')}/" if folder else ""
        yield name, kind, last, urljoin(uri, above + quote(name, errors="surrogateescape"))


def _entries(uri: str, folder: str, endings: Collection[str]) -> Iterator[tuple[str, str]]:
    """Yield the folders in a folder (ending in ``/``) and its files with the given extensions, as relative paths."""
    own, place = uri_to_path(uri), uri_to_path(urljoin(uri, quote(folder, errors="surrogatepass") or "./"))
    if own is None or place is None:
        return
    for entry in _listed(place):
        if entry.is_dir():
            yield f"{entry.name}/", "folder"
        elif entry.suffix.lower() in endings and entry != own:
            yield entry.name, "file"


def _listed(folder: Path) -> list[Path]:
    try:
        return sorted(entry for entry in folder.iterdir() if not entry.name.startswith("."))
    except OSError:
        return []
