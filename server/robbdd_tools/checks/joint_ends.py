"""``joint-ends``: a joint connects a body to itself, or a body of a kinematic tree is the child of two joints."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.checks.finding import finding, related_to
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.elements import Site

CODE = "joint-ends"
_Body = tuple[str, str, str]
"""A body: its file, its qualified name, and the name as written, which distinguishes instances of one template."""


def joint_ends(site: Site) -> Iterator[Diagnostic]:
    """Report both kinds of joints. In a ``kgraph``, which may have loops, a body may be the child of several joints."""
    match site.tree:
        case tree.KinematicTree(entries=entries):
            yield from _ends(site, entries, one_parent=True)
        case tree.SceneInstance(entries=entries):
            for entry in entries:
                if isinstance(entry, tree.Graph):
                    yield from _ends(site, entry.entries, one_parent=False)
        case _:
            return


def _ends(site: Site, entries: tuple[tree.TreeEntry, ...], *, one_parent: bool) -> Iterator[Diagnostic]:
    children: dict[_Body, tree.Ref] = {}
    for joint in (joint for entry in entries if isinstance(entry, tree.Joints) for joint in entry.entries):
        match joint:
            case tree.FixedJoint(parent_frame=parent, child_frame=child):
                pass
            case tree.RevoluteJoint():
                parent, child = joint.parent_frame.frame, joint.child_frame.frame
            case _:
                continue
        body = _body(site, child)
        if body is None:
            continue
        name = body[2].rpartition(".")[2]
        if body == _body(site, parent):
            text = f"the joint '{joint.name.text}' connects the body '{name}' to itself: name a frame of another body"
            yield finding(site, child, Severity.WARNING, CODE, text)
        elif one_parent and body in children:
            text = f"the body '{name}' is the child of two joints: a body of a tree has one parent"
            related = (related_to(site, children[body], "the other joint"),)
            yield finding(site, child, Severity.WARNING, CODE, text, related)
        children.setdefault(body, child)


def _body(site: Site, frame: tree.Ref) -> _Body | None:
    """Return the body of a frame, or ``None`` if the name is unknown."""
    found = site.target(frame)
    if found is None:
        return None
    return found.uri, found.symbol.path.rpartition(".")[0], frame.path.rpartition(".")[0]
