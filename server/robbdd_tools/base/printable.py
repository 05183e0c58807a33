"""Make untrusted text safe to print: escape what a terminal, a log or a CI service would act on."""

from __future__ import annotations

import json
import re
from unicodedata import category

_JOINERS = "\u200c\u200d"
"""Format characters that only change the shape of adjacent letters and emoji."""
_NAMED = {"\n": r"\n", "\r": r"\r", "\t": r"\t"}
_CI_PREFIX = re.compile(r"##(?=[\w-]*\[)")
"""Start of CI commands that are recognised anywhere in a line: ``##[error]``, ``##vso[task…]``, ``##teamcity[``."""
_CI_LINE = re.compile(r"\A(\s*):(?=:)")
"""Start of commands to GitHub's runner, recognised at the start of a line: ``::error::``."""
_CI_LINES = re.compile(r"^(\s*):(?=:)", re.MULTILINE)
"""Such a command at the start of any line of a document."""


def printable(line: str) -> str:
    r"""Return one line of text, safe to print; ordinary text of any language stays unchanged.

    Control characters, line ends, escape sequences, unpaired surrogates and characters that reorder or hide text are
    escaped as in Python (``\x1b``, ``\n``, ``\u202e``), and so is the start of a CI command.
    """
    if not line.isprintable():
        line = "".join(map(_shown, line))
    return _CI_LINE.sub(r"\1\\x3a", _CI_PREFIX.sub(r"#\\x23", line))


def printable_json(document: object, indent: int | None = None) -> str:
    """Return the document as JSON text, in which every character that ``printable`` escapes is escaped.

    Parsing the text gives the same data.
    """
    text = json.dumps(document, indent=indent, ensure_ascii=False)
    # Line ends of the layout are the only ones outside of strings.
    if not text.replace("\n", "").isprintable():
        text = "".join(one if one == "\n" else _json_shown(one) for one in text)
    return _CI_PREFIX.sub(r"#\\u0023", text)


def printable_terms(text: str) -> str:
    """Return Turtle or N-Triples in which every character that ``printable`` escapes is escaped. Line ends stay."""
    if not text.replace("\n", "").isprintable():
        text = "".join(f"\\U{ord(one):08X}" if one != "\n" and _is_hidden(one) else one for one in text)
    return _without_commands(text, r"\\u003A", r"\\u0023")


def printable_xml(text: str) -> str:
    """Return XML without CI commands in its texts and attributes. Parsing it gives the same document."""
    return _without_commands(text, "&#58;", "&#35;")


def printable_python(text: str) -> str:
    """Return Python source without CI commands in its string literals. The values of the literals stay the same."""
    return _without_commands(text, r"\\x3a", r"\\x23")


def _without_commands(text: str, colon: str, hash_sign: str) -> str:
    """Escape the characters that begin CI commands. The format reads the escapes as the same characters."""
    return _CI_LINES.sub(rf"\1{colon}", _CI_PREFIX.sub(rf"#{hash_sign}", text))


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
    """Return a text that can be encoded as UTF-8. Lone surrogates are escaped."""
    return text.encode("utf-8", "backslashreplace").decode("utf-8")
