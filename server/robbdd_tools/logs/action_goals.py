"""Events of actions: a goal that begins to be executed, and one that succeeds."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum

OLD = 1_000_000_000
"""A goal began before the log if a topic's first message shows it as active and accepted more than this (ns) ago."""


class GoalState(Enum):
    """The state of a goal. A goal that has ended never changes again."""

    WAITING = 0
    ACTIVE = 1
    SUCCEEDED = 2
    FAILED = 3


ROS2_STATES = {1: GoalState.WAITING, 2: GoalState.ACTIVE, 3: GoalState.ACTIVE, 4: GoalState.SUCCEEDED} | dict.fromkeys(
    (5, 6), GoalState.FAILED
)
"""``action_msgs/GoalStatus``: accepted, executing, cancelling, succeeded, cancelled, aborted."""
ROS1_STATES = (
    {0: GoalState.WAITING, 7: GoalState.WAITING, 1: GoalState.ACTIVE, 6: GoalState.ACTIVE, 3: GoalState.SUCCEEDED}
) | dict.fromkeys((2, 4, 5, 8), GoalState.FAILED)
"""``actionlib_msgs/GoalStatus``: pending, recalling, active, preempting, succeeded, and the four ways to fail."""


def action_of(topic: str) -> str:
    """Return the action of a topic: ``pick`` for ``/arm/pick/_action/status`` and for ``/arm/pick/status``."""
    parts = [part for part in topic.split("/") if part and part != "_action"]
    return parts[-2] if len(parts) > 1 else parts[-1]


@dataclass
class ActionGoals:
    """Turns the states of the goals of actions into texts: ``pick-start`` and ``pick-end``.

    If a goal started or ended before the log begins, the time is unknown: there is a remark instead of a text. A goal
    that fails has no end.
    """

    texts: list[tuple[int, str, str]] = field(default_factory=list[tuple[int, str, str]])
    """The events: time of reception (ns), topic and text."""
    remarks: list[str] = field(default_factory=list[str])
    _states: dict[tuple[str, str], GoalState] = field(default_factory=dict[tuple[str, str], GoalState])
    _topics: set[str] = field(default_factory=set[str])

    def take(self, topic: str, received: int, goals: list[tuple[str, int, GoalState]]) -> None:
        """Apply a message. ``goals`` has the identity of each goal, the time (ns) of its acceptance, and its state."""
        first = topic not in self._topics
        self._topics.add(topic)
        for goal, accepted, state in goals:
            before = self._states.get((topic, goal))
            self._states[topic, goal] = state
            if first and state is not GoalState.WAITING and self._is_old(received, accepted, state):
                self.remarks.append(f"a goal on '{topic}' began before the log: its start is not known")
                continue
            self._report(topic, received, before, state)

    def _is_old(self, received: int, accepted: int, state: GoalState) -> bool:
        return state is not GoalState.ACTIVE or received - accepted > OLD

    def _report(self, topic: str, received: int, before: GoalState | None, state: GoalState) -> None:
        if state is before:
            return
        name = action_of(topic)
        if state is GoalState.ACTIVE:
            self.texts.append((received, topic, f"{name}-start"))
        if state is GoalState.SUCCEEDED:
            self.texts.append((received, topic, f"{name}-end"))
            if before is not GoalState.ACTIVE:
                self.remarks.append(f"no message on '{topic}' says when a goal began: its start is not known")
        if state is GoalState.FAILED:
            self.remarks.append(f"a goal on '{topic}' did not succeed: '{name}-end' is not reported")
