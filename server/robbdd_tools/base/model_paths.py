"""Find the files that models name: model files of scene instances, ROS packages, meshes of packages."""

from __future__ import annotations

import os
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

from robbdd_tools.base.limits import SCANNED_ENTRIES

SCHEMES = ("package://", "model://")
"""Schemes of addresses that begin with the name of a package."""


def package_share(package: str) -> tuple[Path | None, str]:
    """Return the folder of an installed ROS package, or the reason why it is not found."""
    prefixes = _entries("AMENT_PREFIX_PATH")
    shares = (prefix / "share" / package for prefix in prefixes)
    found = next((share for share in shares if share.is_dir()), None)
    if found is not None:
        return found, ""
    return None, "it is not in AMENT_PREFIX_PATH" if prefixes else "AMENT_PREFIX_PATH is not set"


def packages() -> list[str]:
    """Return the names of the installed ROS packages, sorted."""
    shares = (prefix / "share" for prefix in _entries("AMENT_PREFIX_PATH"))
    found = (entry for share in shares for entry in _folders(share))
    return sorted({entry.name for entry in found if (entry / "package.xml").is_file()})


def mesh_places(path: Path, name: str) -> Iterator[Path]:
    """Yield possible places of a file that a URDF file names.

    The places are relative to the file, in ROS packages, or in a folder above the file.
    """
    scheme = next((scheme for scheme in SCHEMES if name.startswith(scheme)), "")
    if not scheme:
        yield (path.parent / name.removeprefix("file://")).absolute()
        return
    package, _, inner = name.removeprefix(scheme).partition("/")
    for prefix in _entries("AMENT_PREFIX_PATH"):
        yield prefix / "share" / package / inner
    for folder in _entries("ROS_PACKAGE_PATH"):
        yield folder / package / inner
        if folder.name == package:
            yield folder / inner
    for folder in path.absolute().parents:
        if folder.name == package:
            yield folder / inner
        yield folder / package / inner


def _folders(share: Path) -> list[Path]:
    try:
        return [entry for entry in islice(share.iterdir(), SCANNED_ENTRIES.value()) if entry.is_dir()]
    except OSError:
        return []


def _entries(variable: str) -> list[Path]:
    return [Path(entry) for entry in os.environ.get(variable, "").split(os.pathsep) if entry]
