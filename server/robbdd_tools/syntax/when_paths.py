"""Paths of the parts of a body and of a ``When``, after which nodes of the graph are named."""

from __future__ import annotations


def part_path(path: str, number: int) -> str:
    """Return the path of part ``number`` (from 0) of a body that has the given path.

    The first part keeps the names that a body with one part has.
    """
    return f"{path}.part{number + 1}" if number else path


def when_path(path: str, number: int) -> str:
    """Return the path of part ``number`` (from 0) of a ``When``; nodes of the graph are named after it.

    ``path`` is the path of the part of the body. The first part keeps the name that a ``When`` with one behaviour has.
    """
    return f"{path}.when{number + 1 if number else ''}"
