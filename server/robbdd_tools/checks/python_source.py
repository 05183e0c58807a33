"""``python-source``: ``py { module: …, attr: … }`` names a module or an attribute that does not exist.

Modules are found by their files and read as syntax trees, but never imported. The finding is a warning, because the
module may be installed on the machine that runs the model.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, Severity
from robbdd_tools.base.files import uri_to_path
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.base.python_modules import find_module, module_outline, modules_in
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import Declaration

CODE = "python-source"
MIN_ALIKE = 0.6
"""Minimum similarity of a suggestion."""

_WITH_CODE = (tree.Implementation, tree.Observation, tree.Policy, tree.BehaviourTree, tree.SceneInstance)
"""Declarations that may name Python code."""


@dataclass(frozen=True, slots=True)
class Missing:
    """A name of missing Python code, with similar names. ``is_attribute`` is true if only the module exists."""

    message: str
    choices: tuple[str, ...] = ()
    is_attribute: bool = False


def python_source(_: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report each such name."""
    own = uri_to_path(file.document.uri)
    if own is None or not own.parent.is_dir():
        return
    for placed in file.of(*_WITH_CODE):
        for source in code_names(placed.declaration):
            problem = missing(source.module.text, source.attribute.text, own.parent)
            if problem is not None:
                name = source.attribute if problem.is_attribute else source.module
                span = name.span.shifted(placed.offset)
                fixes = tuple(
                    Fix(f"Change to '{choice}'", (Edit(file.document.uri, span, choice),)) for choice in problem.choices
                )
                yield Diagnostic(file.document.uri, span, Severity.WARNING, CODE, problem.message, fixes=fixes)


@kept_with_key
def code_names(declaration: Declaration) -> tuple[tree.PythonAttribute, ...]:
    """Return the names of Python code in a declaration."""
    root = declaration.tree
    if not isinstance(root, _WITH_CODE):
        return ()
    return tuple(node for node in walk(root) if isinstance(node, tree.PythonAttribute))


def missing(module: str, attribute: str, folder: Path) -> Missing | None:
    """Return the problem with the name of Python code for a file in a folder; ``None`` if the name exists."""
    spec = find_module(module, folder)
    if spec is None:
        near = _near_modules(module, folder)
        hint = f"; did you mean '{near[0]}'?" if near else f": put {_file(module)} next to this file"
        return Missing(f"there is no module '{module}'{hint}", tuple(near))
    found = module_outline(spec)
    if found.error:
        return Missing(f"the module '{module}' cannot be imported: {spec.origin}, {found.error}")
    if found.unread:
        return Missing(f"the names in the module '{module}' are not checked: {found.unread}", is_attribute=True)
    if found.is_complete and attribute not in found.names:
        near = _near(attribute, sorted(name for name in found.names if not name.startswith("_")))
        hint = f"; did you mean '{near[0]}'?" if near else ""
        return Missing(f"the module '{module}' has no '{attribute}'{hint}", tuple(near), is_attribute=True)
    return None


def _near_modules(module: str, folder: Path) -> list[str]:
    """Return modules with similar names, in the innermost package of the name that exists."""
    package, dot, name = module.rpartition(".")
    if package and find_module(package, folder) is None:
        return [f"{one}.{name}" for one in _near_modules(package, folder)]
    return [f"{package}{dot}{one}" for one in _near(name, modules_in(package, folder))]


def _near(name: str, known: Iterable[str]) -> list[str]:
    return get_close_matches(name, list(known), n=3, cutoff=MIN_ALIKE)


def _file(module: str) -> str:
    return "/".join(module.split(".")) + ".py"
