"""Escape user text in features so that every parser reads it back unchanged.

A feature consists of lines. Values in a step are in double quotes, and cells of a table are between bars. In user
text, these delimiters are written with a backslash: ``\\n``, ``\\"``, ``\\\\``, and ``\\uXXXX`` for other line
terminators.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

_NAMED = {"\n": "\\n", "\r": "\\r", "\t": "\\t"}
# Control characters of terminals, and the line terminators of str.splitlines, which behave uses.
_CONTROL = re.compile("[\x00-\x1f\x7f-\x9f\u2028\u2029]")
# Quoted or escaped text, or tokens that have a meaning in a group.
_GROUPING = re.compile(r'("(?:[^"\\]|\\.)*"|\\.)|[()"]|(?<!\S)(?:and|or|not)(?!\S)')
_TAG = re.compile(r"@?([a-z]+)=((?:[A-Za-z0-9.:_;-]|=[0-9A-F]{2})*)")
_UNSAFE_IN_TAGS = re.compile(r"[^A-Za-z0-9.:_-]")
_ENCODED = re.compile(r"(?:=[0-9A-F]{2})+")


def line(text: str) -> str:
    """Return a text for a name or a narrative: one line, stripped."""
    return " ".join(_CONTROL.sub(" ", text).split())


def free(text: str) -> str:
    """Return a text for use in a step outside quotes. It is stripped, because parsers drop white space at both ends."""
    return _control_escaped(text.strip().replace("\\", "\\\\"))


def inside_quotes(text: str) -> str:
    """Return a string for use between the double quotes of a step.

    A string that looks like a set (``[…]``, ``any of […]``) gets a backslash in front, so that it is not read as a set.
    """
    escaped = _quotable(text)
    return f"\\{escaped}" if escaped.startswith(("[", "any of [")) else escaped


def set_inside_quotes(elements: Iterable[str]) -> str:
    """Return a set for use between the double quotes of a step. It is written as a Python list of strings."""
    return _quotable(str(list(elements)))


def in_group(text: str) -> str:
    """Escape the result of ``free`` for use within ``( … )``, so that it does not close, open or split the group."""
    return _GROUPING.sub(lambda match: match[0] if match[1] else f"\\{match[0]}", text)


def cell(text: str) -> str:
    """Return a text for a table cell."""
    return text.replace("\\", "\\\\").replace("|", "\\|")


def tag(kind: str, iri: str) -> str:
    """Return the tag for an IRI, without its ``@``: ``clause=https:;;example.org;part``.

    ``;`` replaces a slash, and ``=XX`` is a byte in hexadecimal digits, because some runners drop all other characters.
    """
    return f"{kind}={_UNSAFE_IN_TAGS.sub(_encoded, iri)}"


def read_tag(text: str) -> tuple[str, str] | None:
    """Return the kind and the IRI of a tag made by ``tag``, or ``None`` for any other tag. The ``@`` may be missing."""
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
