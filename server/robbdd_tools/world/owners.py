"""The owner, an element of the scene, of each geom of a compiled world."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any


def geom_owners(model: Any, agents: Iterable[str]) -> list[str]:
    """Return the name of each geom's agent or object.

    A geom of the scenery is owned by its body, one of the room has its own name.
    """
    return [_owner_of(model, geom, tuple(agents)) for geom in range(model.ngeom)]


def _owner_of(model: Any, geom: int, agents: tuple[str, ...]) -> str:
    name = str(model.body(int(model.geom_bodyid[geom])).name)
    named = str(model.geom(geom).name)
    for agent in agents:
        if name.startswith(f"{agent}/") or named.startswith(f"{agent}/"):
            return agent
    # A belt belongs to its object.
    body = name.partition("/belt")[0]
    return named or f"geom {geom}" if body == "world" else body
