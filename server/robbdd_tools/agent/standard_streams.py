"""Give users' code usable standard streams, and prevent it from accessing the channel to the parent."""

from __future__ import annotations

import os


def reserve_channel() -> tuple[int, int]:
    """Return copies of standard input and output that child processes do not inherit.

    After this, all other code, including behave, the engine and users' code, reads an empty standard input and prints
    to the log.
    """
    orders, messages = os.dup(0), os.dup(1)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.close(nothing)
    os.dup2(2, 1)
    return orders, messages
