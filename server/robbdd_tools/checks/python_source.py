"""``python-source``: ``py { module: …, attr: … }`` names a module or an attribute that does not exist.

Modules are found by their files and read as syntax trees, but never imported. The finding is a warning, because the
module may be installed on the machine that runs the model.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, Severity
from robbdd_tools.base.files import uri_to_path
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.base.python_modules import find_module, module_names
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import Declaration

CODE = "python-source"
MIN_ALIKE = 0.6
"""Minimum similarity of a suggestion."""


def python_source(_: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report each such name."""
    own = uri_to_path(file.document.uri)
    if own is None or not own.parent.is_dir():
        return
    for placed in file.declarations:
        for source in _sources(placed.declaration):
            problem = _problem(source, own.parent)
            if problem is not None:
                name, message, choices = problem
                span = name.span.shifted(placed.offset)
                fixes = tuple(
                    Fix(f"Change to '{choice}'", (Edit(file.document.uri, span, choice),)) for choice in choices
                )
                yield Diagnostic(file.document.uri, span, Severity.WARNING, CODE, message, fixes=fixes)


@kept_with_key
def _sources(declaration: Declaration) -> tuple[tree.PythonAttribute, ...]:
    root = declaration.tree
    if not isinstance(
        root, tree.Implementation | tree.Observation | tree.Policy | tree.BehaviourTree | tree.SceneInstance
    ):
        return ()
    return tuple(node for node in walk(root) if isinstance(node, tree.PythonAttribute))


def _problem(source: tree.PythonAttribute, folder: Path) -> tuple[tree.Name, str, list[str]] | None:
    """Return the wrong name, a message and suggestions; ``None`` if the name exists."""
    module, attribute = source.module.text, source.attribute.text
    spec = find_module(module, folder)
    if spec is None:
        near = _near(module, sorted(path.stem for path in folder.glob("*.py")))
        hint = f"; did you mean '{near[0]}'?" if near else f": put {_file(module)} next to this file"
        return source.module, f"there is no module '{module}'{hint}", near
    found = module_names(spec)
    if found.error:
        return source.module, f"the module '{module}' cannot be imported: {spec.origin}, {found.error}", []
    if found.is_complete and attribute not in found.names:
        near = _near(attribute, sorted(name for name in found.names if not name.startswith("_")))
        hint = f"; did you mean '{near[0]}'?" if near else ""
        return source.attribute, f"the module '{module}' has no '{attribute}'{hint}", near
    return None


def _near(name: str, known: Iterable[str]) -> list[str]:
    return get_close_matches(name, list(known), n=3, cutoff=MIN_ALIKE)


def _file(module: str) -> str:
    return "/".join(module.split(".")) + ".py"
