"""SRDF files: groups, end effectors, named states and ignored collisions of a robot. They are near its URDF file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree

from robbdd_tools.base.files import UnreadableFile
from robbdd_tools.base.source_texts import source_xml

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

FOLDERS = (".", "srdf", "config", "../srdf", "../config")
"""Folders that are searched for the SRDF file of a URDF file, relative to the URDF file's folder."""


class UnreadableSrdf(ValueError):
    """An SRDF file cannot be read. The message has its name and the reason."""


@dataclass(frozen=True, slots=True)
class Group:
    """A planning group as written: names of joints, links and other groups, and chains (base link, tip link)."""

    joints: tuple[str, ...] = ()
    links: tuple[str, ...] = ()
    chains: tuple[tuple[str, str], ...] = ()
    groups: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class State:
    """A named state of a group: positions (rad, m) of joints."""

    name: str
    group: str
    positions: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class Srdf:
    """The contents of an SRDF file.

    - ``effectors``: group and parent group of each end effector; the parent group may be empty.
    - ``apart``: pairs of links whose collisions are ignored.
    """

    path: Path
    groups: Mapping[str, Group] = field(default_factory=dict[str, Group])
    effectors: tuple[tuple[str, str], ...] = ()
    states: tuple[State, ...] = ()
    apart: tuple[tuple[str, str], ...] = ()


def srdf_files(urdf: Path) -> tuple[Path, ...]:
    """Return the SRDF file named like a URDF file or, if there is none, all SRDF files that name the same robot."""
    same = urdf.with_suffix(".srdf")
    if urdf.suffix.lower() != ".urdf":
        return ()
    if same.is_file():
        return (same,)
    robot = _robot_of(urdf)
    found = (path for folder in FOLDERS for path in sorted((urdf.parent / folder).glob("*.srdf")))
    own = {path.resolve(): path for path in found if robot and _robot_of(path) == robot}
    return tuple(own.values())


def read_srdf(path: Path) -> Srdf:
    """Return the contents of an SRDF file. Raises ``UnreadableSrdf``."""
    try:
        root = ElementTree.fromstring(source_xml(path))
        return Srdf(
            path,
            {group.get("name", ""): _group(group) for group in root.findall("group")},
            tuple((one.get("group", ""), one.get("parent_group", "")) for one in root.findall("end_effector")),
            tuple(_states(root)),
            tuple((one.get("link1", ""), one.get("link2", "")) for one in root.findall("disable_collisions")),
        )
    except (ElementTree.ParseError, LookupError, ValueError, UnreadableFile) as error:
        raise UnreadableSrdf(f"{path.name} cannot be read: {error}") from error


def _robot_of(path: Path) -> str:
    """Return the name of the robot in a URDF or SRDF file, ``""`` if it has none."""
    try:
        root = ElementTree.fromstring(source_xml(path))
    except (ElementTree.ParseError, LookupError, ValueError, UnreadableFile):
        return ""
    return root.get("name", "") if root.tag == "robot" else ""


def _group(group: Element) -> Group:
    return Group(
        tuple(one.get("name", "") for one in group.findall("joint")),
        tuple(one.get("name", "") for one in group.findall("link")),
        tuple((one.get("base_link", ""), one.get("tip_link", "")) for one in group.findall("chain")),
        tuple(one.get("name", "") for one in group.findall("group")),
    )


def _states(root: Element) -> Iterator[State]:
    for state in root.findall("group_state"):
        name = state.get("name", "")
        positions: dict[str, float] = {}
        for joint in state.findall("joint"):
            try:
                positions[joint.get("name", "")] = float(joint.get("value", ""))
            except ValueError as error:
                place = f"the state '{name}' gives the joint '{joint.get('name', '')}' no number"
                raise ValueError(place) from error
        yield State(name, state.get("group", ""), positions)
