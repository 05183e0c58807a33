"""Read URDF files as their authors ship them: meshes of packages, missing visual meshes, unexpanded xacro."""

from __future__ import annotations

from collections.abc import Iterator
from hashlib import sha256
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from robbdd_tools.base.files import open_regular
from robbdd_tools.base.model_paths import mesh_places
from robbdd_tools.base.source_texts import source_xml
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.mesh_formats import UnreadableMesh, as_stl, is_readable
from robbdd_tools.world.mesh_pieces import HIDDEN

CONVERTED = "robbdd-mesh"
"""Beginning of the names under which the engine gets converted meshes."""
ROUNDED = 1e-9
"""The largest moment may exceed the sum of the others by this share of itself, because files round."""
FASTEST = 50.0
"""No joint of an arm is faster than this (rad/s, m/s): the roll axes of the fastest SCARA arms reach 50 rad/s."""
LEAST = 1e-6
"""Smallest moment of inertia (kg m²) of a link whose file has no positive one."""


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
    _mend_inertias(root)
    converted: dict[str, bytes] = {}
    for link in root.iter("link"):
        for kind in ("visual", "collision"):
            for shape in link.findall(kind):
                _use_mesh(path, link, shape, converted)
    if converted:
        _serve_all(root, converted)
    if root.find("mujoco") is None:
        settings = ElementTree.SubElement(root, "mujoco")
        ElementTree.SubElement(settings, "compiler", {"discardvisual": "false", "strippath": "false"})
    spec = mujoco.MjSpec.from_string(ElementTree.tostring(root, encoding="unicode"), assets=converted)
    for body in spec.bodies:
        shown = [geom for geom in body.geoms if not (geom.contype or geom.conaffinity)]
        for geom in body.geoms if shown else ():
            if geom.contype or geom.conaffinity:
                geom.group = HIDDEN
    return spec


def speeds(path: Path) -> dict[str, float]:
    """Return the speed limit (rad/s, m/s) of each joint of a URDF file; nothing for another file.

    A limit that no arm has stands for none.
    """
    try:
        root = ElementTree.fromstring(source_xml(path))
    except ElementTree.ParseError:
        return {}
    # Transmissions have elements 'joint', too, with the names of joints but without limits.
    joints = root.findall("joint") if root.tag == "robot" else ()
    found = {joint.get("name", ""): joint.find("limit") for joint in joints}
    limits = {name: float(limit.get("velocity", 0.0)) for name, limit in found.items() if limit is not None}
    return {name: limit for name, limit in limits.items() if limit <= FASTEST}


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
        low, middle, high = _moments(inertia)
        if low + middle < high * (1 - ROUNDED) or (low <= 0.0 and _mass(link) > 0.0):
            yield link.get("name", "")


def massless_links(path: Path) -> Iterator[str]:
    """Yield the links of a URDF file without a mass. The engine refuses them if a joint moves them."""
    try:
        root = ElementTree.fromstring(source_xml(path))
    except ElementTree.ParseError:
        return
    for link in root.iter("link") if root.tag == "robot" else ():
        if _mass(link) == 0.0:
            yield link.get("name", "")


def _use_mesh(path: Path, link: ElementTree.Element, shape: ElementTree.Element, converted: dict[str, bytes]) -> None:
    """Replace a mesh's address by its path, or remove an unusable visual shape. Raises ``ValueError``.

    A collision mesh in a format that the engine does not read is added to ``converted``, under the name that replaces
    its address. Visual meshes are not converted: this would take seconds in each process.
    """
    mesh = shape.find("geometry/mesh")
    if mesh is None:
        return
    name = mesh.get("filename", "")
    found = next((one for one in mesh_places(path, name) if one.is_file()), None)
    if found is not None and is_readable(found):
        mesh.set("filename", str(found))
        return
    if shape.tag == "visual":
        link.remove(shape)
        return
    begin = f"the collision mesh '{name}' of the link '{link.get('name')}'"
    if found is None:
        raise ValueError(f"{begin} is not on this machine; looked for {', '.join(map(str, mesh_places(path, name)))}")
    address = f"{mesh_address(found)}.stl"
    try:
        converted[address] = as_stl(found)
    except UnreadableMesh as error:
        raise ValueError(f"{begin} {error}") from error
    mesh.set("filename", address)


def _serve_all(root: ElementTree.Element, converted: dict[str, bytes]) -> None:
    """Add the meshes that the engine reads to ``converted``: it takes all meshes of a model from there, or none."""
    for mesh in root.iter("mesh"):
        name = mesh.get("filename", "")
        if name not in converted:
            address = f"{mesh_address(Path(name))}{Path(name).suffix.lower()}"
            with open_regular(Path(name)) as file:
                converted[address] = file.read()
            mesh.set("filename", address)


def mesh_address(path: Path) -> str:
    """Return a name for a mesh file; the engine names a mesh after its file, so each file has one name."""
    return f"{CONVERTED}-{sha256(str(path).encode()).hexdigest()[:12]}"


def _mend_inertias(root: ElementTree.Element) -> None:
    """Replace inertias with a principal moment that is not positive by the mean of the moments, at least ``LEAST``."""
    for link in root.iter("link"):
        inertia = link.find("inertial/inertia")
        moments = [] if inertia is None else _moments(inertia)
        if inertia is not None and _mass(link) > 0.0 and moments[0] <= 0.0:
            even = str(max(sum(moments) / 3, LEAST))
            inertia.attrib |= {"ixx": even, "iyy": even, "izz": even, "ixy": "0", "ixz": "0", "iyz": "0"}


def _moments(inertia: ElementTree.Element) -> list[float]:
    """Return the principal moments (kg m²) of an inertia, the smallest first."""
    xx, xy, xz, yy, yz, zz = (float(inertia.get(name, 0)) for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))
    return np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]).tolist()


def _mass(link: ElementTree.Element) -> float:
    mass = link.find("inertial/mass")
    return 0.0 if mass is None else float(mass.get("value", 0))
