"""Create projects: copies of the examples under a new namespace."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from robbdd_tools.base.data import data_folder
from robbdd_tools.base.files import load_text
from robbdd_tools.base.writing import replace_file

EXAMPLES = "examples"
EXAMPLE_NAMESPACE = "https://example.org/robbdd/"
"""Namespace prefix of the examples; a new project appends its own name to it."""
IGNORED = ".robbdd/\n__pycache__/\n"


class ScaffoldProblem(Exception):
    """A project cannot be created; the message gives the user the reason."""


@dataclass(frozen=True, slots=True)
class Template:
    """An example that can be copied as a new project. ``about`` is the first line of its first model."""

    name: str
    about: str
    folder: Path


def templates() -> dict[str, Template]:
    """Return the templates by name, in alphabetical order; raises ``OSError``."""
    found: dict[str, Template] = {}
    for folder in sorted(path for path in data_folder("", EXAMPLES).iterdir() if path.is_dir()):
        models = _models(folder)
        if models:
            first_line = load_text(models[0]).partition("\n")[0]
            found[folder.name] = Template(folder.name, first_line.lstrip("/ "), folder)
    return found


def begin_project(folder: Path, template: str) -> list[Path]:
    """Copy a template into ``folder``, which must be empty or missing; return the models of the new project.

    Hyphens in the template's name are ignored, so ``pick-place`` means ``pickplace``. Raises ``ScaffoldProblem`` and
    ``OSError``.
    """
    known = templates()
    chosen = known.get(template.replace("-", ""))
    if chosen is None:
        raise ScaffoldProblem(f"there is no template '{template}'; there are {', '.join(known)}")
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise ScaffoldProblem(f"{folder} exists already; name a new or an empty folder")
    name = re.sub(r"[^a-z0-9]+", "-", folder.absolute().name.lower()).strip("-") or "project"
    folder.mkdir(parents=True, exist_ok=True)
    for path in sorted(chosen.folder.iterdir()):
        if path.is_file() and not path.name.startswith("."):
            text = load_text(path).replace(EXAMPLE_NAMESPACE, f"https://example.org/{name}/")
            replace_file(folder / path.name, text)
    replace_file(folder / ".gitignore", IGNORED)
    return _models(folder)


def _models(folder: Path) -> list[Path]:
    return sorted(folder.glob("*.bdd"))
