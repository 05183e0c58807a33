"""Pack a prepared run and the files that it uses, so that another machine can execute it.

The files keep their places relative to each other: a folder on the other machine replaces the root of the file system,
and the paths in the manifest point into this folder. Messages get the original paths back.
"""

from __future__ import annotations

import errno
import gzip
import hashlib
import io
import json
import re
import shutil
import tarfile
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast
from urllib.parse import quote

from robbdd_tools.base.files import full_path, load_bytes, load_text, uri_to_path
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.base.writing import replace_file
from robbdd_tools.protocol.manifest_file import MANIFEST
from robbdd_tools.protocol.specs import Manifest
from robbdd_tools.run.prepare import FEATURES
from robbdd_tools.run.used_files import imported_by_steps, used_paths

_FAST = 1
"""Compression level: fast, because archives are packed more often than they are sent."""


@dataclass(frozen=True, slots=True)
class Parcel:
    """Files in a compressed archive. ``digest`` is the SHA-256 of their names and contents.

    ``roots`` are the folders of the files on the machine that packed them; none is inside another.
    """

    digest: str
    content: bytes
    roots: tuple[str, ...] = ()


def pack_used(manifest: Manifest, folder: Path, more: Iterable[Path] = ()) -> Parcel:
    """Pack the files that a run folder's scenarios use, and ``more`` files and folders. Raises ``OSError``.

    The scenarios use the files that ``used_files`` finds, and the files that steps of the model import.
    """
    files = {*used_paths(manifest, folder), *imported_by_steps(manifest)}
    folders = {path.parent for path in files}
    for path in (one.resolve() for one in more):
        files.update(_files_in(path))
        folders.add(path if path.is_dir() else path.parent)
    folders.update(path.parent for path in _named(json.loads(load_text(folder / MANIFEST, RESULT_SIZE))))
    roots = tuple(str(one) for one in sorted(folders) if one.parent != one and not folders & {*one.parents})
    # ``files`` have links resolved, but the manifest may name the same files through links.
    linked = {link / path.relative_to(link.resolve()): path for link in folders for path in _below(link, files)}
    every = sorted({**{path: path for path in files}, **linked}.items())
    named = [(name.relative_to(name.anchor).as_posix(), path) for name, path in every]
    made = [Path(one).relative_to(Path(one).anchor).as_posix() for one in roots]
    return _packed(named, made, roots)


def pack_prepared(folder: Path) -> Parcel:
    """Pack the features, the steps and the manifest of a prepared run folder. Raises ``OSError``."""
    every = sorted(path for path in (folder / FEATURES).rglob("*") if path.is_file() and path.suffix != ".pyc")
    return _packed([(path.relative_to(folder).as_posix(), path) for path in (folder / MANIFEST, *every)], (), ())


def unpack(parcel: Parcel, folder: Path) -> Path:
    """Unpack a parcel into a folder named after its digest, unless the folder exists. Return it. Raises ``OSError``.

    Several threads and processes may unpack the same parcel at the same time.
    """
    place = folder / parcel.digest
    if not place.is_dir():
        folder.mkdir(parents=True, exist_ok=True)
        beside = Path(tempfile.mkdtemp(prefix="unpacking-", dir=folder))
        try:
            _extract(parcel.content, beside)
            with suppress(OSError):  # another one was faster
                beside.rename(place)
        finally:
            shutil.rmtree(beside, ignore_errors=True)
    return place


