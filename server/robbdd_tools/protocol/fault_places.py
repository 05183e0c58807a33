"""Find the frames of a fault in the user's own files, and the files that the user edits."""

from __future__ import annotations

import hashlib
import sysconfig
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from robbdd_tools.base.files import load_bytes
from robbdd_tools.monitor.fault import Fault

_PACKAGE = Path(__file__).parents[1]


def is_ours(file: str) -> bool:
    """Return whether a file of Python code belongs to this package."""
    return _PACKAGE in Path(file).parents


def is_library(file: str) -> bool:
    """Return whether a file of Python code belongs to an installed or to the standard library."""
    path = Path(file)
    installed = not {"site-packages", "dist-packages"}.isdisjoint(path.parts)
    return installed or Path(sysconfig.get_path("stdlib")) in path.parents


def with_digest(fault: Fault) -> Fault:
    """Return a fault with the digest of the file in which it arose."""
    place = fault.place
    try:
        digest = "" if place is None else hashlib.sha256(load_bytes(Path(place.file))).hexdigest()
    except OSError:
        digest = ""
    return replace(fault, digest=digest)


def original(fault: Fault, sources: Mapping[str, str]) -> Fault:
    """Return a fault that names the files that the user edits instead of the copies that were executed.

    ``sources`` maps the absolute paths of the copies to the paths of the originals.
    """
    frames = tuple(replace(one, file=sources.get(str(Path(one.file).resolve()), one.file)) for one in fault.frames)
    return with_digest(replace(fault, frames=frames))


def sources_in(folder: Path, sources: Mapping[str, str]) -> dict[str, str]:
    """Map the absolute paths of the copies in a run folder to the files that they were copied from.

    ``sources`` is the field of this name in ``Manifest``.
    """
    return {str((folder / copy).resolve()): source for copy, source in sources.items()}
