"""Map the geoms of a compiled world to the elements of the scene that own them."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable
from typing import Any

SCENERY = "scenery"
_BELT = re.compile(r"/belt\d+\Z")


def scenery_name(number: int) -> str:
    """Return the name of a model of the whole scene: the prefix of its bodies and geoms."""
    return f"{SCENERY}{number}"


def shape_name(owner: str, shape: str | int) -> str:
    """Return the name of a geom in the world, made of its owner and of the number or the name of the shape."""
    return f"{owner}/shape{shape}" if isinstance(shape, int) else f"{owner}/{shape}"


def is_scenery(name: str) -> bool:
    """Return whether a name belongs to a model of the whole scene; names of elements have a namespace."""
    return name.startswith(SCENERY) and name[len(SCENERY) :].isdecimal()


def joint_of_part(name: str) -> str:
    """Return the name of a moving part's joint in the world."""
    return f"{name}/joint"


def whole_of(name: str, objects: Collection[str]) -> str:
    """Return the object that a moving part belongs to if the scene does not declare the part, else the name itself."""
    whole = name.rpartition("/")[0]
    return whole if whole in objects else name


def geom_owners(model: Any, agents: Iterable[str]) -> list[str]:
    """Return the name of each geom's agent or object.

    The owner of a geom of the scenery is its body. A geom of the room is listed by its own name.
    """
    return [_owner_of(model, geom, tuple(agents)) for geom in range(model.ngeom)]


def _owner_of(model: Any, geom: int, agents: tuple[str, ...]) -> str:
    name = str(model.body(int(model.geom_bodyid[geom])).name)
    named = str(model.geom(geom).name)
    for agent in agents:
        if name.startswith(f"{agent}/") or named.startswith(f"{agent}/"):
            return agent
    # A belt belongs to its object.
    body = _BELT.sub("", name)
    return named or f"geom {geom}" if body == "world" else body
