"""The tests' own tools."""

from __future__ import annotations

import signal
import subprocess
import sys

import pytest

from kit import default_signals


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
def test_a_process_can_be_interrupted_even_where_ctrl_c_is_ignored() -> None:
    code = "import signal; print(signal.getsignal(signal.SIGINT) is signal.default_int_handler)"
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        ignored = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
        command = [sys.executable, "-c", code]
        reset = subprocess.run(command, capture_output=True, text=True, preexec_fn=default_signals)
    finally:
        signal.signal(signal.SIGINT, before)
    assert (ignored.stdout, reset.stdout) == ("False\n", "True\n")
