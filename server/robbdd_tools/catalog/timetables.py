"""Timetables of the executor ``timed-pick-place``, and how its tool follows the targets."""

from __future__ import annotations

from dataclasses import dataclass

STEPS_PER_SECOND = 60
"""Physics steps per second of the experiment, in which its phases are counted."""


@dataclass(frozen=True, slots=True)
class Timetable:
    """The ten phases of an arm's behaviour.

    - ``shares``: the share of each phase that one step of 1/60 s takes: above the object, lower, settle, close, lift,
      cross, lower, open, rise, back.
    - ``offset``: added to the positions of object and goal, m.
    - ``gain`` (m/s²), ``damping`` (1/s) and ``near`` (m): towards a target at the distance d, the tool accelerates by
      ``gain · d / (|d| + near) − damping · v``, as with the target attractor of RMPflow.
    - ``source``: where the numbers are published.
    """

    shares: tuple[float, ...]
    offset: tuple[float, float, float]
    gain: float
    damping: float
    near: float
    source: str

    @property
    def follow_speed(self) -> float:
        """Speed of the tool at which it follows a target that is far away, m/s."""
        return self.gain / self.damping


_ISAAC = "PickPlaceController and RMPflow configuration of the simulator's examples (Isaac Sim 4.2), public copies"
PANDA = Timetable(
    (0.008, 0.005, 1.0, 0.1, 0.05, 0.05, 0.0025, 1.0, 0.008, 0.08),
    (0.0, 0.005, 0.0),
    30.0,
    85.0,
    0.075,
    _ISAAC,
)
UR10 = Timetable(
    (0.01, 0.0035, 0.01, 1.0, 0.008, 0.005, 0.005, 1.0, 0.01, 0.08),
    (0.0, 0.0, 0.02),
    80.0,
    120.0,
    0.075,
    _ISAAC,
)
OTHERS = Timetable(
    (0.008, 0.005, 0.1, 0.1, 0.0025, 0.001, 0.0025, 1.0, 0.008, 0.08),
    (0.0, 0.0, 0.0),
    30.0,
    85.0,
    0.075,
    _ISAAC,
)


def timetable_of(robot: str) -> Timetable:
    """Return the timetable for a robot model of the catalog; all others have that of the general class."""
    return {"franka-panda": PANDA, "ur10": UR10}.get(robot, OTHERS)
