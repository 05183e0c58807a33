"""Prepare a run for a debugger: its policy, a free port, and a check that debugpy is installed."""

from __future__ import annotations

import socket
from dataclasses import replace
from importlib.util import find_spec

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.protocol.run_folder import DEBUG_HOST
from robbdd_tools.run.run_policy import Policy


class NoDebugger(RobbddError):
    """The run cannot be debugged."""


def check_debugger() -> None:
    """Raise ``NoDebugger`` if debugpy is not installed."""
    if find_spec("debugpy") is None:
        raise NoDebugger("debugging needs the package debugpy: pip install 'robbdd-tools[debug]'")


def debugged(policy: Policy, port: int) -> Policy:
    """Return the policy of a run that waits for a debugger on a port: one process, without a time limit."""
    return replace(policy, jobs=1, timeout=0.0, debug=port)


def pausing(policy: Policy) -> Policy:
    """Return the policy of a run whose pauses a debugger controls: one process, without a time limit."""
    return replace(policy, jobs=1, timeout=0.0, pausing=True)


def free_port() -> int:
    """Return a port of this machine that no process uses at the moment."""
    with socket.socket() as found:
        found.bind((DEBUG_HOST, 0))
        return found.getsockname()[1]
