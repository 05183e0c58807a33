"""Let a separate process judge edited clauses on stored traces, and read its verdicts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from robbdd_tools.protocol.judge_orders import JudgeOrder, encode_order
from robbdd_tools.protocol.messages import ClauseJudged, ScenarioFinished
from robbdd_tools.run.launch import Agent, stop

if TYPE_CHECKING:
    from pathlib import Path

    from robbdd_tools.protocol.messages import RunMessage

JUDGE = "robbdd_tools.agent.rejudge_edits"


class JudgeEnded(Exception):
    """The process that judges traces has ended unexpectedly."""


class TraceJudge:
    """The process that judges traces. It starts at the first order."""

    def __init__(self, folder: Path) -> None:
        self._agent = Agent(folder, module=JUDGE)
        self._messages = self._agent.messages()

    def verdicts(self, order: JudgeOrder) -> Mapping[int, list[ClauseJudged]]:
        """Return the verdicts on an order's clauses, by the number of the execution. Raises ``JudgeEnded``."""
        self._agent.order(encode_order(order))
        found: dict[int, list[ClauseJudged]] = {trace.index: [] for trace in order.traces}
        waiting = set(found)
        while waiting:
            match self._next():
                case ClauseJudged(index) as message if index in waiting:
                    found[index].append(message)
                case ScenarioFinished(index):
                    waiting.discard(index)
                case _:
                    pass
        return found

    def end(self) -> None:
        """End the process."""
        stop([self._agent])

    def _next(self) -> RunMessage:
        try:
            return next(self._messages)
        except StopIteration:
            raise JudgeEnded(self._agent.ending()) from None
