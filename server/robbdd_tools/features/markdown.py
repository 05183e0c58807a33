"""Text of users in Markdown: shown as it is written."""

from __future__ import annotations

import re
import textwrap

_CODE_OR_TAG = re.compile(r"`[^`]*`|<(?!\w+://)[\w!?/][^<>]*>")
MOST_LINES = 10
"""Lines of a text that are shown."""


def literal(text: str) -> str:
    """Return a text whose ``<names>`` stay to be seen: clients leave out what looks like a tag, but not in code."""
    return _CODE_OR_TAG.sub(lambda match: match[0] if match[0].startswith("`") else f"`{match[0]}`", text)


def code_block(text: str, language: str) -> str:
    """Return the first lines of a text in a file of some kind (``bdd``, ``scenex`` …), without common indentation."""
    first, *rest = text.rstrip().splitlines()
    lines = [first, *textwrap.dedent("\n".join(rest)).splitlines()] if rest else [first]
    shown = lines if len(lines) <= MOST_LINES else [*lines[: MOST_LINES - 1], "…"]
    name = "robbdd" if language == "bdd" else f"robbdd-{language}"
    return "\n".join((f"```{name}", *shown, "```"))
