"""Commands and language servers that start as forks of a process that has loaded everything; see ``fork_server``.

Importing takes most of the processor time of a test that starts one. A test of starting itself, of signals, terminals,
limits or variables of the interpreter (``PYTHON…``) starts a real interpreter instead.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from uuid import uuid4

from fork_server.launching import launch_command

CAN_FORK = sys.platform == "linux"
_FOLDER = Path(tempfile.gettempdir(), f"robbdd-forks-{uuid4().hex[:12]}")
_ADDRESS = str(_FOLDER / "socket")


def forked(code: str) -> list[str]:
    """Return the command that runs code in a fork."""
    return launch_command(_ADDRESS, code)


def run_file(path: Path) -> list[str]:
    """Return the command that runs a Python file in a fork."""
    if not CAN_FORK:
        return [sys.executable, str(path)]
    return forked(f"import runpy; runpy.run_path({str(path)!r}, run_name='__main__')")


def _command(module: str) -> list[str]:
    if not CAN_FORK:
        return [sys.executable, "-m", module]
    return forked(f"from {module} import main; raise SystemExit(main())")


ROBBDD = _command("robbdd_tools.cli")
ROBBDD_LSP = _command("robbdd_tools.lsp.main")


@contextmanager
def fork_server() -> Generator[None]:
    """Start processes as forks; no effect on systems without fork."""
    if not CAN_FORK:
        yield
        return
    command = [sys.executable, "-m", "fork_server.serve", _ADDRESS]
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
