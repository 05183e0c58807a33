"""Commands and language servers that start as forks of a process that has loaded everything; see ``fork_server``.

Importing takes most of the processor time of a test that starts one. A test of starting itself, of signals, terminals,
limits or variables of the interpreter (``PYTHON…``) starts a real interpreter instead. What a fork starts, such as its
agents, are forks, too.

``python tests/fork_kit.py COMMAND…`` runs a command whose variable ``ROBBDD_LSP`` names a ``robbdd-lsp`` that is a
fork, next to ``robbdd`` and ``python``: for tests that are not written in Python.
"""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from pathlib import Path
from uuid import uuid4

from fork_server.launching import STARTED_BY, interpreter_command, launch_command

CAN_FORK = sys.platform == "linux"
_FOLDER = Path(tempfile.gettempdir(), f"robbdd-forks-{uuid4().hex[:12]}")
_ADDRESS = str(_FOLDER / "socket")
# The code of a fork runs here, so that no function of the server is among its callers.
_SERVE = """import sys
from fork_server.serve import code_of_fork, end_fork
code = code_of_fork(sys.argv[1])
if code is not None:
    try:
        exec(code, {"__name__": "__main__"})
    except SystemExit as end:
        end_fork(end.code)
    end_fork(None)
"""


def forked(code: str) -> list[str]:
    """Return the command that runs code in a fork."""
    return launch_command(_ADDRESS, code)


def run_file(path: Path) -> list[str]:
    """Return the command that runs a Python file in a fork."""
    if not CAN_FORK:
        return [sys.executable, str(path)]
    return forked(f"import runpy; runpy.run_path({str(path)!r}, run_name='__main__')")


def run_module(name: str) -> list[str]:
    """Return the command that runs a module of the tests in a fork."""
    tests = str(Path(__file__).parent)
    code = f"import runpy, sys; sys.path.insert(0, {tests!r}); runpy.run_module({name!r}, run_name='__main__')"
    return forked(code) if CAN_FORK else [sys.executable, "-c", code]


def _command(module: str) -> list[str]:
    if not CAN_FORK:
        return [sys.executable, "-m", module]
    return forked(f"from {module} import main; raise SystemExit(main())")


INTERPRETERS = (STARTED_BY, interpreter_command(_ADDRESS))
"""A function of the product, and what takes its place so that what it starts are forks."""
ROBBDD = _command("robbdd_tools.cli")
ROBBDD_LSP = _command("robbdd_tools.lsp.main")
# Plugins that the server has loaded cannot have their assertions rewritten, which pytest would warn of.
PYTEST = (
    forked("import sys, pytest; sys.exit(pytest.main([*sys.argv[1:], '-Wignore::pytest.PytestAssertRewriteWarning']))")
    if CAN_FORK
    else [sys.executable, "-m", "pytest"]
)


@contextmanager
def fork_server() -> Generator[None]:
    """Start processes as forks; no effect on systems without fork."""
    if not CAN_FORK:
        yield
        return
    command = [sys.executable, "-c", _SERVE, _ADDRESS]
    pipe = subprocess.PIPE
    _FOLDER.mkdir(mode=0o700)  # only we may connect
    try:
        # In a session of its own: Ctrl-C ends the tests, which end the server.
        with subprocess.Popen(
            command, cwd=Path(__file__).parent, stdin=pipe, stdout=pipe, encoding="utf-8", start_new_session=True
        ) as server:
            assert server.stdin is not None
            assert server.stdout is not None
            assert server.stdout.readline() == "ready\n"
            yield
            server.stdin.close()
        assert server.returncode == 0
    finally:
        shutil.rmtree(_FOLDER)


def run_with_forks(command: Sequence[str]) -> int:
    """Run a command that starts our commands as forks; return its exit code."""
    with fork_server(), tempfile.TemporaryDirectory() as folder:
        for name, start in (("robbdd", ROBBDD), ("robbdd-lsp", ROBBDD_LSP), ("python", [sys.executable])):
            program = Path(folder, name)
            program.write_text(f'#!/bin/sh\nexec {shlex.join(start)} "$@"\n', encoding="utf-8")
            program.chmod(0o755)
        environment = {**os.environ, "ROBBDD_LSP": str(Path(folder, "robbdd-lsp"))}
        return subprocess.run(command, env=environment, check=False).returncode


if __name__ == "__main__":
    sys.exit(run_with_forks(sys.argv[1:]))
