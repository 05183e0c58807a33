"""Limits that keep hostile or broken input from exhausting the machine.

The user can change each limit, but an opened folder cannot.

A limit is read from its environment variable, so that child processes have the same limits; the server sets these
variables from the editor's setting ``robbdd.limits``. See docs/limits.md.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import cast

MIB = 1024 * 1024
_GIVEN = dict(os.environ)


@dataclass(frozen=True, slots=True)
class Limit:
    """A positive whole number that the user can change by an environment variable."""

    name: str
    default: int
    unit: str

    @property
    def variable(self) -> str:
        """The name of the environment variable that replaces the default value."""
        return f"ROBBDD_LIMIT_{self.name.replace('-', '_').upper()}"

    def value(self) -> int:
        """Return the current value of the limit. A variable that is not a positive whole number is ignored."""
        stated = os.environ.get(self.variable, "")
        return int(stated) if _is_positive(stated) else self.default

    def use(self, value: int | None) -> None:
        """Set the limit for this process and its children. ``None`` restores the initial value."""
        stated = _GIVEN.get(self.variable, "") if value is None else str(value)
        os.environ[self.variable] = stated


MODEL_SIZE = Limit("model-size", 8 * MIB, "bytes")
"""Largest file of a model, settings, a template, a query or shapes. Hand-written files are far smaller."""
SOURCE_SIZE = Limit("source-size", MIB, "bytes")
"""Largest Python file, or robot model with its included files, to read while editing. Reading one takes 0.5 s."""
RESULT_SIZE = Limit("result-size", 512 * MIB, "bytes")
"""Largest file of a run (results, manifest, trace), and largest mesh or texture of a scene's model."""
MESSAGE_SIZE = Limit("message-size", 64 * MIB, "bytes")
"""Largest content of one message to the language server."""
HEADER_SECONDS = Limit("header-seconds", 30, "seconds")
"""A TCP client must send the header of a message within this time from its first byte. Editors send it at once."""
SCANNED_ENTRIES = Limit("scanned-entries", 200_000, "files and folders")
"""Maximum number of entries that one search of a folder visits."""
SCANNED_DEPTH = Limit("scanned-depth", 32, "levels of folders")
"""Maximum nesting depth of the folders that one search enters."""
VALIDATION_SECONDS = Limit("validation-seconds", 120, "seconds")
"""Maximum time for one validation of a file. 10,000 lines take about 5 s of CPU time."""
TEMPLATE_SECONDS = Limit("template-seconds", 10, "seconds")
"""Maximum time to render one block of a user's template. Blocks of our templates take milliseconds."""
TEMPLATE_OUTPUT = Limit("template-output", 8 * MIB, "bytes")
"""Largest text that one block of a user's template may make."""
TEMPLATE_MEMORY = Limit("template-memory", 512 * MIB, "bytes")
"""Largest address space of the process that renders a user's template, if the system can limit it."""
SCENE_SECONDS = Limit("scene-seconds", 30, "seconds")
"""Maximum time to set up the scene instances of a file while it is checked. The examples take a second."""
SCENE_MEMORY = Limit("scene-memory", 2048 * MIB, "bytes")
"""Largest address space of the process that sets them up, if the system can limit it. The examples take 250 MiB."""
LOG_SECONDS = Limit("log-seconds", 60, "seconds")
"""Maximum time to read the names in a log while a model is edited."""

LIMITS: Mapping[str, Limit] = {
    limit.name: limit
    for limit in (
        MODEL_SIZE,
        SOURCE_SIZE,
        RESULT_SIZE,
        MESSAGE_SIZE,
        HEADER_SECONDS,
        SCANNED_ENTRIES,
        SCANNED_DEPTH,
        VALIDATION_SECONDS,
        TEMPLATE_SECONDS,
        TEMPLATE_OUTPUT,
        TEMPLATE_MEMORY,
        SCENE_SECONDS,
        SCENE_MEMORY,
        LOG_SECONDS,
    )
}


def use_limits(stated: object) -> str | None:
    """Set the limits in an editor's setting, and reset all others. The setting maps names to values.

    Returns a description of the errors in the setting, or ``None``. A setting with errors changes nothing.
    """
    values = cast("dict[object, object]", stated) if isinstance(stated, dict) else {}
    for name, value in values.items():
        if name not in LIMITS:
            return f"The setting 'robbdd.limits' has no limit '{name}'; there are {', '.join(LIMITS)}."
        if not isinstance(value, int) or isinstance(value, bool) or value <= 0:
            return f"The limit '{name}' in 'robbdd.limits' must be a positive whole number of {LIMITS[str(name)].unit}."
    if stated is not None and not isinstance(stated, dict):
        return "The setting 'robbdd.limits' must be an object, such as {\"model-size\": 16777216}."
    for name, limit in LIMITS.items():
        limit.use(cast("int | None", values.get(name)))
    return None


def _is_positive(text: str) -> bool:
    return text.isascii() and text.isdecimal() and len(text) < 19 and int(text) > 0
