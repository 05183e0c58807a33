"""Find hand, tool, home and both ends of the gripper of an arm in its SRDF file."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.srdf import Srdf, UnreadableSrdf, read_srdf, srdf_files
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.model_files import path_of

if TYPE_CHECKING:
    from robbdd_tools.base.srdf import State
    from robbdd_tools.catalog.executable import ArmModel, ModelSource

HOMES, OPENS, CLOSES = ("home", "ready", "default"), "open", "clos"
"""Names of home states, best first; beginnings of the names of states with an open and with a closed gripper."""


@dataclass(frozen=True, slots=True)
class Semantics:
    """Data about an arm from its SRDF file; all are empty without a file.

    - ``palm``: the body that carries the joints of the end effector.
    - ``tip``: the tool: the end of the arm's chain, if it is beyond the palm.
    - ``arm``, ``gripper``: the moving joints of the two groups.
    - ``homes``: states of the arm's group, states named home first.
    - ``opened``, ``closed``: states of the gripper's group.
    """

    file: str = ""
    palm: str = ""
    tip: str = ""
    arm: frozenset[str] = frozenset()
    gripper: frozenset[str] = frozenset()
    homes: tuple[State, ...] = ()
    opened: State | None = None
    closed: State | None = None

    def complete(self, spec: Any, arm: ArmModel) -> ArmModel:
        """Return the data about an arm, completed from the SRDF file where nothing is stated."""
        leader = arm.actuator or next((name for name in _leaders(spec) if name in self.gripper), "")
        ends = [state.positions.get(leader) if state is not None else None for state in (self.opened, self.closed)]
        if arm.open is None and arm.closed is None and None not in ends and ends[0] != ends[1]:
            arm = replace(arm, open=ends[0], closed=ends[1])
        return replace(arm, tool=arm.tool or self.tip)

    def note(self, stated: ArmModel, completed: ArmModel) -> str:
        """Return the end of an error message about a gripper if its values are from the SRDF file."""
        if stated.open == completed.open or self.opened is None or self.closed is None:
            return ""
        return f". The values are those of the states '{self.opened.name}' and '{self.closed.name}' of {self.file}"


def file_of(source: ModelSource) -> Srdf | None:
    """Return the SRDF file of an arm, ``None`` if it has none or several. Raises ``SceneError``."""
    found = srdf_files(path_of(source)) if source.kind in ("file", "ros") else ()
    if len(found) != 1:
        return None
    try:
        return read_srdf(found[0])
    except UnreadableSrdf as error:
        text = f"the semantic description {error}. Correct it, or remove it"
        raise SceneError(text, origin=source.origin) from error


def apply_srdf(spec: Any, source: ModelSource) -> Semantics:
    """Return the data of an arm's SRDF file, and apply them to the engine's editable description of the arm.

    Collisions that the file disables are excluded. Joints outside arm and end effector are fixed at their position in
    the URDF file. If the SRDF file does not have exactly one moving end effector, it only excludes collisions. Raises
    ``SceneError``.
    """
    srdf = file_of(source)
    if srdf is None:
        return Semantics()
    for one, other in srdf.apart:
        if one != other and spec.body(one) is not None and spec.body(other) is not None:
            spec.add_exclude(bodyname1=one, bodyname2=other)
    groups = {name: frozenset(_joints(spec, srdf, name, frozenset())) for name in srdf.groups}
    effectors = [(group, parent) for group, parent in srdf.effectors if groups.get(group)]
    if len(effectors) != 1:
        return Semantics(srdf.path.name)
    effector, parent = effectors[0]
    gripper = groups[effector]
    palm = _palm(spec, gripper)
    above = {str(joint.name) for body in path_to(palm) for joint in body.joints}
    arms = [name for name, joints in groups.items() if joints and joints <= above]
    name = parent if parent in arms else max(arms, key=lambda one: len(groups[one]), default="")
    if not name or palm.name == "world":
        return Semantics(srdf.path.name)
    inside = {str(body.name) for body in palm.find_all("body")}
    tips = [tip for _, tip in srdf.groups[name].chains if tip in inside]
    _fix_others(spec, frozenset(above) | {str(one.name) for body in palm.find_all("body") for one in body.joints})
    hands = [state for state in srdf.states if state.group == effector]
    return Semantics(
        srdf.path.name,
        str(palm.name),
        tips[0] if tips else "",
        frozenset(above),
        gripper,
        tuple(sorted((one for one in srdf.states if one.group == name), key=_rank)),
        next((one for one in hands if one.name.lower().startswith(OPENS)), None),
        next((one for one in hands if one.name.lower().startswith(CLOSES)), None),
    )


def path_to(body: Any) -> list[Any]:
    """Return the bodies from the base of a model to ``body``, without the world."""
    found: list[Any] = []
    while body is not None and body.name != "world":
        found.insert(0, body)
        body = body.parent
    return found


def _rank(state: State) -> int:
    return next((number for number, word in enumerate(HOMES) if word in state.name.lower()), len(HOMES))


def _joints(spec: Any, srdf: Srdf, name: str, seen: frozenset[str]) -> Iterator[str]:
    """Yield the moving joints of a group and of the groups in it."""
    group = srdf.groups.get(name)
    if group is None or name in seen:
        return
    for joint in group.joints:
        if spec.joint(joint) is not None:
            yield joint
    bodies = [spec.body(link) for link in group.links]
    for base, tip in group.chains:
        path = path_to(spec.body(tip))
        names = [str(body.name) for body in path]
        bodies += path[names.index(base) + 1 :] if base in names else path
    yield from (str(joint.name) for body in bodies if body is not None for joint in body.joints)
    for inner in group.groups:
        yield from _joints(spec, srdf, inner, seen | {name})


def _palm(spec: Any, joints: frozenset[str]) -> Any:
    """Return the last body that carries all of the joints ``joints`` and all joints that follow them."""
    following = {str(one.name1) for one in _couplings(spec) if one.name2 in joints}
    paths = [path_to(spec.joint(joint).parent.parent) for joint in joints | following]
    common = [body for body in paths[0] if all(body.name in {str(one.name) for one in path} for path in paths)]
    return common[-1] if common else spec.worldbody


def _couplings(spec: Any) -> list[Any]:
    return [one for one in spec.equalities if one.type == mujoco.mjtEq.mjEQ_JOINT]


def _leaders(spec: Any) -> Iterator[str]:
    """Yield the joints that follow no other joint."""
    followers = {str(one.name1) for one in _couplings(spec)}
    return (str(joint.name) for joint in spec.joints if joint.name not in followers)


def _fix_others(spec: Any, moving: frozenset[str]) -> None:
    for coupling in _couplings(spec):
        if coupling.name1 not in moving:
            spec.delete(coupling)
    for joint in list(spec.joints):
        if joint.name not in moving:
            spec.delete(joint)
