"""The workspaces of an object that are sites of its file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from robbdd_tools.catalog.api import Region
from robbdd_tools.catalog.name_words import is_named
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.moving_parts import rigid_root
from robbdd_tools.world.region_frames import box_of

SITE = "workspace"


def workspace_sites(model: Any, bodies: Sequence[int], workspaces: Sequence[str]) -> list[int]:
    """Return the sites of an object's ``bodies`` that are workspaces.

    Their names end with 'workspace', or they are boxes with the name of one of the ``workspaces`` that it carries.
    """
    return [
        site
        for site in range(model.nsite)
        if int(model.site_bodyid[site]) in bodies and _is_workspace(model, site, workspaces)
    ]


def _is_workspace(model: Any, site: int, workspaces: Sequence[str]) -> bool:
    name = str(model.site(site).name)
    is_box = int(model.site_type[site]) == int(mujoco.mjtGeom.mjGEOM_BOX)
    return name.endswith(SITE) or (is_box and any(is_named(name, workspace) for workspace in workspaces))


def spaces_of_sites(
    model: Any, data: Any, sites: Sequence[int], movers: Sequence[int], root: int
) -> Mapping[int, tuple[Region, ...]]:
    """Map each moving body of an object to its workspaces.

    Of several, each has as its name that of its site, without 'workspace' at the end.
    """
    found: list[tuple[int, Region]] = []
    for site in sites:
        body = rigid_root(model, int(model.site_bodyid[site]), root)
        assert body is not None, "a site of the object's bodies"
        frame = data.xmat[body].reshape(3, 3)
        center = frame.T @ (data.site_xpos[site] - data.xpos[body])
        half, turn = box_of(model.site_size[site], frame.T @ data.site_xmat[site].reshape(3, 3))
        part = str(model.site(site).name).removesuffix(SITE).strip(" _-.").lower()
        (x, y, z), (a, b, c) = center.tolist(), half.tolist()
        found.append((body, Region((x, y, z), (a, b, c), part, turn=turn)))
    if len(found) == 1:
        found = [(body, replace(region, name="")) for body, region in found]
    return {body: tuple(region for one, region in found if one == body) for body in movers if found}
