"""``pose``: a position does not have exactly three numbers, or an orientation is invalid.

This is a warning, because only a run that uses the pose for a placement fails.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.checks.distribution import drawn
from robbdd_tools.checks.finding import finding
from robbdd_tools.graph.write.rotations import numbers_of, rotation_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.elements import Site

CODE = "pose"


def pose(site: Site) -> Iterator[Diagnostic]:
    """Report invalid positions and orientations of poses."""
    if not isinstance(site.tree, tree.SceneInstance | tree.KinematicTree):
        return
    for node in walk(site.tree):
        if isinstance(node, tree.WorkspaceBox | tree.Gripper):
            yield from _part(site, node)
        if isinstance(node, tree.Pose) and site.whole(node):
            yield from _position(site, node.position)
            orientation = node.orientation
            yield from _orientation(site, orientation if isinstance(orientation, tree.Sample) else orientation.value)


def _part(site: Site, part: tree.WorkspaceBox | tree.Gripper) -> Iterator[Diagnostic]:
    what, size = ("a box", part.size) if isinstance(part, tree.WorkspaceBox) else ("a gripper", None)
    for written, word in ((part.offset, "an offset"), (size, "a size")):
        count = 3 if written is None else len(numbers_of(written))
        if written is not None and count != 3:
            yield _described(site, written, f"{word} needs 3 numbers, not {count}")
    if part.orientation is None:
        return
    if isinstance(part.orientation.value, tree.Sample):
        reason = f"the orientation of {what} cannot be drawn at random: write a rotation"
        yield _described(site, part.orientation, reason)
    else:
        yield from _orientation(site, part.orientation.value)


def _position(site: Site, written: tree.Vector | tree.Sample) -> Iterator[Diagnostic]:
    count = _count(site, written) if isinstance(written, tree.Sample) else len(numbers_of(written))
    if count not in (3, None):
        yield _described(site, written, f"a position needs 3 numbers, not {count}")


def _orientation(site: Site, written: tree.Vector | tree.EulerAngles | tree.Axes | tree.Sample) -> Iterator[Diagnostic]:
    match written:
        case tree.Sample():
            count = _count(site, written)
            if count not in (3, 4, None):
                yield _described(site, written, f"an orientation needs 3 angles or a rotation, not {count} numbers")
        case _ if rotation_of(written) is not None:
            return
        case tree.Vector():
            yield _described(site, written, "this is not a rotation: a quaternion has 4 numbers, not all of them 0")
        case tree.EulerAngles():
            yield _described(site, written.angles, "this is not a rotation: it has 3 angles")
        case tree.Axes():
            text = "these axes are not a rotation: they must be of length 1, at right angles and right-handed"
            yield _described(site, written, text)


def _count(site: Site, sample: tree.Sample) -> int | None:
    """Return the number of values in a sample, or ``None`` if its distribution is unknown."""
    found = site.follow(sample.distribution)
    declared = None if found is None else found.tree
    return drawn(declared.law) if isinstance(declared, tree.Distribution) else None


def _described(site: Site, node: tree.Node, text: str) -> Diagnostic:
    return finding(site, node, Severity.WARNING, CODE, text)
