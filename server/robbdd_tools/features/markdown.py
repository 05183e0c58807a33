"""Write users' text in Markdown so that it is rendered literally."""

from __future__ import annotations

import re
import textwrap

_CODE_OR_TAG = re.compile(r"(?<!`)`[^`\n]+`(?!`)|<[\w!?/][^<>`\n]*>")
_WEB_LINK = re.compile(r"<https?://[^\s<>`]*>")
"""A link whose text is its address; clients do not follow it by themselves."""
_MARKUP = re.compile(r"[\\`*\[\]<>&~|]|!(?=\[)|^\s*[#=+-](?=\s|[=-])", re.MULTILINE)
"""Start of a link, a picture, HTML, an entity, emphasis, a table, a fence, a heading or a list."""
MAX_LINES = 10
"""Maximum number of lines shown."""


def literal(text: str) -> str:
    """Return Markdown that renders as the given text, without pictures, HTML or hidden links.

    ``<names>`` become code, so that clients show every character. Text in backticks stays code, and ``<https://…>``
    stays a link.
    """
    pieces: list[str] = []
    end = 0
    for found in _CODE_OR_TAG.finditer(text):
        stays = found[0].startswith("`") or _WEB_LINK.fullmatch(found[0])
        pieces += [_escaped(text[end : found.start()]), found[0] if stays else f"`{found[0]}`"]
        end = found.end()
    return "".join((*pieces, _escaped(text[end:])))


def code(text: str) -> str:
    """Return a text as inline code. The text may contain backticks and line breaks."""
    line = " ".join(text.splitlines())
    marks = "`" * _longer_than_runs(line, 1)
    space = " " if "`" in line else ""
    return f"{marks}{space}{line}{space}{marks}"


def _escaped(text: str) -> str:
    return _MARKUP.sub(lambda match: f"{match[0][:-1]}\\{match[0][-1]}", text)


def _longer_than_runs(text: str, least: int) -> int:
    """Return a number of backticks, at least ``least``, that exceeds every run of backticks in the text."""
    return max((least, *(len(run) + 1 for run in re.findall("`+", text))))


def code_block(text: str, language: str) -> str:
    """Return the first lines of a text as a code block. ``language`` is, for example, ``bdd`` or ``scenex``."""
    first, *rest = text.rstrip().splitlines()
    lines = [first, *textwrap.dedent("\n".join(rest)).splitlines()] if rest else [first]
    shown = lines if len(lines) <= MAX_LINES else [*lines[: MAX_LINES - 1], "…"]
    return fenced("\n".join(shown), "robbdd" if language == "bdd" else f"robbdd-{language}")


def fenced(text: str, language: str) -> str:
    """Return a text as a code block of any language."""
    fence = "`" * _longer_than_runs(text, 3)
    return "\n".join((f"{fence}{language}", text, fence))
