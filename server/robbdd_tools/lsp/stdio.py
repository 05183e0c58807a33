"""Standard input and output as the connection of the client that has started this process."""

from __future__ import annotations

import io
import sys
from typing import BinaryIO

from robbdd_tools.base.interruptible_input import CAN_INTERRUPT, InterruptibleInput
from robbdd_tools.lsp.transport import bounded


class StdioConnection:
    """Standard input and output.

    The client may keep its end open after ``exit``, while a thread reads from it. On systems where a read cannot be
    interrupted, ``close`` has no effect, and ``end_soon`` ends the process.
    """

    def __init__(self) -> None:
        self._interruptible = InterruptibleInput(sys.stdin.fileno()) if CAN_INTERRUPT else None
        self.input: BinaryIO = bounded(
            sys.stdin.buffer if self._interruptible is None else io.BufferedReader(self._interruptible)
        )
        self.output: BinaryIO = sys.stdout.buffer

    def close(self) -> None:
        """End a read in another thread, and all later ones."""
        if self._interruptible is not None:
            self._interruptible.interrupt()
