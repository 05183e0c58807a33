"""Commands on a terminal of a given width."""

from __future__ import annotations

import os
import re
import struct
import subprocess
from collections.abc import Sequence

import pytest

CONTROL = re.compile(r"\r|\x1b\[[?\d;]*[A-Za-z]")
STEERING = {"COLUMNS", "LINES", "NO_COLOR", "FORCE_COLOR", "TTY_COMPATIBLE", "TTY_INTERACTIVE"}


def environment(**variables: str) -> dict[str, str]:
    return {name: value for name, value in os.environ.items() if name not in STEERING} | variables


def on_a_terminal(command: Sequence[str], columns: int, expected: int = 0, **variables: str) -> str:
    """All that a command writes to a terminal, with its escape sequences; it must end with the expected exit code."""
    pty, fcntl, termios = (
        pytest.importorskip(name, reason="only POSIX has pseudo-terminals") for name in ("pty", "fcntl", "termios")
    )
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 40, columns, 0, 0))
    variables = {"TERM": "xterm-256color", **variables}
    with subprocess.Popen(command, stdin=theirs, stdout=theirs, stderr=theirs, env=environment(**variables)) as run:
        os.close(theirs)
        written = bytearray()
        try:
            while part := os.read(ours, 65536):
                written += part
        except OSError:  # a terminal signals this way that its writers are gone
            pass
        os.close(ours)
    assert run.returncode == expected, written
    return written.decode().replace("\r\n", "\n")


def screen_lines(written: str) -> list[str]:
    """The final lines of the screen: without erased text, the bar and control sequences."""
    kept = (CONTROL.sub("", line.rpartition("\x1b[2K")[2]) for line in written.split("\n"))
    return [line.rstrip() for line in kept if "━" not in line]
