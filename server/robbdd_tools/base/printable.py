"""Text that others wrote, made safe to print: what a terminal, a log or a CI service would act on is escaped."""

from __future__ import annotations

import json
import re
from unicodedata import category

_JOINERS = "\u200c\u200d"
"""Format characters that change nothing but the shape of letters and emoji around them."""
_NAMED = {"\n": r"\n", "\r": r"\r", "\t": r"\t"}
_CI_PREFIX = re.compile(r"##(?=[\w-]*\[)")
"""How commands to CI services begin wherever they are in a line: ``##[error]``, ``##vso[task…]``, ``##teamcity[``."""
_CI_LINE = re.compile(r"\A(\s*):(?=:)")
"""How commands to GitHub's runner begin: ``::error::`` at the beginning of a line."""


def printable(line: str) -> str:
    r"""Return one line of text as it is safe to print; ordinary text of any language stays as it is.

    Control characters, line ends, escape sequences, unpaired surrogates and characters that reorder or hide text are
    written as in Python (``\x1b``, ``\n``, ``\u202e``), and so is the beginning of what a CI service takes for a
    command.
    """
    if not line.isprintable():
        line = "".join(map(_shown, line))
    return _CI_LINE.sub(r"\1\\x3a", _CI_PREFIX.sub(r"#\\x23", line))


def printable_json(document: object, indent: int | None = None) -> str:
    """Return a document as JSON in which the same characters are escaped as JSON does; other programs read the same."""
    text = json.dumps(document, indent=indent, ensure_ascii=False)
    # Only the line ends of the layout are outside of strings.
    if not text.replace("\n", "").isprintable():
        text = "".join(one if one == "\n" else _json_shown(one) for one in text)
    return _CI_PREFIX.sub(r"#\\u0023", text)


def printable_terms(text: str) -> str:
    """Return Turtle or N-Triples with the same characters escaped as these do; only line ends stay."""
    if text.replace("\n", "").isprintable():
        return text
    return "".join(f"\\U{ord(one):08X}" if one != "\n" and _is_hidden(one) else one for one in text)


def _is_hidden(character: str) -> bool:
    is_noncharacter = ord(character) & 0xFFFE == 0xFFFE
    return is_noncharacter or (category(character) in ("Cc", "Cf", "Cs", "Zl", "Zp") and character not in _JOINERS)


def _shown(character: str) -> str:
    if not _is_hidden(character):
        return character
    return _NAMED.get(character) or character.encode("unicode-escape", "backslashreplace").decode()


def _json_shown(character: str) -> str:
    return json.dumps(character)[1:-1] if _is_hidden(character) else character


def encodable(text: str) -> str:
    """Return a text that can be written as UTF-8: half characters are written as escapes."""
    return text.encode("utf-8", "backslashreplace").decode("utf-8")
