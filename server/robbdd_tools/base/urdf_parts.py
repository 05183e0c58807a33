"""The named parts of a URDF file. Source: https://wiki.ros.org/urdf/XML"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.model_part import ModelPart, numbers_in
from robbdd_tools.base.model_paths import mesh_places

if TYPE_CHECKING:
    from robbdd_tools.base.model_xml import Element

_SHAPES = {"collision": "geom", "visual": "visual"}
_UNITS = {"revolute": ("rad", "N m"), "continuous": ("rad", "N m"), "prismatic": ("m", "N")}
_NONE: Mapping[str, str] = {}
WORLD = "world"
"""A root link with this name is the world itself."""


def urdf_parts(elements: list[Element]) -> Iterator[ModelPart]:
    """Yield the links (as bodies), joints and shapes of a URDF file."""
    inner: dict[int, list[Element]] = {}
    for element in elements:
        inner.setdefault(element.parent, []).append(element)
    numbers = {id(element): number for number, element in enumerate(elements)}
    for element in inner.get(0, ()):
        name, parts = element.attributes.get("name", ""), inner.get(numbers[id(element)], [])
        if element.tag == "link" and name != WORLD:
            yield ModelPart("body", name, "link", "", tuple(_link(parts, inner, numbers)), element.path, element.start)
            for shape in parts:
                if shape.tag in _SHAPES:
                    own = shape.attributes.get("name", "")
                    yield ModelPart(_SHAPES[shape.tag], own, shape.tag, name, (), shape.path, shape.start)
        elif element.tag == "joint":
            facts = tuple(_joint(element, parts))
            yield ModelPart("joint", name, "joint", _link_of(parts, "child"), facts, element.path, element.start)


def missing_meshes(path: Path, elements: list[Element]) -> Iterator[str]:
    """Yield a sentence on each mesh of a collision shape that does not exist."""
    for element in elements:
        if element.tag != "mesh" or "filename" not in element.attributes:
            continue
        shape = elements[elements[element.parent].parent]
        name = element.attributes["filename"]
        if shape.tag == "collision" and not any(place.is_file() for place in mesh_places(path, name)):
            link = elements[shape.parent].attributes.get("name", "")
            yield f"the collision mesh '{name}' of the link '{link}' is not on this machine"


def _link(parts: list[Element], inner: dict[int, list[Element]], numbers: dict[int, int]) -> Iterator[str]:
    for part in parts if numbers else ():
        if part.tag == "inertial":
            for one in inner.get(numbers[id(part)], ()):
                mass = numbers_in(one.attributes.get("value"))
                if one.tag == "mass" and mass:
                    yield f"mass {mass[0]:g} kg"
                    return
    yield "no mass"


def _joint(element: Element, parts: list[Element]) -> Iterator[str]:
    kind = element.attributes.get("type", "")
    if kind:
        yield kind
    yield f"from the link '{_link_of(parts, 'parent')}' to the link '{_link_of(parts, 'child')}'"
    limit: Mapping[str, str] = next((part.attributes for part in parts if part.tag == "limit"), _NONE)
    if kind not in _UNITS:
        return
    length, force = _UNITS[kind]
    low, high = numbers_in(limit.get("lower", "0")), numbers_in(limit.get("upper", "0"))
    if kind == "continuous":
        yield "no limits"
    elif low and high:
        yield f"range {low[0]:g} to {high[0]:g} {length}"
    for word, unit in (("velocity", f"{length}/s"), ("effort", force)):
        number = numbers_in(limit.get(word))
        if number:
            yield f"{word} up to {number[0]:g} {unit}"


def _link_of(parts: list[Element], end: str) -> str:
    return next((part.attributes.get("link", "") for part in parts if part.tag == end), "")
