"""What users' code prints: it goes to the log of the process, and the first part of it to the parent as messages."""

from __future__ import annotations

import io
import sys
from typing import TYPE_CHECKING

from robbdd_tools.base.printable import encodable
from robbdd_tools.protocol.messages import Output

if TYPE_CHECKING:
    from typing import TextIO

    from robbdd_tools.agent.channel import Reports

MOST = 16_000
"""Characters that are passed on of what one scenario prints."""
CUT = "… more was printed: it is in the log of the run"


class Printed(io.TextIOBase):
    """A text stream in place of the standard output; lines are passed on when they are complete."""

    encoding = "utf-8"

    def __init__(self, channel: Reports, log: TextIO) -> None:
        super().__init__()
        self._channel = channel
        self._log = log
        self._scenario: int | None = None
        self._line = ""
        self._left = MOST

    def writable(self) -> bool:
        """Tell that it can be written to."""
        return True

    def write(self, text: str) -> int:
        """Write a text to the log, and pass its complete lines on."""
        written = len(text)
        text = encodable(text)
        self._log.write(text)
        if "\n" in text:
            # The process may be ended at any time.
            self._log.flush()
        self._begin()
        if self._left >= 0:
            whole, end, rest = (self._line + text).rpartition("\n")
            self._line = rest[: MOST + 1]
            if end:
                self._pass_on(whole)
        return written

    def flush(self) -> None:
        """Write what is buffered to the log."""
        self._log.flush()

    def finish(self) -> None:
        """Pass on a last line without an end."""
        if self._line and self._left >= 0:
            self._pass_on(self._line)
        self._line = ""
        self.flush()

    def _begin(self) -> None:
        """Each scenario has its own share."""
        if self._channel.scenario != self._scenario:
            self._scenario, self._line, self._left = self._channel.scenario, "", MOST

    def _pass_on(self, text: str) -> None:
        shown = text if len(text) <= self._left else f"{text[: self._left]}\n{CUT}"
        self._left = self._left - len(text) if len(text) <= self._left else -1
        self._channel.send(Output(self._scenario, shown))


def finish_output() -> None:
    """Pass on what was printed without the end of a line; called before a scenario is reported as finished."""
    if isinstance(sys.stdout, Printed):
        sys.stdout.finish()
