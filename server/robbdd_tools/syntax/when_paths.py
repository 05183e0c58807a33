"""Paths of the parts of a ``When``, after which nodes of the graph are named."""

from __future__ import annotations


def when_path(path: str, number: int) -> str:
    """Return the path of part ``number`` (from 0) of a ``When``; nodes of the graph are named after it.

    ``path`` is the path of the body. The first part keeps the name that a ``When`` with one behaviour has.
    """
    return f"{path}.when{number + 1 if number else ''}"
