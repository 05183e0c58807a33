"""Paths in an import, half typed: the folders and model files that it can go on to."""

from __future__ import annotations

import re
from collections.abc import Iterator
from urllib.parse import quote, urljoin

from robbdd_tools.base.files import uri_to_path
from robbdd_tools.names.imports import IMPORTABLE
from robbdd_tools.names.index import language_of

_IMPORT = re.compile(r"import\s*[\"']([^\"']*)\Z")


def typed_path(text: str) -> str | None:
    """Return the part of an import's path that a text ends in; ``None`` outside of such a path."""
    match = _IMPORT.search(text)
    return None if match is None else match[1]


def import_paths(uri: str, typed: str) -> Iterator[tuple[str, bool]]:
    """Yield what may follow the last ``/`` of a typed path, and whether it is a folder (which ends in ``/``)."""
    own = uri_to_path(uri)
    folder = uri_to_path(urljoin(uri, quote(typed[: typed.rfind("/") + 1]) or "./"))
    if own is None or folder is None:
        return
    try:
        entries = sorted(folder.iterdir())
    except OSError:
        return
    kinds = IMPORTABLE.get(language_of(uri), ())
    for entry in entries:
        if entry.name.startswith("."):
            continue
        if entry.is_dir():
            yield f"{entry.name}/", True
        elif language_of(entry.name) in kinds and entry != own:
            yield entry.name, False
