"""Timetables of the executor ``timed-pick-place``, and how its tool follows the targets.

The numbers are those of ``PickPlaceController`` and of the RMPflow configurations in the simulator's examples
(Isaac Sim 4.2), from public copies.
"""

from __future__ import annotations

from dataclasses import dataclass

STEPS_PER_SECOND = 60
"""Physics steps per second of the experiment, in which its phases are counted."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Timetable:
    """The ten phases of an arm's behaviour.

    - ``shares``: the share of each phase that one step of 1/60 s takes: above the object, lower, settle, close, lift,
      cross, lower, open, rise, back.
    - ``offset``: added to the positions of object and goal, m.
    - ``gain`` (m/s²), ``damping`` (1/s) and ``near`` (m): towards a target at the distance d, the tool accelerates by
      ``gain · d / (|d| + near) − damping · v``, as with the target attractor of RMPflow.
    """

    shares: tuple[float, ...]
    gain: float
    damping: float
    near: float = 0.075
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @property
    def follow_speed(self) -> float:
        """Speed (m/s) at which the tool follows a distant target."""
        return self.gain / self.damping


PANDA = Timetable(
    shares=(0.008, 0.005, 1.0, 0.1, 0.05, 0.05, 0.0025, 1.0, 0.008, 0.08),
    offset=(0.0, 0.005, 0.0),
    gain=30.0,
    damping=85.0,
)
UR10 = Timetable(
    shares=(0.01, 0.0035, 0.01, 1.0, 0.008, 0.005, 0.005, 1.0, 0.01, 0.08),
    offset=(0.0, 0.0, 0.02),
    gain=80.0,
    damping=120.0,
)
OTHERS = Timetable(
    shares=(0.008, 0.005, 0.1, 0.1, 0.0025, 0.001, 0.0025, 1.0, 0.008, 0.08),
    gain=30.0,
    damping=85.0,
)


def timetable_of(robot: str) -> Timetable:
    """Return the timetable for a robot model of the catalog; all other robots have that of the general class."""
    return {"franka-panda": PANDA, "ur10": UR10}.get(robot, OTHERS)
