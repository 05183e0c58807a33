"""The command that runs code in a fork of a server."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

from execnet.gateway_io import popen_bootstrapline

REAL = frozenset({"robbdd_tools.agent.render_run"})
"""Modules that load the simulator with another graphics back end than the server."""


def launch_command(address: str, code: str) -> list[str]:
    # The launcher uses only the standard library: it starts in a fiftieth of a second.
    return [sys.executable, "-I", "-S", str(Path(__file__).with_name("launch.py")), address, code]


STARTED_BY = "robbdd_tools.base.interpreter._command"
"""The function that returns the command of each interpreter that the product starts."""


def interpreter_command(address: str) -> Callable[..., list[str]]:
    """Return what takes the place of ``STARTED_BY``: it starts forks for ``-c CODE`` and ``-m MODULE``."""

    def command(option: str, name: str, *arguments: str) -> list[str]:
        if name in REAL:
            return [sys.executable, "-P", option, name, *arguments]
        run = f"from runpy import run_module; run_module({name!r}, run_name='__main__', alter_sys=True)"
        return [*launch_command(address, name if option == "-c" else run), *arguments]

    return command


WORKER_STARTED_BY = "execnet.gateway_io.popen_args"
"""The function that returns the command of each worker that pytest-xdist starts."""


def worker_command(address: str) -> Callable[[object], list[str]]:
    """Return what takes the place of ``WORKER_STARTED_BY``: workers on this machine are forks."""

    def command(_: object) -> list[str]:
        return launch_command(address, popen_bootstrapline)

    return command