@dataclass(frozen=True, slots=True)
class Moved:
    """A prepared run that was unpacked in ``folder``; the files that it uses are below ``root``.

    ``origin`` is the run folder and ``roots`` are the folders of the files on the machine that packed them.
    """

    folder: Path
    root: Path
    origin: str
    roots: Sequence[str]

    def move_manifest(self) -> None:
        """Rewrite the manifest so that its paths name the unpacked files. Raises ``OSError``."""
        path = self.folder / MANIFEST
        text = load_text(path, RESULT_SIZE)
        replace_file(path, self._moved(text))

    def restored(self, line: str) -> str:
        """Return an agent's message with the paths of the machine that packed the run."""
        return line.replace(str(self.folder), self.origin).replace(str(self.root), "")

    def _moved(self, text: str) -> str:
        if not self.roots:
            return text
        spellings = {spelling for root in self.roots for spelling in (_in_json(root), quote(root))}
        # A path is at the start of a string, after a blank in a command, or after the two slashes of a URI.
        begins, ends = r"(?:(?<=[\"'\s=])|(?<=//))", r"(?=[/\"'\s:;,]|$)"
        either = "|".join(re.escape(one) for one in sorted(spellings, key=len, reverse=True))
        root = _in_json(str(self.root))
        return re.sub(f"{begins}(?:{either}){ends}", lambda found: root + found.group(), text)


def _extract(content: bytes, folder: Path) -> None:
    # Releases of Python 3.11 before 3.11.4 have no extraction filters.
    with gzip.GzipFile(fileobj=io.BytesIO(content)) as packed, tarfile.TarFile(fileobj=packed) as archive:
        for entry in archive:
            target = folder / entry.name
            if not full_path(target).is_relative_to(folder):
                raise OSError(errno.EINVAL, "is outside of its archive", entry.name)
            data = archive.extractfile(entry)
            if data is None:
                target.mkdir(parents=True, exist_ok=True)
                continue
            target.parent.mkdir(parents=True, exist_ok=True)
            replace_file(target, data.read())
            target.chmod(entry.mode)


def _packed(files: Sequence[tuple[str, Path]], folders: Sequence[str], roots: tuple[str, ...]) -> Parcel:
    """Pack files, given by their names in the archive. Equal files always give the same bytes."""
    content = io.BytesIO()
    digest = hashlib.sha256(json.dumps([*folders, *roots]).encode())
    with (
        gzip.GzipFile(fileobj=content, mode="wb", compresslevel=_FAST, mtime=0) as packed,
        tarfile.TarFile(fileobj=packed, mode="w") as archive,
    ):
        for name in folders:
            entry = tarfile.TarInfo(name)
            entry.type, entry.mode = tarfile.DIRTYPE, 0o700
            archive.addfile(entry)
        for name, path in files:
            data = _absolute(path) if name == MANIFEST else load_bytes(path, RESULT_SIZE)
            entry = tarfile.TarInfo(name)
            entry.size, entry.mode = len(data), path.stat().st_mode & 0o755 | 0o600
            archive.addfile(entry, io.BytesIO(data))
            digest.update(f"{name} {entry.mode} {hashlib.sha256(data).hexdigest()}\n".encode())
    return Parcel(digest.hexdigest(), content.getvalue(), roots)


def _absolute(path: Path) -> bytes:
    """Return a manifest with absolute paths of models: relative ones mean nothing on another machine."""
    data = json.loads(load_text(path, RESULT_SIZE))
    for scenario in data["scenarios"]:
        if scenario.get("model") and not scenario["model"].startswith("file:"):
            scenario["model"] = str(full_path(Path(scenario["model"])))
    return json.dumps(data, ensure_ascii=False).encode()


def _named(data: object) -> Iterator[Path]:
    """Yield the paths of the models and of the places in models that a manifest names."""
    if isinstance(data, dict):
        for name, value in cast(dict[str, Any], data).items():
            if name in ("model", "file") and isinstance(value, str) and value:
                path = uri_to_path(value) if value.startswith("file:") else Path(value)
                if path is not None:
                    yield full_path(path)
            else:
                yield from _named(value)
    elif isinstance(data, list):
        for value in cast(list[object], data):
            yield from _named(value)


def _below(link: Path, files: Iterable[Path]) -> Iterator[Path]:
    """Yield the files below the target of a link; nothing if the path is not a link."""
    target = link.resolve()
    if target != link:
        yield from (path for path in files if path.is_relative_to(target))


def _files_in(path: Path) -> Iterator[Path]:
    if not path.is_dir():
        yield path
        return
    yield from (one for one in path.rglob("*") if one.is_file() and "__pycache__" not in one.parts)


def _in_json(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)[1:-1]
