"""A scene whose elements have their models."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from robbdd_tools.catalog.object_settings import can_move
from robbdd_tools.world.errors import SceneError, SimulationError

if TYPE_CHECKING:
    from robbdd_tools.base.articulation import Opening
    from robbdd_tools.catalog.api import ObjectModel, Region, RobotModel
    from robbdd_tools.catalog.executable import Origin
    from robbdd_tools.catalog.settings import Numbers
    from robbdd_tools.world.pose import Pose
    from robbdd_tools.world.staging import Staging


@dataclass(frozen=True, slots=True)
class Cast:
    """A scene with a model for every object and agent, except for the points of a log.

    - ``regions``: maps a workspace to its boxes, each with the object in whose frame the box is given. A workspace
      without a carrier is absent; one with a carrier that is a point has no box unless the executable scene states it.
    - ``ranges``: the areas in which some elements are laid out (``position_range``).
    - ``seed``: the seed that the scene sets, if any.
    - ``drops``: the heights (m) from which some elements are dropped (``drop_height``).
    - ``chosen``: maps an agent and a name to a configuration that its controller or gripper reads.
    - ``judged``: maps an element and a name to a configuration that only changes how the element is judged.
    """

    objects: Mapping[str, ObjectModel]
    agents: Mapping[str, RobotModel]
    regions: Mapping[str, tuple[tuple[str, Region], ...]]
    ranges: Mapping[str, Numbers]
    seed: int | None
    drops: Mapping[str, Numbers] = field(default_factory=dict[str, "Numbers"])
    chosen: Mapping[tuple[str, str], Numbers] = field(default_factory=dict[tuple[str, str], "Numbers"])
    judged: Mapping[tuple[str, str], Numbers] = field(default_factory=dict[tuple[str, str], "Numbers"])

    staging: Staging | None = None
    """The executable scene's data on the elements, if there is one."""
    left_out: tuple[str, ...] = ()
    """Elements that no clause uses and that have no model or, for agents, no place."""
    extents: Mapping[str, tuple[float, float]] = field(default_factory=dict[str, tuple[float, float]])
    """Width along x and height (m) of each object before it is scaled."""
    openings: Mapping[str, Opening | str] = field(default_factory=dict[str, "Opening | str"])
    """How each thing with a joint opens, or the reason why this is not known."""
    points: Mapping[str, str] = field(default_factory=dict[str, str])
    """Elements of a log that have no model, each of them ``object`` or ``agent``: points at their frames."""
    by_name: tuple[str, ...] = ()
    """Objects whose model is chosen from the catalog by their name."""

    @property
    def every_object(self) -> tuple[str, ...]:
        """The objects with a model, and those that are points."""
        return (*self.objects, *(name for name, kind in self.points.items() if kind == "object"))

    @property
    def every_agent(self) -> tuple[str, ...]:
        """The agents with a model, and those that are points."""
        return (*self.agents, *(name for name, kind in self.points.items() if kind == "agent"))

    def pose(self, name: str, attempt: int = 0) -> Pose | None:
        """Return the pose of an object's centre in an executable scene; raises ``SceneError``."""
        pose = None if self.staging is None else self.staging.pose(name, attempt)
        x, y, z = self.objects[name].frame
        return None if pose is None else pose.at((-x, -y, -z))

    def base(self, name: str) -> Pose | None:
        """Return the pose of an agent's base in an executable scene; raises ``SceneError``."""
        return None if self.staging is None else self.staging.base(name)

    def origin(self, name: str) -> Origin | None:
        """Return the source position at which an executable scene defines an element, or ``None``."""
        return None if self.staging is None else self.staging.origin(name)

    def cause(self, error: SimulationError) -> Origin | None:
        """Return the source position of the element that makes the simulation fail, or ``None``."""
        return self.origin(error.element) if error.element else None

    def without_robot(self, name: str) -> SceneError:
        """Return the error that an agent executes no behaviour because it is no robot of the scene."""
        if name in self.objects:
            return SceneError(f"'{name}' is a bystander: it executes no behaviour")
        return SceneError(f"the scene has no agent '{name}'")

    @property
    def tables(self) -> tuple[str, ...]:
        """The fixed objects, which carry everything else, the one with the largest top first."""
        fixed = [name for name, model in self.objects.items() if not can_move(model) and not model.bystander]
        return tuple(sorted(fixed, key=lambda name: -_top_area(self.objects[name])))


def _top_area(model: ObjectModel) -> float:
    return 0.0 if model.region is None else 4 * model.region.half[0] * model.region.half[1]
