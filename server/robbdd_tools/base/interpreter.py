"""Start the Python interpreters of RobBDD, isolated from the opened folder and from the environment's modules.

``python -m`` and ``python -c`` search the working directory and ``PYTHONPATH`` before the standard library, so a
``calendar.py`` in the folder of a model would be executed. Therefore every interpreter is started by this module: with
``-P``, without ``PYTHONPATH``, and in an empty folder.
"""

from __future__ import annotations

import asyncio
import os
import subprocess
import sys
from asyncio.subprocess import PIPE, Process
from collections.abc import Mapping
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import IO

from robbdd_tools.base import processes
from robbdd_tools.base.isolation import INHERITED, SEARCHED
from robbdd_tools.base.processes import Ending, own_group

PACKAGE_ROOT = Path(__file__).resolve().parents[2]
Module = subprocess.Popen[str]
"""A module of RobBDD that runs in another process."""
STARTED_IN = "ROBBDD_STARTED_IN"
"""Name of an environment variable. Its value is the working directory of the process that started this one."""
_DROPPED = (SEARCHED, INHERITED, "PYTHONINSPECT", "PYTHONSTARTUP")
_FOLDERS = ("PYTHONHOME", "PYTHONUSERBASE", "PYTHONPYCACHEPREFIX")
"""Variables that name a folder with code. A relative path in them would be resolved inside the opened folder."""


def run(module: str, *arguments: str, more: Mapping[str, str] | None = None) -> subprocess.CompletedProcess[str]:
    """Run a module of RobBDD to its end and return its output. ``more`` are additional environment variables."""
    return subprocess.run(
        _command("-m", module, *arguments),
        cwd=working_folder(),
        env={**_environment(), **(more or {})},
        capture_output=True,
        encoding="utf-8",
        errors="replace",
        check=False,
    )


def run_for(
    seconds: float, module: str, *arguments: str, more: Mapping[str, str] | None = None, sent: str = ""
) -> Ending:
    """Run a module of RobBDD with ``sent`` as input. After ``seconds``, it is ended together with its children."""
    environment = {**_environment(), **(more or {})}
    return processes.run_for(seconds, _command("-m", module, *arguments), working_folder(), environment, sent)


def start(
    module: str, *arguments: str, folder: Path, log: IO[bytes] | None, more: Mapping[str, str] | None = None
) -> Module:
    """Start a module of RobBDD in ``folder``. It communicates over its standard streams and writes its log to ``log``.

    ``more`` are additional environment variables. The process is the leader of a process group (see ``own_group``).
    """
    return subprocess.Popen(
        _command("-m", module, *arguments),
        cwd=folder,
        env={**_environment(), **(more or {})},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL if log is None else log,
        text=True,
        encoding="utf-8",
        **own_group(),
    )


async def start_worker(code: str) -> Process:
    """Start an interpreter that executes ``code`` of RobBDD and communicates over its standard streams."""
    return await asyncio.create_subprocess_exec(
        *_command("-c", code), cwd=working_folder(), env=_environment(), stdin=PIPE, stdout=PIPE
    )


def inherited_paths() -> list[str]:
    """Return the absolute folders in the ``PYTHONPATH`` with which the first process of RobBDD was started.

    Empty and relative entries denote the working directory, so they are left out.
    """
    stated = os.environ.get(SEARCHED, os.environ.get(INHERITED, ""))
    return [entry for entry in stated.split(os.pathsep) if Path(entry).is_absolute()]


def started_in() -> Path:
    """Return the folder to which relative paths of the user are relative."""
    return Path(os.environ.get(STARTED_IN) or Path.cwd())


def working_folder() -> Path:
    """Return an empty folder of this process, deleted at its end."""
    folder = _new_folder()
    if not folder.is_dir():  # A cleaner of temporary files may have deleted it.
        _new_folder.cache_clear()
        folder = _new_folder()
    return folder


@cache
def _new_folder() -> Path:
    import atexit
    import shutil
    import tempfile

    folder = tempfile.mkdtemp(prefix="robbdd-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return Path(folder)


def _command(*arguments: str) -> list[str]:
    return [sys.executable, "-P", *arguments]


def _environment() -> dict[str, str]:
    """Return the environment of an interpreter.

    ``PYTHONPATH`` has another name in it, so that only the agent uses it.
    """
    kept = {name: value for name, value in os.environ.items() if name not in _DROPPED}
    for name in _FOLDERS:
        if name in kept and not Path(kept[name]).is_absolute():
            del kept[name]
    inherited = inherited_paths()
    if inherited:
        kept[INHERITED] = os.pathsep.join(inherited)
    if any(Path(entry).resolve() == PACKAGE_ROOT for entry in inherited):
        # After `pip install --target`, this folder holds this package and its libraries.
        kept[SEARCHED] = str(PACKAGE_ROOT)
    with suppress(OSError):  # The working directory may have been deleted.
        kept[STARTED_IN] = str(Path.cwd())
    return kept
