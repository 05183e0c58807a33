"""One part of a robot's or an object's model file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class ModelPart:
    """A part of a model file.

    - ``kind``: ``body``, ``joint``, ``site``, ``geom`` or ``actuator``; a link of URDF is a body, and its collision
      shapes are geoms. ``visual`` is a URDF shape without collisions.
    - ``name``: its name, or ``""``.
    - ``word``: the format's own word for the kind, such as ``link``.
    - ``owner``: the body that it belongs to, or ``""``.
    - ``facts``: what the file states about it, in words with units.
    - ``path`` and ``start``: its file, and the offset of its element in code points.
    """

    kind: str
    name: str
    word: str
    owner: str
    facts: tuple[str, ...]
    path: Path
    start: int


def numbers_in(text: str | None) -> tuple[float, ...]:
    """Return the numbers in an attribute; none if it contains anything else."""
    try:
        return tuple(float(number) for number in (text or "").split())
    except ValueError:
        return ()
