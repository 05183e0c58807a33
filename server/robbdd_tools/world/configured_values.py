"""Read the configuration of a scene back from its world."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.articulation import Opening
from robbdd_tools.catalog.object_settings import is_resizable, is_scalable
from robbdd_tools.catalog.settings import NORMAL, Numbers, written
from robbdd_tools.catalog.timetables import timetable_of
from robbdd_tools.world.belts import belt_speed, belts_of
from robbdd_tools.world.grip_force import grip_force
from robbdd_tools.world.owners import joint_of_part
from robbdd_tools.world.scene_configuration import CONTROLLER

if TYPE_CHECKING:
    from robbdd_tools.protocol.specs import SceneSpec
    from robbdd_tools.world.simulation import Simulation


def read_back(simulation: Simulation, scene: SceneSpec) -> Mapping[tuple[str, str], str]:
    """Map the element and the name of every configuration in the simulated world to its value."""
    cast, model = simulation.world.cast, simulation.model
    settings: dict[tuple[str, str], Numbers] = dict(cast.judged)
    for name, thing in cast.objects.items():
        body = model.body(name)
        geoms = range(int(body.geomadr[0]), int(body.geomadr[0] + body.geomnum[0]))
        settings[name, "friction"] = (float(model.geom_friction[geoms[0], 0]),)
        if thing.free:
            settings[name, "mass"] = (float(body.mass[0]),)
        if thing.graspable:
            settings[name, "position_range"] = cast.ranges.get(name, NORMAL)
            if name in cast.drops:
                settings[name, "drop_height"] = cast.drops[name]
        opening = cast.openings.get(name)
        if isinstance(opening, Opening):
            closed, opened = opening.ends
            joint = model.joint(joint_of_part(opening.part))
            at_start = float(simulation.data.qpos[joint.qposadr[0]])
            settings[name, "opening"] = ((at_start - closed) / (opened - closed),)
        for servo in belts_of(model, name)[:1]:
            settings[name, "belt_speed"] = (belt_speed(model, servo),)
        settings[name, "contact_time"] = (float(model.geom_solref[geoms[0], 0]),)
        width, height = (now / before for now, before in zip(_extent(model, geoms), cast.extents[name], strict=True))
        if is_scalable(thing):
            settings[name, "height_scale"], settings[name, "width_scale"] = (height,), (width,)
        if is_resizable(thing):
            settings[name, "size_scale"] = (height,)
        if name in simulation.world.laid_out:
            ahead, left = simulation.world.laid_out[name]
            settings[name, "position_ahead"], settings[name, "position_left"] = (ahead,), (left,)
    for name, robot in simulation.robots.items():
        for setting, attribute in CONTROLLER.items():
            settings[name, setting] = (getattr(robot.model, attribute),)
        settings[name, "travel_height"] = (robot.travel_height,)
        if robot.model.approach_speed is None:
            settings[name, "approach_speed"] = settings[name, "ee_speed"]
        settings[name, "position_range"] = cast.ranges.get(name, NORMAL)
        if name in cast.drops:
            settings[name, "drop_height"] = cast.drops[name]
        follow = (timetable_of(robot.model.name).follow_speed,)
        settings[name, "follow_speed"] = cast.chosen.get((name, "follow_speed"), follow)
        if (force := grip_force(model, name, robot.model)) is not None:
            settings[name, "grip_force"] = (force,)
        settings[name, "contact_time"] = (float(model.geom_solref[robot.pads[0], 0]),)
        settings[name, "attach_distance"] = (float(model.geom_gap[robot.pads[0]]),)
    # A seed may be configured for any element, such as the scene.
    for name in (*cast.objects, *cast.agents, *(config.target for config in scene.config)):
        settings[name, "seed"] = (float(simulation.world.seed),)
    return {pair: written(value) for pair, value in settings.items()}


def _extent(model: Any, geoms: range) -> tuple[float, float]:
    """Return the width along x and the height (m) of the bounding box of a body's geoms, aligned with the body."""
    middle = model.geom_pos[geoms] + model.geom_aabb[geoms, :3]
    half = model.geom_aabb[geoms, 3:]
    size = (middle + half).max(axis=0) - (middle - half).min(axis=0)
    return float(size[0]), float(size[2])
