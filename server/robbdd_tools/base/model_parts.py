"""The named parts of an MJCF or URDF file, read from its text: bodies, joints, sites, geoms and actuators."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.mjcf_parts import mjcf_parts
from robbdd_tools.base.model_part import ModelPart
from robbdd_tools.base.model_xml import ModelReader, UnreadableModel
from robbdd_tools.base.source_texts import source_state
from robbdd_tools.base.urdf_parts import missing_meshes, urdf_parts

if TYPE_CHECKING:
    from robbdd_tools.base.files import FileState
    from robbdd_tools.base.model_xml import Element

KEPT = 32
"""Number of cached models."""
_GENERATING = frozenset({"replicate", "composite", "flexcomp", "attach"})
"""Elements of MJCF that create bodies whose names are not in the text."""
_GIVEN = {"body": r"part\d+", "joint": r"joint\d+", "actuator": r"actuator\d+", "geom": r"robbdd-face\d+"}
"""Patterns of the names that a run gives to unnamed parts."""


@dataclass(frozen=True, slots=True)
class ModelParts:
    """The contents of a model file according to its text.

    - ``format``: ``mjcf`` or ``urdf``; ``""`` if the file cannot be read. ``problem`` is the reason.
    - ``title``: the name of the model.
    - ``missing``: one sentence for each missing collision mesh, because of which a run refuses the model.
    - ``is_complete``: whether the text contains the names of all parts.
    - ``files``: the model file itself and the files that it includes, even missing ones.
    """

    format: str = ""
    title: str = ""
    parts: tuple[ModelPart, ...] = ()
    problem: str = ""
    missing: tuple[str, ...] = ()
    is_complete: bool = False
    files: tuple[Path, ...] = ()

    def names(self, *kinds: str) -> Iterator[ModelPart]:
        """Yield the named parts of some kinds, kind by kind in the given order. Parts of one kind are in text order."""
        for kind in kinds:
            yield from (part for part in self.parts if part.kind == kind and part.name)

    def find(self, name: str, *kinds: str) -> ModelPart | None:
        """Return the part that has a name. If parts of several kinds have it, the first kind takes precedence."""
        return next((part for part in self.names(*kinds) if part.name == name), None)

    def may_have(self, name: str, *kinds: str) -> bool:
        """Return whether a part of some kinds may have a name, even if the text does not contain the name."""
        if not self.is_complete or self.find(name, *kinds) is not None:
            return True
        unnamed = {part.kind for part in self.parts if not part.name}
        return any(kind in unnamed and re.fullmatch(_GIVEN.get(kind, "(?!)"), name) for kind in kinds)


_States = tuple["FileState | None", ...]
_known: dict[Path, tuple[_States, ModelParts]] = {}


def model_parts(path: Path) -> ModelParts:
    """Return the parts of a model file. It is read again when it or a file that it includes has changed."""
    known = _known.pop(path, None)
    if known is None or tuple(map(source_state, known[1].files)) != known[0]:
        reader = ModelReader(path)
        found = _read(reader)
        files = tuple(dict.fromkeys((path, *reader.files)))
        known = tuple(map(source_state, files)), replace(found, files=files)
    _known[path] = known
    if len(_known) > KEPT:
        _known.pop(next(iter(_known)), None)
    return known[1]


def _read(reader: ModelReader) -> ModelParts:
    path = reader.main
    try:
        elements = reader.read()
    except UnreadableModel as error:
        return ModelParts(problem=str(error))
    root = elements[0]
    match root.tag:
        case "mujoco":
            is_complete = all(element.tag not in _GENERATING for element in elements)
            return ModelParts(
                "mjcf", root.attributes.get("model", ""), tuple(mjcf_parts(elements)), is_complete=is_complete
            )
        case "robot" if _is_xacro(path, elements):
            name = path.name.removesuffix(".xacro")
            wanted = f"expand it ('xacro {path.name} > {Path(name).stem}.urdf') and name the result"
            return ModelParts(problem=f"'{path.name}' is a xacro file: {wanted}")
        case "robot":
            parts, missing = tuple(urdf_parts(elements)), tuple(missing_meshes(path, elements))
            return ModelParts("urdf", root.attributes.get("name", ""), parts, missing=missing, is_complete=True)
        case tag:
            return ModelParts(problem=f"'{path.name}' has the root element <{tag}>, not <mujoco> or <robot>")


def _is_xacro(path: Path, elements: list[Element]) -> bool:
    return path.suffix == ".xacro" or any("xacro" in element.tag for element in elements)
