"""Move idle arms out of the way of the others, where they wait."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator


class IdleArms:
    """The arms of some agents that are idle before or after their behaviours.

    ``park`` returns the motion of an agent's arm to its waiting place, one control tick for each step.
    """

    def __init__(self, agents: Iterable[str], park: Callable[[str], Iterator[None]]) -> None:
        self._park = park
        self._idle: dict[str, None] = dict.fromkeys(agents)
        self._moving: dict[str, Iterator[None]] = {}
        self._last = -1

    @property
    def are_moving(self) -> bool:
        """Whether an arm is on its way."""
        return bool(self._moving)

    def begin(self, agents: Iterable[str]) -> None:
        """Note that a behaviour of some agents begins."""
        for agent in agents:
            self._idle.pop(agent, None)
            self._moving.pop(agent, None)

    def end(self, agents: Iterable[str]) -> None:
        """Note that a behaviour of some agents is over."""
        self._idle |= dict.fromkeys(agents)

    def park_all(self, needed: Collection[str] = ()) -> None:
        """Let the idle arms make room, except the arms of the agents ``needed`` next."""
        for agent in [agent for agent in self._idle if agent not in needed]:
            del self._idle[agent]
            self._moving[agent] = self._park(agent)

    def move(self, tick: int) -> bool:
        """Move the arms that make room for one control tick; return whether some arm has not arrived.

        Further calls in the same tick move nothing.
        """
        if tick != self._last:
            self._last = tick
            self._moving = {agent: steps for agent, steps in self._moving.items() if next(steps, self) is not self}
        return bool(self._moving)
