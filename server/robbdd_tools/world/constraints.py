"""Refuse objects that constraints in their file hold: in the simulated world, an object has joints only."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError

if TYPE_CHECKING:
    from collections.abc import Collection

    from robbdd_tools.catalog.executable import ModelSource

_TENDON = "tendon"


def refuse_constraints(model: Any, bodies: Collection[int], source: ModelSource) -> None:
    """Raise ``SceneError`` if an equality or a tendon of a compiled file acts on one of the ``bodies``.

    Without it, the object would move as nothing in the file can: a part that is welded to its fixture could be lifted.
    """
    for kind, name, acted_on in (*_equalities(model), *_tendons(model)):
        own = [body for body in acted_on if body in bodies]
        if own:
            named = f" '{name}'" if name else ""
            raise SceneError(
                f"the {kind}{named} in {source.name} acts on '{model.body(own[0]).name}', and cannot be simulated: "
                "an object moves freely or by its joints; remove it in a copy of the file",
                origin=source.origin,
            )


def _equalities(model: Any) -> Iterator[tuple[str, str, list[int]]]:
    """Yield the kind of each active equality, its name and the bodies on which it acts."""
    kinds = {int(kind): kind.name.removeprefix("mjEQ_").lower() for kind in mujoco.mjtEq.__members__.values()}
    for number in range(model.neq):
        if not model.eq_active0[number]:
            continue
        kind = kinds.get(int(model.eq_type[number]), "")
        ends = [int(model.eq_obj1id[number]), int(model.eq_obj2id[number])]
        found = [
            body for end in ends if end >= 0 for body in _bodies_of(model, kind, int(model.eq_objtype[number]), end)
        ]
        yield f"{kind} constraint", str(model.equality(number).name), found


def _bodies_of(model: Any, kind: str, objects: int, end: int) -> list[int]:
    if kind == "joint":
        return [int(model.jnt_bodyid[end])]
    if kind == _TENDON:
        return _along(model, end)
    if objects == int(mujoco.mjtObj.mjOBJ_SITE):
        return [int(model.site_bodyid[end])]
    return [end] if objects == int(mujoco.mjtObj.mjOBJ_BODY) else []


def _tendons(model: Any) -> Iterator[tuple[str, str, list[int]]]:
    """Yield each tendon with the bodies on which it acts."""
    for number in range(model.ntendon):
        yield _TENDON, str(model.tendon(number).name), _along(model, number)


def _along(model: Any, tendon: int) -> list[int]:
    """Return the bodies whose sites, geoms or joints a tendon connects."""
    wraps = mujoco.mjtWrap
    owners = {
        int(wraps.mjWRAP_SITE): model.site_bodyid,
        int(wraps.mjWRAP_SPHERE): model.geom_bodyid,
        int(wraps.mjWRAP_CYLINDER): model.geom_bodyid,
        int(wraps.mjWRAP_JOINT): model.jnt_bodyid,
    }
    first = int(model.tendon_adr[tendon])
    parts = range(first, first + int(model.tendon_num[tendon]))
    kinds = ((int(model.wrap_type[part]), int(model.wrap_objid[part])) for part in parts)
    return [int(owners[kind][item]) for kind, item in kinds if kind in owners]
