"""Where run messages go: to the parent process, or nowhere when behave is run by hand."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from robbdd_tools.run.protocol import encode

if TYPE_CHECKING:
    from robbdd_tools.run.protocol import RunMessage


class Channel:
    """Takes messages and drops them."""

    def send(self, message: RunMessage) -> None:
        """Pass a message on."""


class Lines(Channel):
    """Writes each message at once as a line of JSON to a file descriptor."""

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor

    def send(self, message: RunMessage) -> None:
        """Write a message; the process ends quietly when nobody reads any more."""
        data = (encode(message) + "\n").encode()
        try:
            while data:
                data = data[os.write(self._descriptor, data) :]
        except BrokenPipeError:
            os._exit(1)


_current = Channel()


def current_channel() -> Channel:
    """Return the channel of this process."""
    return _current


def use_channel(channel: Channel) -> None:
    """Set the channel of this process."""
    global _current
    _current = channel
