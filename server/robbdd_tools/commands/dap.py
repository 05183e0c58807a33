"""``robbdd dap``: pause executions at clauses, for editors with the Debug Adapter Protocol."""

from __future__ import annotations

import os

from robbdd_tools.commands import OK
from robbdd_tools.commands.output import fail, print_note
from robbdd_tools.dap.serving import serve_port, serve_stdio


def serve_debugger(port: int | None) -> int:
    """Serve one editor over a port or, without one, over standard input and output; return the exit code."""
    if port is None:
        serve_stdio()
        return OK
    try:
        serve_port(port, lambda: print_note(f"waiting for an editor at 127.0.0.1:{port}"))
    except OSError as error:
        reason = os.strerror(error.errno) if error.errno else error
        return fail(f"no editor can connect to 127.0.0.1:{port}: {reason}")
    return OK
