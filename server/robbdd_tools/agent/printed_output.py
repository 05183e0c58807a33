"""Handle the output of users' code. All of it is written to the log, and its first part is also sent to the parent."""

from __future__ import annotations

import io
import sys
from typing import TYPE_CHECKING

from robbdd_tools.base.printable import encodable
from robbdd_tools.protocol.messages import Output

if TYPE_CHECKING:
    from typing import TextIO

    from robbdd_tools.agent.channel import Reports

MAX_CHARACTERS = 16_000
"""At most this many characters of a scenario's output are sent as messages."""
CUT = "… the rest of the output is in the log of the run"


class Printed(io.TextIOBase):
    """A replacement of standard output that sends complete lines as messages."""

    encoding = "utf-8"

    def __init__(self, channel: Reports, log: TextIO) -> None:
        super().__init__()
        self._channel = channel
        self._log = log
        self._scenario: int | None = None
        self._line = ""
        self._left = MAX_CHARACTERS

    def writable(self) -> bool:
        """Return true, because text can be written."""
        return True

    def write(self, text: str) -> int:
        """Write a text to the log, and send its complete lines."""
        written = len(text)
        text = encodable(text)
        self._log.write(text)
        if "\n" in text:
            # The process may be killed at any time.
            self._log.flush()
        self._begin()
        if self._left >= 0:
            whole, end, rest = (self._line + text).rpartition("\n")
            self._line = rest[: MAX_CHARACTERS + 1]
            if end:
                self._pass_on(whole)
        return written

    def flush(self) -> None:
        """Flush the buffer to the log."""
        self._log.flush()

    def finish(self) -> None:
        """Send a last line that has no line break."""
        if self._line and self._left >= 0:
            self._pass_on(self._line)
        self._line = ""
        self.flush()

    def _begin(self) -> None:
        """Reset the limit at the start of each scenario."""
        if self._channel.scenario != self._scenario:
            self._scenario, self._line, self._left = self._channel.scenario, "", MAX_CHARACTERS

    def _pass_on(self, text: str) -> None:
        shown = text if len(text) <= self._left else f"{text[: self._left]}\n{CUT}"
        self._left = self._left - len(text) if len(text) <= self._left else -1
        self._channel.send(Output(self._scenario, shown))


def finish_output() -> None:
    """Send output that has no final line break. Call it before a scenario is reported as finished."""
    if isinstance(sys.stdout, Printed):
        sys.stdout.finish()
