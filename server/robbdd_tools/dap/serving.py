"""Serve one editor over standard input and output, or over a TCP port of this machine."""

from __future__ import annotations

import os
import socket
import sys
from collections.abc import Callable

from robbdd_tools.dap.adapter import DebugAdapter
from robbdd_tools.dap.wire import Wire
from robbdd_tools.protocol.run_folder import DEBUG_HOST


def serve_stdio() -> None:
    """Serve the process that has started this one, until it disconnects. All other output goes to standard error."""
    received, sent = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    sys.stdout = sys.stderr
    DebugAdapter(Wire(received, sent)).serve()


def serve_port(port: int, ready: Callable[[], None]) -> None:
    """Serve the first client of a port. Raises ``OSError`` if the port is in use.

    ``ready`` is called when a client can connect. A client can execute the code of models, so other machines must not
    reach it.
    """
    with socket.create_server((DEBUG_HOST, port)) as listener:
        ready()
        client, _ = listener.accept()
    with client, client.makefile("rb") as received, client.makefile("wb") as sent:
        DebugAdapter(Wire(received, sent)).serve()
