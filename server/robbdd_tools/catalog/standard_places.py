"""Standard places of catalog models that no executable scene places, and how many objects have room."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import ShapeKind

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import ObjectModel, Vector

SIDES = 4
"""Number of sides of a table; one agent has room at each."""


class NoRoom(ValueError):
    """An element has no place; the message says where room ran out. ``name`` is the element."""

    def __init__(self, name: str, message: str) -> None:
        super().__init__(message)
        self.name = name


def at_places(models: Mapping[str, ObjectModel], names: Iterable[str], where: str) -> Iterator[tuple[str, Vector]]:
    """Yield each object with the first free standard place of its kind; raises ``NoRoom``."""
    used: list[tuple[Vector, ObjectModel]] = []
    for name in names:
        model = models[name]
        if not model.places:
            raise NoRoom(name, without_place(name, model))
        free = (place for place in model.places if not any(_overlapping(place, model, *one) for one in used))
        place = next(free, None)
        if place is None:
            room = f"there is room for {len(model.places)} objects of the kind '{model.name}' on {where}"
            raise NoRoom(name, f"{room}, minus the occupied places; '{name}' has no place")
        used.append((place, model))
        yield name, place


def without_place(name: str, model: ObjectModel) -> str:
    """Return what is wrong with an object that has neither a pose nor a standard place."""
    return f"'{name}' has no pose: place it in the .scenex; its model ({model.doc}) has no standard place"


def _overlapping(place: Vector, model: ObjectModel, other_place: Vector, other: ObjectModel) -> bool:
    reach = (one + two for one, two in zip(_half(model), _half(other), strict=True))
    return all(abs(a - b) < r for a, b, r in zip(place, other_place, reach, strict=False))


def _half(model: ObjectModel) -> tuple[float, float]:
    """Return half the edges (m) of the area that an object needs: its workspace's area, else the area of its shapes."""
    if model.region is not None:
        return model.region.half[:2]
    ends = [(shape.position, shape.size[0], shape.size[shape.kind is ShapeKind.BOX]) for shape in model.shapes]
    return max(abs(at[0]) + x for at, x, _ in ends), max(abs(at[1]) + y for at, _, y in ends)
