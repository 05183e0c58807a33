"""The named parts of an MJCF file, with the values of their default classes.

Source: the XML reference of MuJoCo, https://mujoco.readthedocs.io/en/stable/XMLreference.html
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.model_part import ModelPart, numbers_in

if TYPE_CHECKING:
    from robbdd_tools.base.model_xml import Element

MAIN = "main"
"""The class of an element that names no class."""
_MOVED = ("joint", "tendon", "site", "body", "jointinparent", "cranksite")
"""Attributes of an actuator that name the part on which it acts."""
_WORLD = {"joint": "joint", "freejoint": "joint", "site": "site", "geom": "geom", "body": "body"}
_SLIDING = {"slide": "m", "hinge": "deg"}


@dataclass(frozen=True, slots=True)
class _Context:
    """Context of an element: the section of the file, the body, and the class of its parts.

    ``in_frame`` is true if an MJCF ``frame`` moves the element within the body.
    """

    section: str = ""
    body: str = ""
    childclass: str = ""
    in_frame: bool = False


def mjcf_parts(elements: list[Element]) -> Iterator[ModelPart]:
    """Yield the bodies, joints, sites, geoms and actuators of an MJCF file."""
    defaults = _Defaults(elements)
    angle = (
        "rad" if any(one.tag == "compiler" and one.attributes.get("angle") == "radian" for one in elements) else "deg"
    )
    masses = _masses(elements)
    contexts: list[_Context] = []
    for number, element in enumerate(elements):
        outer = contexts[element.parent] if element.parent >= 0 else _Context()
        contexts.append(_inner(element, outer, is_section=element.parent == 0))
        kind = _kind(element, outer)
        if kind is None:
            continue
        values = defaults.values(element, outer.childclass)
        facts = tuple(_facts(kind, element, values, outer, angle, masses.get(number)))
        name = element.attributes.get("name", "")
        yield ModelPart(kind, name, element.tag, outer.body, facts, element.path, element.start)


def _inner(element: Element, outer: _Context, *, is_section: bool) -> _Context:
    """Return the context of the elements inside an element."""
    if is_section:
        return _Context(element.tag, childclass=element.attributes.get("childclass", ""))
    if element.tag not in ("body", "frame", "replicate"):
        return outer
    body = element.attributes.get("name", "") if element.tag == "body" else outer.body
    childclass = element.attributes.get("childclass", outer.childclass)
    return _Context(outer.section, body, childclass, in_frame=element.tag != "body")


def _kind(element: Element, outer: _Context) -> str | None:
    if outer.section == "worldbody":
        return _WORLD.get(element.tag)
    return "actuator" if outer.section == "actuator" else None


def _masses(elements: list[Element]) -> dict[int, float]:
    """Return the masses (kg) that the file states for bodies, by the number of the body's element."""
    every = ((one.parent, numbers_in(one.attributes.get("mass"))) for one in elements if one.tag == "inertial")
    return {body: mass[0] for body, mass in every if mass}


class _Defaults:
    """The default classes of a file. A nested class inherits the values of the outer one."""

    def __init__(self, elements: list[Element]) -> None:
        self._values: dict[str, dict[str, dict[str, str]]] = {}
        names: dict[int, str] = {}
        for number, element in enumerate(elements):
            if element.tag == "default":
                outer = names.get(element.parent)
                names[number] = element.attributes.get("class", MAIN if outer is None else outer)
                inherited = self._values.get(outer, {}) if outer is not None else {}
                own = self._values.setdefault(names[number], {})
                for tag, values in inherited.items():
                    own[tag] = {**values, **own.get(tag, {})}
            elif element.parent in names:
                own = self._values[names[element.parent]]
                own[element.tag] = {**own.get(element.tag, {}), **element.attributes}

    def values(self, element: Element, childclass: str) -> Mapping[str, str]:
        """Return the attributes of an element, including the attributes that its class provides."""
        name = element.attributes.get("class") or childclass or MAIN
        return {**self._values.get(name, {}).get(element.tag, {}), **element.attributes}


def _facts(
    kind: str, element: Element, values: Mapping[str, str], outer: _Context, angle: str, mass: float | None
) -> Iterator[str]:
    match kind:
        case "body":
            yield "mass of its geoms" if mass is None else f"mass {mass:g} kg"
            yield from _position(values, outer)
        case "joint":
            yield from _joint(element.tag, values, angle)
        case "site":
            yield from _position(values, outer)
        case "geom":
            yield values.get("type", "mesh" if "mesh" in values else "sphere")
            if {values.get("contype"), values.get("conaffinity")} == {"0"}:
                yield "touches nothing"
            yield from _position(values, outer)
        case _:
            yield from (f"acts on the {word} '{values[word]}'" for word in _MOVED if word in values)
            low_high = numbers_in(values.get("ctrlrange"))
            if len(low_high) == 2:
                yield f"control from {low_high[0]:g} to {low_high[1]:g}"


def _joint(tag: str, values: Mapping[str, str], angle: str) -> Iterator[str]:
    kind = "free" if tag == "freejoint" else values.get("type", "hinge")
    yield kind
    axis = numbers_in(values.get("axis", "0 0 1"))
    if kind in _SLIDING:
        yield f"axis {_vector(axis)}"
        unit = angle if kind == "hinge" else "m"
        bounds = numbers_in(values.get("range"))
        is_limited = len(bounds) == 2 and values.get("limited") != "false"
        yield f"range {bounds[0]:g} to {bounds[1]:g} {unit}" if is_limited else "no limits"


def _position(values: Mapping[str, str], outer: _Context) -> Iterator[str]:
    where = f"the body '{outer.body}'" if outer.body else "the world"
    where = f"a frame in {where}" if outer.in_frame else where
    ends = numbers_in(values.get("fromto"))
    if len(ends) == 6:
        yield f"from {_vector(ends[:3])} to {_vector(ends[3:])} m in {where}"
        return
    position = numbers_in(values.get("pos", "0 0 0"))
    if position:
        yield f"at {_vector(position)} m in {where}"


def _vector(numbers: tuple[float, ...]) -> str:
    return f"({', '.join(f'{number:g}' for number in numbers)})"
