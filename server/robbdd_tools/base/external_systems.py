"""Command lines and addresses of external systems under test."""

from __future__ import annotations

import shlex
from urllib.parse import urlsplit

ENDPOINT_HOSTS = "ROBBDD_ENDPOINT_HOSTS"
"""Name of an environment variable. It lists the hosts whose endpoints the command line allows, with commas between."""


def command_words(command: str) -> list[str]:
    """Return the program and the arguments of a command line, in POSIX quoting; empty if a quote is unclosed."""
    try:
        return shlex.split(command)
    except ValueError:
        return []


def endpoint_host(address: str) -> str:
    """Return the host of an address ``ws://HOST:PORT/PATH`` or ``wss://…``; empty for any other text."""
    try:
        found = urlsplit(address)
        # An invalid port raises an error only when it is read.
        _ = found.port
    except ValueError:
        return ""
    is_valid = found.scheme in ("ws", "wss") and not found.username and not any(map(str.isspace, address))
    return (found.hostname or "") if is_valid else ""
