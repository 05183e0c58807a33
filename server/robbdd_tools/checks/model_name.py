"""``model-name``: a model names a part that its MJCF or URDF file does not have.

The file's text is read, but no engine loads it. The finding is a warning, because the machine that runs the model may
have another version of the file.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from difflib import get_close_matches
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.base.files import uri_to_path
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.base.model_parts import ModelParts, model_parts
from robbdd_tools.checks.finding import MAX_OFFERED
from robbdd_tools.checks.model_file import model_path
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from robbdd_tools.names.analysis import FileAnalysis, PlacedDeclaration
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import Declaration

CODE = "model-name"
MIN_ALIKE = 0.6
"""Minimum similarity of a suggestion."""
MAX_NAMES = 12
"""Maximum number of names of a file that a message lists."""
WANTED: Mapping[str, tuple[str, ...]] = {
    "map body": ("body",),
    "tool": ("site", "body"),
    "on": ("site", "body"),
    "actuator": ("actuator", "joint"),
    "pads": ("geom", "body"),
    "joint": ("joint",),
}
"""Entry of a model → the kinds of parts that it may name, the usual kind first."""
ACCEPTED: Mapping[str, tuple[str, ...]] = {**WANTED, "pads": ("geom", "body", "visual")}
"""Like ``WANTED``, but including kinds that are accepted without being suggested."""
_PLURALS = {"body": "bodies"}


@dataclass(frozen=True, slots=True)
class PartName:
    """The name of a part in a model: the entry that names it (a key of ``WANTED``), and its text.

    ``in_gripper`` says that the file of a mounted gripper has the part.
    """

    model: tree.Model
    entry: str
    text: tree.Text
    in_gripper: bool = False


def model_name(_: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report each such name, with similar names as fixes."""
    own = uri_to_path(file.document.uri)
    if own is None:
        return
    for placed in file.of(tree.SceneInstance):
        for named in part_names(placed.declaration):
            parts = parts_named(named, own.parent)
            if parts is None or parts.may_have(named.text.value, *ACCEPTED[named.entry]):
                continue
            span = named.text.span.shifted(placed.offset)
            message, near = _missing(named.text.value, WANTED[named.entry], parts)
            quote = file.document.text[span.start]
            edits = ((name, (Edit(file.document.uri, span, f"{quote}{name}{quote}"),)) for name in near)
            fixes = tuple(Fix(f"Change to '{name}'", edit) for name, edit in edits)
            yield Diagnostic(file.document.uri, span, Severity.WARNING, CODE, message, fixes=fixes)
        yield from _unmapped(file, placed, own.parent)


def _unmapped(file: FileAnalysis, placed: PlacedDeclaration, folder: Path) -> Iterator[Diagnostic]:
    """Report each body that is mapped without ``to`` if the file has no body of this name."""
    uri = file.document.uri
    for model in _models(placed.declaration):
        parts = parts_of(model, folder)
        for mapping in model.mappings if parts is not None else ():
            name = mapping.reference.path.rpartition(".")[2]
            if parts is None or not _is_body(mapping) or mapping.target is not None or parts.may_have(name, "body"):
                continue
            span = mapping.reference.span.shifted(placed.offset)
            end = file.document.text.index(">", span.start) + 1
            message, near = _missing(name, ("body",), parts)
            fixes = tuple(Fix(f"Add 'to \"{one}\"'", (Edit(uri, Span(end, end), f' to "{one}"'),)) for one in near)
            yield Diagnostic(uri, span, Severity.WARNING, CODE, message, fixes=fixes)


@kept_with_key
def part_names(declaration: Declaration) -> tuple[PartName, ...]:
    """Return the names of parts in the models of a declaration."""
    return tuple(named for model in _models(declaration) for named in _named(model))


def _models(declaration: Declaration) -> list[tree.Model]:
    root = declaration.tree
    return [node for node in walk(root) if isinstance(node, tree.Model)] if isinstance(root, tree.SceneInstance) else []


def _is_body(mapping: tree.Mapping) -> bool:
    return mapping.reference.role == "Body"


def _named(model: tree.Model) -> Iterator[PartName]:
    for mapping in model.mappings:
        if mapping.target is not None and _is_body(mapping):
            yield PartName(model, "map body", mapping.target)
    gripper = model.gripper
    is_mounted = gripper is not None and gripper.source is not None
    if model.tool is not None:
        yield PartName(model, "tool", model.tool, is_mounted)
    if gripper is not None:
        if gripper.mount is not None:
            yield PartName(model, "on", gripper.mount)
        if gripper.actuator is not None:
            yield PartName(model, "actuator", gripper.actuator, is_mounted)
        yield from (PartName(model, "pads", pad, is_mounted) for pad in gripper.pads)
    if model.opening is not None and model.opening.joint is not None:
        yield PartName(model, "joint", model.opening.joint)


def parts_named(named: PartName, folder: Path) -> ModelParts | None:
    """Return the parts in the file that a name in a ``.scenex`` in a folder is about; ``None`` if it is unreadable."""
    gripper = named.model.gripper if named.in_gripper else None
    source = None if gripper is None else gripper.source
    return parts_of(named.model, folder) if source is None else _parts(source, folder)


def parts_of(model: tree.Model, folder: Path) -> ModelParts | None:
    """Return the parts in the file that a model of a ``.scenex`` in a folder names; ``None`` if it is unreadable."""
    return None if model.kind == "usd" else _parts(model.source, folder)


def _parts(source: tree.ModelSource, folder: Path) -> ModelParts | None:
    path = model_path(folder, source)
    if path is None or not path.is_file():
        return None
    parts = model_parts(path)
    return parts if parts.format else None


def _missing(name: str, kinds: tuple[str, ...], parts: ModelParts) -> tuple[str, list[str]]:
    """Return the message on a name that the file does not have, and similar names."""
    known = list(dict.fromkeys(part.name for part in parts.names(*kinds)))
    near = get_close_matches(name, known, n=MAX_OFFERED, cutoff=MIN_ALIKE)
    message = f"the model's file has no {' or '.join(kinds)} '{name}'"
    if near:
        return f"{message}; did you mean '{near[0]}'?", near
    listed = [f"the {_PLURALS.get(kind, f'{kind}s')} {_listed(parts, kind)}" for kind in kinds]
    fixes = known if len(known) <= MAX_OFFERED else []
    return f"{message}; it has {' and '.join(listed)}", fixes


def _listed(parts: ModelParts, kind: str) -> str:
    names = list(dict.fromkeys(part.name for part in parts.names(kind)))
    more = f" and {len(names) - MAX_NAMES} more" if len(names) > MAX_NAMES else ""
    return ", ".join(f"'{name}'" for name in names[:MAX_NAMES]) + more or "none"
