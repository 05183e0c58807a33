"""Find imports that differ from the name of the file in upper and lower case."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.base.spellings import Spellings
    from robbdd_tools.names.index import ImportPath

_SEPARATORS = re.compile(r"[/:]")


def wrong_case(link: ImportPath, spellings: Spellings) -> str | None:
    """Return a message if an import differs from the name of an existing file only in case; otherwise ``None``."""
    written = _names(link.text)
    stored = spellings.stored(link.written, len(written)) if written else None
    if stored is None:
        return None
    named = "/".join(stored.parts[-len(written) :])
    return f"the file is called '{named}': other systems do not find it as '{'/'.join(written)}'"


def _names(path: str) -> list[str]:
    """Return the names at the end of an import's path, after the steps to other folders."""
    found: list[str] = []
    for name in reversed(_SEPARATORS.split(path)):
        if name in ("..", ""):
            break
        if name != ".":
            found.insert(0, name)
    return found
