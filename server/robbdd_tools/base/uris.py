"""Convert between ``file:`` URIs and paths of POSIX and Windows.

A file has several URIs, because clients differ in the characters that they escape, in the case of a drive letter, and
in whether they write ``file:/`` or ``file:///``. Inside RobBDD, each file has a single URI, which is the one that VS
Code uses.
"""

from __future__ import annotations

import re
from pathlib import PurePath, PureWindowsPath
from urllib.parse import quote, unquote

HERE = type(PurePath())
"""The path class of this system."""
_FILE = re.compile(r"file:(?://([^/?#]*))?(/[^?#]*)", re.IGNORECASE)
_DRIVE = re.compile(r"/([A-Za-z]):(?=/|$)")


def path_of(uri: str, kind: type[PurePath] = HERE) -> PurePath | None:
    """Return the path of a ``file:`` URI. Return ``None`` for other URIs and, on POSIX, for a file of another host."""
    found = _FILE.fullmatch(uri)
    if found is None:
        return None
    host, path = _host(found[1]), unquote(found[2], errors="surrogateescape")
    if issubclass(kind, PureWindowsPath):
        return kind(f"//{host}{path}") if host else kind(_DRIVE.sub(r"\1:", path, count=1))
    return None if host else kind(path)


def uri_of(path: PurePath) -> str:
    """Return the URI of an absolute path."""
    text = quote(path.as_posix(), errors="surrogateescape")
    if isinstance(path, PureWindowsPath):
        # A UNC path names its host; a drive is on this machine.
        text = f"file:{text}" if text.startswith("//") else f"file:///{text}"
    else:
        text = f"file://{text}"
    return canonical_uri(text, type(path))


def drive_uri(path: str, kind: type[PurePath] | None = None) -> str | None:
    """Return the URI of a path that begins with a drive.

    Return ``None`` for other paths and on systems without drives.
    """
    found = (kind or HERE)(path)
    return uri_of(found) if isinstance(found, PureWindowsPath) and found.drive and found.is_absolute() else None


def canonical_uri(uri: str, kind: type[PurePath] = HERE) -> str:
    """Return the canonical URI of a file. Other URIs are returned unchanged."""
    found = _FILE.fullmatch(uri)
    if found is None:
        return uri
    path = unquote(found[2], errors="surrogateescape")
    if issubclass(kind, PureWindowsPath):
        path = _DRIVE.sub(lambda drive: drive[0].lower(), path, count=1)
    return f"file://{_host(found[1])}{quote(path, errors='surrogateescape')}"


def _host(stated: str | None) -> str:
    host = (stated or "").lower()
    return "" if host == "localhost" else host
