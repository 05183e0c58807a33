"""How user text is written into a feature so that every parser reads it back unchanged.

A feature is made of lines, a step's values stand in double quotes, a table's cells between bars. What would end any of
these is written with a backslash: ``\\n``, ``\\"``, ``\\\\``, and ``\\uXXXX`` for other characters that end a line.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

_NAMED = {"\n": "\\n", "\r": "\\r", "\t": "\\t"}
# Everything that str.splitlines, and so behave, takes for the end of a line, and what a terminal would obey.
_CONTROL = re.compile("[\x00-\x1f\x7f-\x9f\u2028\u2029]")
# What is quoted or escaped already, then what has a meaning in a group.
_GROUPING = re.compile(r'("(?:[^"\\]|\\.)*"|\\.)|[()"]|(?<!\S)(?:and|or|not)(?!\S)')
_TAG = re.compile(r"@?([a-z]+)=((?:[A-Za-z0-9.:_;-]|=[0-9A-F]{2})*)")
_UNSAFE_IN_TAGS = re.compile(r"[^A-Za-z0-9.:_-]")
_ENCODED = re.compile(r"(?:=[0-9A-F]{2})+")


def line(text: str) -> str:
    """Return a text as it stands in a name or a narrative line: one line, without outer blanks."""
    return " ".join(_CONTROL.sub(" ", text).split())


def free(text: str) -> str:
    """Return a text as it stands in a step, outside of quotes; outer blanks, which no parser keeps, are left out."""
    return _control_escaped(text.strip().replace("\\", "\\\\"))


def inside_quotes(text: str) -> str:
    """Return a string as it stands between the double quotes of a step.

    A string that looks like a set (``[…]``, ``any of […]``) begins with a backslash.
    """
    escaped = _quotable(text)
    return f"\\{escaped}" if escaped.startswith(("[", "any of [")) else escaped


def set_inside_quotes(elements: Iterable[str]) -> str:
    """Return a set as it stands between the double quotes of a step: a list of strings as Python writes it."""
    return _quotable(str(list(elements)))


def guarded(text: str) -> str:
    """Return what ``free`` made for use within ``( … )``: nothing in it closes, opens or splits the group."""
    return _GROUPING.sub(lambda match: match[0] if match[1] else f"\\{match[0]}", text)


def cell(text: str) -> str:
    """Return a text as it stands in a table."""
    return text.replace("\\", "\\\\").replace("|", "\\|")


def tag(kind: str, iri: str) -> str:
    """Return the tag that carries an IRI, without its ``@``: ``clause=https:;;example.org;part``.

    ``;`` stands for a slash and ``=XX`` for a byte in hexadecimal digits: some runners drop all other characters.
    """
    return f"{kind}={_UNSAFE_IN_TAGS.sub(_encoded, iri)}"


def read_tag(text: str) -> tuple[str, str] | None:
    """Return kind and IRI of a tag that ``tag`` has made, with or without its ``@``; ``None`` for any other."""
    match = _TAG.fullmatch(text)
    if match is None:
        return None
    with_slashes = match[2].replace(";", "/")
    return match[1], _ENCODED.sub(lambda found: bytes.fromhex(found[0].replace("=", "")).decode(), with_slashes)


def _encoded(found: re.Match[str]) -> str:
    return ";" if found[0] == "/" else "".join(f"={byte:02X}" for byte in found[0].encode())


def _quotable(text: str) -> str:
    return _control_escaped(text.replace("\\", "\\\\").replace('"', '\\"'))


def _control_escaped(text: str) -> str:
    return _CONTROL.sub(lambda match: _NAMED.get(match[0], f"\\u{ord(match[0]):04x}"), text)
