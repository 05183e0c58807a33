"""``robbdd new``: start a project from an example."""

from __future__ import annotations

import shlex
from pathlib import Path

from robbdd_tools.base.scaffold import ScaffoldProblem, begin_project, templates
from robbdd_tools.commands import OK
from robbdd_tools.commands.output import fail, print_line


def new_project(folder: Path, template: str) -> int:
    """Create a project in ``folder``; return the exit code."""
    try:
        begin_project(folder, template)
    except ScaffoldProblem as problem:
        return fail(str(problem))
    except OSError as error:
        return fail(f"{error.filename or folder}: {error.strerror or error}")
    print_line(f"{folder}: {', '.join(path.name for path in sorted(folder.iterdir()) if path.name != '.gitignore')}")
    print_line(f"Next: robbdd run {shlex.quote(str(folder))}")
    return OK


def list_templates() -> int:
    """Print the templates with their descriptions; return the exit code."""
    known = templates()
    width = max(map(len, known))
    for name, template in known.items():
        print_line(f"{name:{width}}  {template.about}")
    return OK
