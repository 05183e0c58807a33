"""Put the messages of parallel executions into the order of the manifest."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator

from robbdd_tools.protocol.messages import RunMessage, ScenarioFinished


class OrderedMessages:
    """Yield the messages of the current scenario immediately, and buffer those of later scenarios until their turn.

    ``turns`` are the numbers of the scenarios in increasing order.
    """

    def __init__(self, turns: Iterable[int]) -> None:
        self._turns = deque(turns)
        self._kept: dict[int, list[RunMessage]] = {}

    def take(self, index: int, message: RunMessage) -> Iterator[RunMessage]:
        """Accept a message of scenario ``index``; yield all messages that are now due."""
        if not self._turns or index != self._turns[0]:
            self._kept.setdefault(index, []).append(message)
            return
        due = [message]
        while due:
            yield from due
            if not isinstance(due[-1], ScenarioFinished):
                return
            self._turns.popleft()
            due = self._kept.pop(self._turns[0], []) if self._turns else []

    def forget(self, index: int) -> None:
        """Drop the buffered messages of scenario ``index`` and later ones."""
        self._kept = {kept: messages for kept, messages in self._kept.items() if kept < index}

    def finished(self) -> Iterator[RunMessage]:
        """Yield the buffered messages of scenarios that have finished but whose turn never came."""
        for _, messages in sorted(self._kept.items()):
            if isinstance(messages[-1], ScenarioFinished):
                yield from messages
