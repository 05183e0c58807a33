"""Configure a scene according to its Given clauses."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from math import hypot
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.articulation import Opening
from robbdd_tools.catalog.api import GripperKind, ObjectModel, RobotModel, Vector
from robbdd_tools.catalog.object_settings import object_has
from robbdd_tools.catalog.settings import NORMAL, SETTINGS, Numbers, SettingError, setting_of, written
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.resizing import resized, stretched, widened

if TYPE_CHECKING:
    from robbdd_tools.protocol.specs import ConfigSpec


CONTROLLER = {
    "approach_speed": "approach_speed",
    "carry_clearance": "carry_clearance",
    "ee_speed": "tool_speed",
    "grip_time": "grip_time",
    "release_time": "release_time",
    "travel_height": "travel_height",
}
"""Names of configurations for picking and placing → attributes of the agent's model."""
ALONG = {"position_ahead": 0, "position_left": 2}
"""Names of configurations of a place → the first of the two limits of ``position_range`` that they replace."""


@dataclass(slots=True)
class Configured:
    """Configured models of objects and agents, position ranges (m) and the seed, if any.

    ``drops`` are the heights (m) from which objects are dropped. ``chosen`` are configurations, by element and name,
    that controllers and grippers read. ``judged`` are configurations that only change how the world is judged, the only
    ones that elements of a log without a model have: its ``points``.
    """

    objects: dict[str, ObjectModel]
    agents: dict[str, RobotModel]
    openings: Mapping[str, Opening | str] = field(default_factory=dict[str, "Opening | str"])
    points: Mapping[str, str] = field(default_factory=dict[str, str])
    ranges: dict[str, Numbers] = field(default_factory=dict[str, Numbers])
    drops: dict[str, Numbers] = field(default_factory=dict[str, Numbers])
    seed: int | None = None
    chosen: dict[tuple[str, str], Numbers] = field(default_factory=dict[tuple[str, str], "Numbers"])
    judged: dict[tuple[str, str], Numbers] = field(default_factory=dict[tuple[str, str], "Numbers"])


def configure(found: Configured, wanted: Iterable[tuple[ConfigSpec, tuple[str, ...]]]) -> None:
    """Apply each configuration to the elements that its target stands for.

    Raises ``SceneError`` for an unknown name or value, an element without such a configuration, and two values for one
    configuration.
    """
    known: dict[tuple[str, str], Numbers] = {}
    for config, elements in wanted:
        try:
            value = setting_of(config.name).read(config.value)
        except SettingError as error:
            raise SceneError(f"'{config.target}' cannot be configured: {error}") from error
        for element in ("",) if config.name == "seed" else elements:
            if known.setdefault((element, config.name), value) != value:
                other = written(known[element, config.name])
                raise SceneError(f"'{config.target}' should have {config.name} = {other} and {config.value}")
            _apply(found, element, config, value)
    for element, name in found.chosen:
        if name in ALONG:
            first = ALONG[name]
            area = found.ranges.get(element, NORMAL)
            found.ranges[element] = (*area[:first], *found.chosen[element, name] * 2, *area[first + 2 :])


def _apply(found: Configured, element: str, config: ConfigSpec, value: Numbers) -> None:
    if element in found.points:
        if found.points[element] == SETTINGS[config.name].judges:
            found.judged[element, config.name] = value
        return
    thing, robot = found.objects.get(element), found.agents.get(element)
    judged = {"agent": robot, "object": thing}.get(SETTINGS[config.name].judges)
    able = thing if thing is not None and object_has(thing, config.name) else None
    match config.name:
        case "seed":
            found.seed = int(value[0])
        case name if judged is not None:
            found.judged[element, name] = value
        case name if name in CONTROLLER and robot is not None:
            changed: dict[str, Any] = {CONTROLLER[name]: value[0]}
            found.agents[element] = replace(robot, **changed)
            found.chosen[element, name] = value
        case "position_range" | "drop_height" as name if robot is not None or able is not None:
            areas = found.ranges if name == "position_range" else found.drops
            areas |= {} if robot is None else dict.fromkeys(_loose(found, areas), value)
            areas[element] = value
        case "follow_speed" | "grip_force" as name if robot is not None:
            found.chosen[element, name] = value
        case "attach_distance" as name if robot is not None and (robot.gripper is GripperKind.SUCTION or not value[0]):
            found.chosen[element, name] = value
        case "contact_time" as name if robot is not None or able is not None:
            found.chosen[element, name] = value
        case "position_ahead" | "position_left" as name if able is not None:
            found.chosen[element, name] = value
        case "mass" if able is not None:
            found.objects[element] = replace(able, mass=value[0])
        case "friction" if able is not None:
            even = tuple(replace(shape, friction=None) for shape in able.shapes)
            found.objects[element] = replace(able, friction=value[0], shapes=even)
        case "belt_speed" if able is not None:
            found.objects[element] = _driven(able, value[0])
        case "height_scale" if able is not None:
            found.objects[element] = stretched(able, value[0])
        case "width_scale" if able is not None:
            found.objects[element] = widened(able, value[0])
        case "size_scale" if able is not None:
            found.objects[element] = resized(able, value[0])
        case "opening" if isinstance(opening := found.openings.get(element), Opening):
            _open(found, opening, value[0])
        case name if thing is None and robot is None:
            raise SceneError(f"'{config.target}', which should have {name} = {config.value}, is not in the scene")
        case name:
            raise SceneError(f"'{config.target}' has no {name}: it applies to {SETTINGS[name].target}")


def _open(found: Configured, opening: Opening, share: float) -> None:
    """Let a thing start at a share of its way from the closed to the open end."""
    model = found.objects[opening.part]
    assert model.joint is not None, "a thing that opens has a joint"
    closed, opened = opening.ends
    found.objects[opening.part] = replace(model, joint=replace(model.joint, start=closed + share * (opened - closed)))


def _loose(found: Configured, areas: Mapping[str, Numbers]) -> list[str]:
    """Return the objects that are laid out at random and have no value of their own."""
    return [name for name in found.objects if found.objects[name].graspable and name not in areas]


def _driven(model: ObjectModel, speed: float) -> ObjectModel:
    """Return an object with belts at another speed (m/s), in the same directions."""

    def at_speed(velocity: Vector) -> Vector:
        x, y, z = velocity
        factor = speed / hypot(x, y, z)
        return (factor * x, factor * y, factor * z)

    shapes = (
        shape if shape.surface is None else replace(shape, surface=at_speed(shape.surface)) for shape in model.shapes
    )
    return replace(model, shapes=tuple(shapes))
