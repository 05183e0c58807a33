"""Parts of bundles of evidence, which are ZIP archives with a list of their contents."""

from __future__ import annotations

import hashlib
import json
import os
import zipfile
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.printable import printable_json
from robbdd_tools.base.writing import replacing_bytes

FORMAT = 1
CONTENTS = "bundle.json"
SOURCES = "sources"
_DATE = (1980, 1, 1, 0, 0, 0)
"""All entries have this date, the earliest one that a ZIP archive can have."""


class NoEvidence(RobbddError):
    """A run or a study cannot be written as a bundle; the message gives the reason."""


@dataclass(frozen=True, slots=True)
class Bundle:
    """A bundle that was written: the SHA-256 of its list of contents, and the number of its traces or executions."""

    digest: str
    traces: int


@dataclass(frozen=True, slots=True)
class Check:
    """One property of a bundle.

    ``problems`` contradict it. ``unchecked`` is the reason why some or all of it could not be checked. ``detail`` says
    what was checked.
    """

    name: str
    detail: str
    problems: tuple[str, ...] = ()
    unchecked: str = ""


def json_bytes(document: Any) -> bytes:
    """Return a document as the JSON of a bundle."""
    return (printable_json(json.loads(json.dumps(document)), indent=1) + "\n").encode()


def sha256(data: bytes) -> str:
    """Return the SHA-256 of some bytes in hexadecimal digits."""
    return hashlib.sha256(data).hexdigest()


def source_names(texts: Iterable[Path]) -> dict[Path, str]:
    """Map files to their names in a bundle: their paths below a common folder."""
    paths = list(texts)
    root = Path(os.path.commonpath([path.parent for path in paths]))
    return {path: f"{SOURCES}/{path.relative_to(root).as_posix()}" for path in paths}


def entry_of(path: Path, names: Iterable[str]) -> str:
    """Return the name of a file in a bundle: the longest one that is an ending of its path."""
    ending = path.resolve().as_posix()
    found = [name for name in names if ending.endswith(f"/{PurePosixPath(name).relative_to(SOURCES).as_posix()}")]
    return max(found, key=len)


def write_archive(output: Path, contents: Mapping[str, Any], files: Mapping[str, bytes]) -> str:
    """Write a bundle and return its digest. ``contents`` gets the digests of the files. Raises ``OSError``."""
    listed = {name: sha256(data) for name, data in sorted(files.items())}
    head = json_bytes({"format": FORMAT, **contents, "files": listed})
    with replacing_bytes(output) as file, zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in ((CONTENTS, head), *sorted(files.items())):
            entry = zipfile.ZipInfo(name, _DATE)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, data)
    return sha256(head)
