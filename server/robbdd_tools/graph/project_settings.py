"""Read a project's settings from the nearest folder above a model.

The settings are in ``robbdd.toml``, or under ``[tool.robbdd]`` in ``pyproject.toml``.
"""

from __future__ import annotations

import os
import re
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.document import Document, Span
from robbdd_tools.base.files import Unreadable, path_to_uri, read_text, uri_to_path
from robbdd_tools.base.user_settings import user_file
from robbdd_tools.graph.rdf.libraries import json_object

_LINE_COLUMN = re.compile(r"\(at line (\d+), column (\d+)\)")


@dataclass(frozen=True, slots=True)
class Setting:
    """A setting whose value is a list of strings.

    ``offset`` is the position of its key in ``file``. ``faults`` are the reasons why the setting cannot be used.
    """

    file: Path
    offset: int = 0
    values: tuple[str, ...] = ()
    faults: tuple[Diagnostic, ...] = ()

    def fault(self, message: str) -> Diagnostic:
        """Return a diagnostic at the key of this setting."""
        return config_fault(self.file, self.offset, message)


def nearest_setting(uri: str, key: str, form: str) -> Setting | None:
    """Return the setting ``key`` of the nearest configuration above a model that contains it, or ``None``.

    ``form`` describes the expected value, for error messages.
    """
    path = uri_to_path(uri)
    for folder in path.parents if path is not None else ():
        for name in ("robbdd.toml", "pyproject.toml"):
            file = folder / name
            found = _setting(file, key, form) if os.path.lexists(file) else None
            if found is not None:
                return found
    return None


def user_setting(key: str, form: str) -> Setting | None:
    """Return the setting ``key`` of the user's own configuration. For ``form``, see ``nearest_setting``."""
    file = user_file()
    return _setting(file, key, form) if os.path.lexists(file) else None


def config_fault(file: Path, offset: int, message: str) -> Diagnostic:
    """Return a diagnostic at a place of a configuration."""
    return Diagnostic(path_to_uri(file), Span(offset, offset), Severity.ERROR, "config", message)


def _setting(file: Path, key: str, form: str) -> Setting | None:
    text = read_text(file)
    if isinstance(text, Unreadable):
        return Setting(file, faults=(config_fault(file, 0, text.reason),))
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        if file.name == "pyproject.toml" and "tool.robbdd" not in text:
            return None
        return Setting(file, faults=(config_fault(file, _toml_offset(text, str(error)), f"not valid TOML: {error}"),))
    if file.name == "pyproject.toml":
        table = json_object(json_object(table.get("tool")).get("robbdd"))
    if key not in table:
        return None
    written = re.search(rf"^\s*({key})\s*=", text, re.MULTILINE)
    offset = written.start(1) if written else 0
    values: Any = table[key]
    if not isinstance(values, list) or not all(isinstance(one, str) for one in cast("list[Any]", values)):
        return Setting(file, offset, faults=(config_fault(file, offset, f"'{key}' is {form}"),))
    return Setting(file, offset, tuple(cast("list[str]", values)))


def _toml_offset(text: str, message: str) -> int:
    found = _LINE_COLUMN.search(message)
    if found is None:
        return len(text)
    document = Document("", 0, text)
    line = min(int(found[1]), len(document.line_starts)) - 1
    return document.line_starts[line] + int(found[2]) - 1
