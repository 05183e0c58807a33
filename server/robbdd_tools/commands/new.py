"""``robbdd new``: begin a project from one of the examples."""

from __future__ import annotations

import re
import shlex
import sys
from pathlib import Path

from robbdd_tools.base.data import data_folder
from robbdd_tools.commands import FAILED, OK

EXAMPLES = "examples"
EXAMPLE_NAMESPACE = "https://example.org/robbdd/"
"""What the namespaces of the examples begin with; a new project has its own name there."""
IGNORED = ".robbdd/\n__pycache__/\n"


def new_project(folder: Path, template: str) -> int:
    """Copy an example into ``folder``, which must not hold anything yet; returns the exit code."""
    examples = _examples()
    source = examples.get(template)
    if source is None:
        print(f"robbdd: there is no template '{template}'; there are {', '.join(examples)}", file=sys.stderr)
        return FAILED
    try:
        if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
            print(f"robbdd: {folder} is there already; name a new or an empty folder", file=sys.stderr)
            return FAILED
        models = _copy(source, folder)
    except OSError as error:
        print(f"robbdd: {error.filename or folder}: {error.strerror or error}", file=sys.stderr)
        return FAILED
    print(f"{folder}: {', '.join(path.name for path in sorted(folder.iterdir()) if path.name != '.gitignore')}")
    print(f"Next: robbdd run {shlex.quote(str(models[0]))}")
    return OK


def list_templates() -> int:
    """Print the templates, each with the first line of its first model; returns the exit code."""
    examples = _examples()
    width = max(map(len, examples))
    for name, source in examples.items():
        heading = _models(source)[0].read_text(encoding="utf-8").partition("\n")[0]
        print(f"{name:{width}}  {heading.lstrip('/ ')}")
    return OK


def _examples() -> dict[str, Path]:
    folders = sorted(path for path in data_folder("", EXAMPLES).iterdir() if path.is_dir())
    return {folder.name: folder for folder in folders if _models(folder)}


def _models(folder: Path) -> list[Path]:
    return sorted(folder.glob("*.bdd"))


def _copy(source: Path, folder: Path) -> list[Path]:
    """Write the example's own files, under the namespace of the new project; returns its models."""
    name = re.sub(r"[^a-z0-9]+", "-", folder.absolute().name.lower()).strip("-") or "project"
    folder.mkdir(parents=True, exist_ok=True)
    for path in sorted(source.iterdir()):
        if path.is_file() and not path.name.startswith("."):
            text = path.read_text(encoding="utf-8").replace(EXAMPLE_NAMESPACE, f"https://example.org/{name}/")
            (folder / path.name).write_text(text, encoding="utf-8", newline="\n")
    (folder / ".gitignore").write_text(IGNORED, encoding="utf-8", newline="\n")
    return _models(folder)
