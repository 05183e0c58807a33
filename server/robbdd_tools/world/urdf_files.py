"""Read URDF files as their authors ship them: meshes of packages, missing visual meshes, unexpanded xacro."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from robbdd_tools.base.model_paths import mesh_places
from robbdd_tools.base.source_texts import source_xml
from robbdd_tools.world.engine import mujoco

READABLE = (".stl", ".obj", ".msh")
"""Mesh formats that the engine reads."""
ROUNDED = 1e-9
"""The largest moment may exceed the sum of the others by this share of itself, because files round."""
HIDDEN = 3
"""Group of geoms that pictures leave out."""


def is_urdf(path: Path) -> bool:
    """Return whether a file is a URDF file or a xacro file, by its root element."""
    try:
        return ElementTree.fromstring(source_xml(path)).tag == "robot"
    except ElementTree.ParseError:
        return False


def read_urdf(path: Path) -> Any:
    """Return the engine's editable description of a URDF file. Raises ``ValueError``.

    Visual shapes are kept, except meshes that are missing or that the engine cannot read. All collision meshes must
    exist.
    """
    root = ElementTree.fromstring(source_xml(path))
    if path.suffix == ".xacro" or any("xacro" in element.tag for element in root.iter()):
        name = path.name.removesuffix(".xacro")
        wanted = f"expand it ('xacro {path.name} > {Path(name).stem}.urdf') and name the result"
        raise ValueError(f"it is a xacro file: {wanted}")
    for link in root.iter("link"):
        for kind in ("visual", "collision"):
            for shape in link.findall(kind):
                _use_mesh(path, link, shape)
    if root.find("mujoco") is None:
        settings = ElementTree.SubElement(root, "mujoco")
        ElementTree.SubElement(settings, "compiler", {"discardvisual": "false", "strippath": "false"})
    spec = mujoco.MjSpec.from_string(ElementTree.tostring(root, encoding="unicode"))
    for body in spec.bodies:
        shown = [geom for geom in body.geoms if not (geom.contype or geom.conaffinity)]
        for geom in body.geoms if shown else ():
            if geom.contype or geom.conaffinity:
                geom.group = HIDDEN
    return spec


def speeds(path: Path) -> dict[str, float]:
    """Return the speed limit (rad/s, m/s) of each joint of a URDF file; nothing for another file."""
    try:
        root = ElementTree.fromstring(source_xml(path))
    except ElementTree.ParseError:
        return {}
    # Transmissions have elements 'joint', too, with the names of joints but without limits.
    joints = root.findall("joint") if root.tag == "robot" else ()
    found = {joint.get("name", ""): joint.find("limit") for joint in joints}
    return {name: float(limit.get("velocity", 0.0)) for name, limit in found.items() if limit is not None}


def impossible_inertias(path: Path) -> Iterator[str]:
    """Yield the links of a URDF file with an impossible inertia: one principal moment exceeds the sum of the others.

    The engine replaces the three principal moments of such a link by their mean.
    """
    try:
        root = ElementTree.fromstring(source_xml(path))
    except ElementTree.ParseError:
        return
    for link in root.iter("link") if root.tag == "robot" else ():
        inertia = link.find("inertial/inertia")
        if inertia is None:
            continue
        xx, xy, xz, yy, yz, zz = (float(inertia.get(name, 0)) for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))
        low, middle, high = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]).tolist()
        if low + middle < high * (1 - ROUNDED):
            yield link.get("name", "")


def massless_links(path: Path) -> Iterator[str]:
    """Yield the links of a URDF file without a mass. The engine refuses them if a joint moves them."""
    try:
        root = ElementTree.fromstring(source_xml(path))
    except ElementTree.ParseError:
        return
    for link in root.iter("link") if root.tag == "robot" else ():
        mass = link.find("inertial/mass")
        if mass is None or float(mass.get("value", 0)) == 0.0:
            yield link.get("name", "")


def _use_mesh(path: Path, link: ElementTree.Element, shape: ElementTree.Element) -> None:
    """Replace a mesh's address by its path, or remove an unusable visual shape. Raises ``ValueError``."""
    mesh = shape.find("geometry/mesh")
    if mesh is None:
        return
    name = mesh.get("filename", "")
    found = next((one for one in mesh_places(path, name) if one.is_file()), None)
    problem = ""
    if found is None:
        problem = f"is not on this machine; looked for {', '.join(map(str, mesh_places(path, name)))}"
    elif found.suffix.lower() not in READABLE:
        problem = "has a format that the simulator cannot read: convert it to STL or OBJ"
    if found is not None and not problem:
        mesh.set("filename", str(found))
    elif shape.tag == "visual":
        link.remove(shape)
    else:
        raise ValueError(f"the collision mesh '{name}' of the link '{link.get('name')}' {problem}")
