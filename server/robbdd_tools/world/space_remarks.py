"""Remarks of a run on workspaces that are not where their names suggest."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.catalog.name_words import parts_named
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.world.scene import contents_of, local_name

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Region
    from robbdd_tools.protocol.specs import SceneSpec
    from robbdd_tools.world.cast import Cast

REMEDY = "name a box site of its model after each, or state boxes in a .scenex"


def space_remarks(scene: SceneSpec, cast: Cast) -> Iterator[tuple[str, str]]:
    """Yield workspaces with a remark: those that are one space, and those that are all spaces of an object."""
    same: dict[tuple[tuple[str, Region], ...], list[str]] = {}
    for workspace in scene.workspaces:
        inside = any(workspace in contents_of(scene, other) for other in scene.contains)
        if not inside and cast.regions.get(workspace):
            same.setdefault(cast.regions[workspace], []).append(workspace)
    for (one, *_), workspaces in same.items():
        if len(workspaces) > 1:
            for workspace in workspaces:
                yield workspace, f"the same space of '{one[0]}', so what is at one of them is at each; {REMEDY}"
        elif _is_all(workspaces[0], cast.regions[workspaces[0]], cast):
            yield workspaces[0], f"all workspaces of '{one[0]}', as no site of its model has this name"


def _is_all(workspace: str, regions: tuple[tuple[str, Region], ...], cast: Cast) -> bool:
    """Return whether a workspace consists of several named spaces of a file, of none of which it has the name."""
    names = [region.name for _, region in regions if region.name]
    from_file = all(cast.objects[one].name not in load_catalog().objects for one, _ in regions)
    return len(names) > 1 and from_file and not parts_named(names, local_name(workspace))
