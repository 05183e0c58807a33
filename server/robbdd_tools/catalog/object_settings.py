"""The configurations (``has config``) that an element can have, by its kind and, for objects, by its model."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import ShapeKind
from robbdd_tools.catalog.settings import setting_of

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import ObjectModel

OF_AGENTS = frozenset(
    {
        "approach_speed",
        "attach_distance",
        "carry_clearance",
        "contact_time",
        "drop_height",
        "ee_speed",
        "follow_speed",
        "grip_force",
        "grip_time",
        "position_range",
        "release_time",
        "seed",
        "travel_height",
    }
)


def agent_has(name: str) -> bool:
    """Return whether agents have a configuration of the catalog."""
    return name in OF_AGENTS or setting_of(name).judges == "agent"


def object_has(model: ObjectModel, name: str) -> bool:
    """Return whether an object of a model has a configuration of the catalog."""
    match name:
        case "seed" | "friction" | "contact_time":
            return True
        case "position_range" | "drop_height" | "position_ahead" | "position_left":
            return model.graspable
        case "size_scale":
            return is_resizable(model)
        case "mass":
            return model.free
        case "belt_speed":
            return has_belt(model)
        case "height_scale" | "width_scale":
            return is_scalable(model)
        case "opening":
            return model.joint is not None or model.moving is not None
        case _:
            return setting_of(name).judges == "object"


def is_scalable(model: ObjectModel) -> bool:
    """Return whether an object is a loose container. A sphere keeps its proportions."""
    round_ones = any(shape.kind is ShapeKind.SPHERE or shape.solid is not None for shape in model.shapes)
    return model.free and model.region is not None and not round_ones


def is_resizable(model: ObjectModel) -> bool:
    """Return whether an object to grasp consists of primitives only, as those of the catalog do."""
    return model.graspable and model.moving is None and all(shape.solid is None for shape in model.shapes)


def can_move(model: ObjectModel) -> bool:
    """Return whether an object can move, freely or by its joint."""
    return model.free or model.joint is not None


def has_belt(model: ObjectModel) -> bool:
    """Return whether an object has a moving surface."""
    return any(shape.surface is not None for shape in model.shapes)
