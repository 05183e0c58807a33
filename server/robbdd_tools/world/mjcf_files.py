"""MJCF files with the unsaved texts of an editor."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

from robbdd_tools.base.model_includes import model_files
from robbdd_tools.base.source_texts import source_xml, unsaved_source
from robbdd_tools.world.engine import mujoco

if TYPE_CHECKING:
    from pathlib import Path


def read_mjcf(path: Path) -> Any:
    """Return the engine's editable description of an MJCF file. Raises ``ValueError`` and ``OSError``.

    Unsaved texts replace the file and the files that it includes.
    """
    if _is_part(path):
        raise ValueError("it is a part that other files include (<mujocoinclude>): name a file that includes it")
    included = [one for one in model_files(path, source_xml) if one != path and _is_mjcf(one)]
    if all(unsaved_source(one) is None for one in (path, *included)):
        return mujoco.MjSpec.from_file(str(path))
    texts = {os.path.relpath(one, path.parent): _utf8(one) for one in included}
    spec = mujoco.MjSpec.from_string(_utf8(path).decode(), include=texts)
    spec.modelfiledir = str(path.parent)
    return spec


def _is_part(path: Path) -> bool:
    try:
        return ElementTree.fromstring(source_xml(path)).tag == "mujocoinclude"
    except ElementTree.ParseError:
        return False


def _is_mjcf(path: Path) -> bool:
    return unsaved_source(path) is not None or path.suffix.lower() in (".xml", ".mjcf")


def _utf8(path: Path) -> bytes:
    found = source_xml(path)
    return found.encode() if isinstance(found, str) else found
