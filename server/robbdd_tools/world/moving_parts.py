"""Moving parts of objects of model files, such as drawers, doors and levers, with the joints between them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from robbdd_tools.base.articulation import PassiveJoint
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.catalog.executable import ModelSource

_KINDS: dict[int, Literal["slide", "hinge"]] = {
    int(mujoco.mjtJoint.mjJNT_SLIDE): "slide",
    int(mujoco.mjtJoint.mjJNT_HINGE): "hinge",
}


HANDLES = ("handle", "knob", "grip")
"""A shape is a handle, held to open the thing, if its name or its body's name contains one of these words."""


def is_free(model: Any, body: int) -> bool:
    """Return whether a body of a file has a free joint."""
    joint = int(model.body_jntadr[body])
    return joint >= 0 and int(model.jnt_type[joint]) == int(mujoco.mjtJoint.mjJNT_FREE)


def rigid_root(model: Any, body: int, root: int) -> int | None:
    """Return the body that carries a body rigidly: ``root`` or a jointed body below it; ``None`` outside ``root``."""
    found = body
    while found > 0 and found != root and not int(model.body_jntnum[found]):
        found = int(model.body_parentid[found])
    inside = found
    while inside > 0 and inside != root:
        inside = int(model.body_parentid[inside])
    return found if inside == root else None


def joint_bodies(model: Any, root: int) -> Iterator[int]:
    """Yield the bodies below ``root`` that move relative to it, each after the bodies that carry it."""
    for body in range(root + 1, model.nbody):
        if int(model.body_jntnum[body]) and rigid_root(model, body, root) == body:
            yield body


def joint_of(model: Any, data: Any, body: int, parent: int, source: ModelSource) -> PassiveJoint:
    """Return the joint that connects a body to the body with the number ``parent``, 0 for the world.

    Raises ``SceneError`` for a body with several joints or with a ball or free joint.
    """
    name = name_of_body(model, body)
    number = int(model.body_jntadr[body])
    kind = _KINDS.get(int(model.jnt_type[number]))
    if int(model.body_jntnum[body]) > 1 or kind is None:
        how = "several joints" if int(model.body_jntnum[body]) > 1 else "a ball or free joint"
        message = (
            f"the moving part '{name}' of {source.name} has {how}: only one sliding or rotating joint is supported"
        )
        raise SceneError(message, origin=source.origin)
    dof = int(model.jnt_dofadr[number])
    zero = float(model.qpos0[int(model.jnt_qposadr[number])])
    low, high = (float(end) for end in model.jnt_range[number])
    place, turn = _relative(data, body, parent)
    return PassiveJoint(
        parent=name_of_body(model, parent) if parent else "",
        kind=kind,
        axis=_three(model.jnt_axis[number]),
        anchor=_three(model.jnt_pos[number]),
        position=_three(place),
        rotation=_four(turn),
        zero=zero,
        bounds=(low, high) if model.jnt_limited[number] else None,
        start=zero,
        friction=float(model.dof_frictionloss[dof]),
        damping=float(model.dof_damping[dof]),
        stiffness=float(model.jnt_stiffness[number]),
        rest=float(model.qpos_spring[int(model.jnt_qposadr[number])]),
        armature=float(model.dof_armature[dof]),
    )


def handle_of(names: Iterable[str]) -> int | None:
    """Return the number of the first shape that is a handle, judged by the names of shapes and bodies."""
    return next((i for i, name in enumerate(names) if any(word in name.lower() for word in HANDLES)), None)


def name_of_body(model: Any, body: int) -> str:
    """Return the name of a body in the file; one without a name gets its number."""
    return str(model.body(body).name) or f"part{body}"


def joint_name(model: Any, body: int) -> str:
    """Return the name of a body's joint in the file."""
    return str(model.joint(int(model.body_jntadr[body])).name)


def _relative(data: Any, body: int, parent: int) -> tuple[FloatArray, FloatArray]:
    frame = data.xmat[parent].reshape(3, 3)
    place: FloatArray = frame.T @ (data.xpos[body] - data.xpos[parent])
    inverse, turn = data.xquat[parent].copy(), data.xquat[body].copy()
    mujoco.mju_negQuat(inverse, data.xquat[parent])
    mujoco.mju_mulQuat(turn, inverse, data.xquat[body])
    return place, turn


def _three(numbers: Any) -> tuple[float, float, float]:
    x, y, z = (float(number) for number in numbers)
    return (x, y, z)


def _four(numbers: Any) -> tuple[float, float, float, float]:
    w, x, y, z = (float(number) for number in numbers)
    return (w, x, y, z)
