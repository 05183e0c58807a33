"""Wait for a debugger, which steps through users' code. The only user of debugpy."""

from __future__ import annotations

import os
from importlib import import_module
from typing import TYPE_CHECKING, Any

from robbdd_tools.agent import stack_dumps
from robbdd_tools.protocol.messages import DebuggerAwaited
from robbdd_tools.protocol.run_folder import DEBUG_HOST, DEBUG_PORT

if TYPE_CHECKING:
    from robbdd_tools.agent.channel import Channel


def await_debugger(channel: Channel) -> bool:
    """Wait until a debugger is connected, if this process was started to be debugged. Return whether it was."""
    port = os.environ.pop(DEBUG_PORT, "")
    if not port:
        return False
    # The wait has no time limit.
    stack_dumps.rest()
    debugpy: Any = import_module("debugpy")
    debugpy.listen((DEBUG_HOST, int(port)))
    channel.send(DebuggerAwaited(int(port)))
    debugpy.wait_for_client()
    return True
