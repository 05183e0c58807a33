"""Compare the versions that can change results on this machine with those on the workers of a cluster."""

from __future__ import annotations

import hashlib
import platform
import sysconfig
from collections.abc import Iterator, Mapping
from functools import cache
from importlib.metadata import PackageNotFoundError, entry_points, version
from pathlib import Path

from robbdd_tools import __version__
from robbdd_tools.base.files import load_bytes
from robbdd_tools.base.limits import SOURCE_SIZE
from robbdd_tools.catalog.foreign_words import GROUP

DECIDING = ("mujoco", "numpy", "behave", "py_trees", "distributed")
"""Packages whose releases can change results, or the form of messages to workers."""


@cache
def versions() -> Mapping[str, str]:
    """Return the versions by name: this package with a digest of its code, Python, the machine, other packages."""
    found = {"robbdd-tools": f"{__version__} ({_code()})", "Python": platform.python_version()}
    found |= {"machine": sysconfig.get_platform()}
    words = {entry.dist.name for entry in entry_points(group=GROUP) if entry.dist is not None}
    return found | {name: _version(name) for name in (*DECIDING, *sorted(words))}


def differences(expected: Mapping[str, str], found: Mapping[str, str]) -> Iterator[str]:
    """Yield each version that differs, in words. ``expected`` are the versions of the machine that began the study."""
    for name in dict.fromkeys((*expected, *found)):
        here, there = expected.get(name, "none"), found.get(name, "none")
        if here != there:
            yield f"{name} {there} instead of {here}"


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "none"


def _code() -> str:
    """Return the start of a digest of the package's source, because a checkout has the version of its last release."""
    root = Path(__file__).resolve().parents[1]
    digest = hashlib.sha256()
    for path in sorted(root.rglob("*.py")):
        digest.update(f"{path.relative_to(root).as_posix()}\n".encode())
        digest.update(load_bytes(path, SOURCE_SIZE).replace(b"\r\n", b"\n"))
    return digest.hexdigest()[:12]
