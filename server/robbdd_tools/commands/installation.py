"""Find the versions, libraries, extras and editor extensions that ``robbdd doctor`` reports."""

from __future__ import annotations

import json
import platform
import re
import shutil
import sys
from collections.abc import Callable, Iterator, Mapping
from importlib import metadata
from pathlib import Path
from typing import Any

from robbdd_tools import __version__
from robbdd_tools.base.data import PACKAGE
from robbdd_tools.base.files import load_text
from robbdd_tools.base.interpreter import working_folder
from robbdd_tools.base.processes import run_for
from robbdd_tools.catalog.registry import load_catalog

DISTRIBUTION = "robbdd-tools"
REINSTALL = f"python -m pip install --force-reinstall {DISTRIBUTION}"
EXTENSION = "robbdd.robbdd-workbench"
EDITORS = (".vscode", ".vscode-insiders", ".vscode-oss", ".vscode-server", ".cursor")
"""Folders in the home folder where editors of the VS Code family keep their extensions."""
SECONDS = 120.0
"""Seconds of wall time after which a tested program counts as hanging."""
_NAME = re.compile(r"[\w.-]+")
_EXTRA = re.compile(r"extra\s*==\s*['\"]([\w-]+)['\"]")
_OPTIONAL = ("video", "fast-queries")


class Unavailable(Exception):
    """A part of the installation does not work.

    The message gives the reason, and ``fix`` says how to repair the part. A part that is ``optional`` may be missing.
    """

    def __init__(self, reason: str, fix: str, *, optional: bool = False) -> None:
        super().__init__(reason)
        self.fix = fix
        self.optional = optional


def package() -> str:
    """Return version and location of this package."""
    return f"{DISTRIBUTION} {__version__} in {PACKAGE}"


def python() -> str:
    """Return version and location of the interpreter."""
    return f"{platform.python_implementation()} {platform.python_version()} ({sys.executable})"


def system() -> str:
    """Return the operating system and the processor's architecture."""
    return f"{platform.platform()} ({platform.machine()})"


def libraries() -> str:
    """Return the versions of the required libraries; raises ``Unavailable`` if one is missing."""
    found = _versions(_required(None))
    missing = [name for name, number in found.items() if number is None]
    if missing:
        raise Unavailable(f"not installed: {', '.join(missing)}", REINSTALL)
    return ", ".join(f"{name} {number}" for name, number in found.items())


def extras() -> str:
    """Return the versions of the optional libraries; raises ``Unavailable`` if one is missing."""
    words: list[str] = []
    missing: list[str] = []
    for extra in _OPTIONAL:
        for name, number in _versions(_required(extra)).items():
            words.append(f"{extra}: {name} {number or 'is not installed'}")
            if number is None:
                missing.append(extra)
    if missing:
        fix = f"python -m pip install '{DISTRIBUTION}[{','.join(missing)}]'"
        raise Unavailable(", ".join(words), fix, optional=True)
    return ", ".join(words)


def editor() -> str:
    """Return the installed VS Code extensions and the version of Node.

    Raises ``Unavailable`` if no extension is installed.
    """
    node = f"Node {_node()}"
    found = list(_extensions())
    if not found:
        fix = "install the VSIX of this release (docs/editors.md configures other editors)"
        raise Unavailable(f"no VS Code extension is installed for this user; {node}", fix, optional=True)
    others = [folder for folder, number in found if number != __version__]
    listed = "\n".join(f"{EXTENSION} {number} in {folder}" for folder, number in found)
    if others:
        fix = f"install the VSIX of version {__version__}: extension and server are released together"
        raise Unavailable(f"{listed}\n{node}", fix, optional=True)
    return f"{listed}\n{node}"


def words() -> str:
    """Return the number of the catalog's words. Raises ``Unavailable`` if it leaves out words of other packages."""
    catalog = load_catalog()
    if catalog.problems:
        raise Unavailable("\n".join(catalog.problems), "update or uninstall the packages that are named")
    counts = {
        "predicates": catalog.predicates,
        "behaviours": catalog.behaviours,
        "objects": catalog.objects,
        "robots": catalog.robots,
    }
    return ", ".join(f"{len(found)} {kind}" for kind, found in counts.items())


def _required(extra: str | None) -> list[str]:
    """Return the distributions that this distribution requires: always, or with the given ``extra``."""
    try:
        stated = metadata.requires(DISTRIBUTION) or []
    except metadata.PackageNotFoundError:
        raise Unavailable(f"{DISTRIBUTION} is not installed as a package", REINSTALL) from None
    found: list[str] = []
    for requirement in stated:
        name, belongs_to = _NAME.match(requirement), _EXTRA.search(requirement)
        if name is not None and (belongs_to[1] if belongs_to else None) == extra:
            found.append(name[0])
    return found


def _versions(names: list[str]) -> dict[str, str | None]:
    found: dict[str, str | None] = {}
    for name in names:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            found[name] = None
    return found


def _node() -> str:
    """Return the version of Node, which only developers of the VS Code extension need."""
    program = shutil.which("node")
    # Do not start a program from the working directory (Windows, or a relative entry of PATH).
    if program is None or not Path(program).is_absolute():
        return "is not on PATH (only needed to build the extension)"
    try:
        done = run_for(SECONDS, [program, "--version"], working_folder())
    except OSError as error:
        return f"cannot be started: {error}"
    if done.code != 0:
        return f"does not work: {(done.errors or done.output).strip()} ({program})"
    return f"{done.output.strip()} ({program})"


def _extensions() -> Iterator[tuple[Path, str]]:
    """Yield the folder and the version of each installed copy of the VS Code extension."""
    for editor_folder in EDITORS:
        for manifest in sorted((Path.home() / editor_folder / "extensions").glob(f"{EXTENSION}-*/package.json")):
            try:
                stated: dict[str, Any] = json.loads(load_text(manifest))
                yield manifest.parent, str(stated.get("version"))
            except (OSError, ValueError, AttributeError):
                yield manifest.parent, "unreadable"


TESTS: Mapping[str, Callable[[], str]] = {
    "package": package,
    "python": python,
    "system": system,
    "libraries": libraries,
    "extras": extras,
    "catalog": words,
    "editor": editor,
}
