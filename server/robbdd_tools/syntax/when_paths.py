"""Make the paths of the parts of a body and of a ``When``. Nodes of the graph are named after these paths."""

from __future__ import annotations


def part_path(path: str, number: int) -> str:
    """Return the path of part ``number`` (from 0) of a body that has the given path.

    The first part has the same path as the body, so its names do not change when further parts are added.
    """
    return f"{path}.part{number + 1}" if number else path


def when_path(path: str, number: int) -> str:
    """Return the path of part ``number`` (from 0) of a ``When``.

    ``path`` is the path of the part of the body. The path of the first part is the same for one or several behaviours.
    """
    return f"{path}.when{number + 1 if number else ''}"
