"""Find the chain of bodies from the base of an arm's file to its hand, and the joints that belong to neither."""

from __future__ import annotations

import re
from dataclasses import dataclass
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.gripper_names import MOUNT, name_in_file
from robbdd_tools.world.srdf_semantics import path_to

if TYPE_CHECKING:
    from robbdd_tools.catalog.executable import ArmModel, ModelSource

TO_HAND = 3
"""An arm has at least this many joints above its hand; a finger of several links has fewer above a branch."""
_JAW = re.compile(r"jaw|grip|finger|claw|mover", re.IGNORECASE)
"""Words in the names of links and joints that are jaws."""
WIDE, LONG = 2.5, 0.2
"""A jaw turns (rad) or slides (m) by at most this much; a wrist turns farther."""
MAX_LISTED = 30
"""Maximum number of names in a message."""
BARE = 6
"""A branch without fingers is an arm from this many joints on, if it is no finger of an arm itself."""


@dataclass(frozen=True, slots=True)
class Chain:
    """The bodies from the base to the palm, and the joints of branches beside them: a head, wheels, another arm."""

    bodies: list[Any]
    beside: tuple[str, ...]


def chain_to_palm(spec: Any, source: ModelSource, arm: ArmModel) -> Chain:
    """Return the bodies from the base to the palm, which carries all gripping faces. Raises ``SceneError``.

    Without stated faces, the palm is the first body with several jointed branches of which none leads to a hand, or
    else the last body, but no body beyond the stated tool. If the last body is a jaw, the palm is the body before it.
    Of several hands, the one that carries the tool or the mounted gripper is chosen.
    """
    tool = path_to(body_of(spec, source.gripper or source, arm.tool, "tool")) if arm.tool else []
    carriers = [spec.geom(pad).parent if spec.geom(pad) is not None else spec.body(pad) for pad in arm.pads]
    paths = [[str(body.name) for body in path_to(one)] for one in carriers if one is not None]
    mount = [str(one.name) for one in path_to(spec.body(MOUNT))] if arm.mounted is not None else []
    named = [str(one.name) for one in tool] or (paths[0] if paths else mount)
    bodies, beside = _descent(spec, source, named)
    if len(paths) > 1 and len(paths) == len(arm.pads):
        common = [name for name in paths[0] if all(name in path for path in paths)]
        if common:
            return Chain(path_to(spec.body(common[-1])), beside)
    body = bodies[-1] if bodies else spec.worldbody
    branches = [child for child in body.bodies if _moves(child)]
    suctions = [one for one in spec.actuators if one.trntype == mujoco.mjtTrn.mjTRN_BODY]
    if not branches and suctions:
        body = spec.body(str(suctions[0].target))
    if not branches and len(carriers) == 1 and carriers[0] is not None:
        body = carriers[0]
    elif not branches and not suctions and not tool and is_jaw(body):
        body = body.parent
    if body.name == "world":
        text = f"{source.name} is not one arm: " + (
            f"{len(branches)} chains of joints begin at its base" if branches else "it has no joints"
        )
        raise SceneError(text, origin=source.origin)
    common = {one.name for one in tool}
    return Chain([one for one in path_to(body) if not tool or one.name in common], beside)


def is_jaw(body: Any) -> bool:
    """Return whether the last body of a chain is a jaw that closes on the hand before it, by its name and its range."""
    if len(body.joints) != 1 or not any(_JAW.search(str(one.name)) for one in (body, *body.joints)):
        return False
    (joint,) = body.joints
    turns = joint.type == mujoco.mjtJoint.mjJNT_HINGE
    return 0.0 < float(joint.range[1] - joint.range[0]) <= (WIDE if turns else LONG)


def _descent(spec: Any, source: ModelSource, named: list[str]) -> tuple[list[Any], tuple[str, ...]]:
    """Return the bodies from the base to the first one from which no single branch leads on, and the joints beside.

    ``named`` are the bodies from the base to a stated part of the hand.
    """
    body, found, beside = spec.worldbody, list[Any](), list[str]()
    while True:
        branches = [child for child in body.bodies if _moves(child)]
        bare = BARE if sum(len(one.joints) for one in found) < BARE else None
        onward = branches if len(branches) == 1 else [one for one in branches if _hand_of(one, bare) is not None]
        chosen = [one for one in onward if one.name in named] or onward
        if len(chosen) > 1:
            hands = ", ".join(f"'{_hand_of(one, bare)}'" for one in chosen)
            raise SceneError(
                f"{source.name} has {len(chosen)} arms, with the hands {hands}: name a body or a site of one hand, "
                'tool: "…"; the joints of the others are then fixed',
                origin=source.origin,
            )
        if not chosen:
            return found, tuple(beside)
        beside += [str(joint.name) for one in branches if one.name != chosen[0].name for joint in _joints_in(one)]
        body = chosen[0]
        found.append(body)


def _hand_of(branch: Any, bare: int | None) -> str | None:
    """Return the name of the hand to which a branch leads; ``None`` for a finger, a wheel or a head.

    A branch with at least ``bare`` joints leads to one without fingers, too.
    """
    body, joints = branch, len(branch.joints)
    while True:
        branches = [child for child in body.bodies if _moves(child)]
        if len(branches) != 1:
            break
        body = branches[0]
        joints += len(body.joints)
    below = [hand for one in branches if (hand := _hand_of(one, bare)) is not None]
    if below:
        return below[0]
    enough = TO_HAND if branches else bare
    return str(body.name) if enough is not None and joints >= enough else None


def body_of(spec: Any, source: ModelSource, name: str, what: str) -> Any:
    """Return the body with a name, or with the site of this name, which ``what`` needs. Raises ``SceneError``."""
    site = spec.site(name)
    body = site.parent if site is not None else spec.body(name)
    if body is None:
        near = get_close_matches(name, [str(one.name) for one in (*spec.sites, *spec.bodies[1:])], n=1)
        sites, bodies = _names(spec.sites), _names(spec.bodies[1:])
        known = f"it has the sites {sites} and the bodies {bodies}"
        if near:
            known = f"did you mean '{name_in_file(near[0])}'?"
        missing = f"{source.name} has no site or body '{name_in_file(name)}' for the {what}"
        raise SceneError(f"{missing}; {known}", origin=source.origin)
    return body


def _names(things: Any) -> str:
    names = [name_in_file(str(thing.name)) for thing in things if thing.name]
    return ", ".join(names[:MAX_LISTED]) + (" …" if len(names) > MAX_LISTED else "") or "none"


def _moves(body: Any) -> bool:
    return bool(body.joints) or any(_moves(child) for child in body.bodies)


def _joints_in(body: Any) -> list[Any]:
    return [*body.joints, *(joint for one in body.find_all("body") for joint in one.joints)]
