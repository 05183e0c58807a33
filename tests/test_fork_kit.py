"""A fork of the fork server is used like an interpreter that was just started."""

from __future__ import annotations

import os
import pty
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from fork_kit import CAN_FORK, forked

pytestmark = [
    pytest.mark.skipif(not CAN_FORK, reason="processes are forked on Linux only"),
    pytest.mark.usefixtures("forks"),
]
PIPE = subprocess.PIPE
# In turns: a signal that comes just before a call that waits is handled after it.
WAITS = "import os, time; print(os.getpid(), flush=True); [time.sleep(0.1) for _ in range(6000)]"


def is_running(pid: int) -> bool:
    return Path(f"/proc/{pid}").exists()


def test_it_has_the_streams_folder_arguments_and_environment_of_its_launcher(tmp_path: Path) -> None:
    code = "import os, sys; print(input(), os.getcwd(), sys.argv[1:], os.environ['WORD'])\n"
    code += "print('of errors', file=sys.stderr)\nraise SystemExit(7)"
    environment = {**os.environ, "WORD": "word"}
    done = subprocess.run(
        [*forked(code), "one", "two"],
        input="read\n",
        cwd=tmp_path,
        env=environment,
        stdout=PIPE,
        stderr=PIPE,
        text=True,
    )
    assert done.stdout == f"read {tmp_path} ['one', 'two'] word\n"
    assert (done.stderr, done.returncode) == ("of errors\n", 7)


def test_it_shares_nothing_with_other_forks() -> None:
    code = "import robbdd_tools; print(getattr(robbdd_tools, 'left', 'nothing')); robbdd_tools.left = 'something'"
    answers = [subprocess.run(forked(code), capture_output=True, text=True).stdout for _ in range(2)]
    assert answers == ["nothing\n", "nothing\n"]


def test_it_does_not_search_the_folder_of_the_tests() -> None:
    code = "import sys; print(sys.path)"
    assert str(Path(__file__).parent) not in subprocess.run(forked(code), capture_output=True, text=True).stdout


def test_an_error_is_shown_with_its_traceback() -> None:
    done = subprocess.run(forked("1 / 0"), capture_output=True, text=True)
    assert done.returncode == 1
    assert done.stderr.endswith("ZeroDivisionError: division by zero\n")


@pytest.mark.parametrize(
    "code",
    [
        "raise SystemExit('a reason')",
        "raise SystemExit(259)",
        "import sys; sys.stdout.write('no line end'); sys.stderr.write('nor here')",
        "import threading, time; threading.Thread(target=lambda: (time.sleep(0.05), print('waited for'))).start()",
        "import atexit; atexit.register(print, 'last'); print('first')",
    ],
)
def test_it_ends_as_an_interpreter_does(code: str) -> None:
    fork, interpreter = (
        subprocess.run(command, capture_output=True, text=True)
        for command in (forked(code), [sys.executable, "-c", code])
    )
    assert (fork.returncode, fork.stdout, fork.stderr) == (
        interpreter.returncode,
        interpreter.stdout,
        interpreter.stderr,
    )


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_signals_are_forwarded(number: signal.Signals) -> None:
    code = f"import signal; signal.signal({number:d}, lambda *_: exit(5)); {WAITS}"
    with subprocess.Popen(forked(code), stdin=PIPE, stdout=PIPE, text=True) as launcher:
        assert launcher.stdout is not None
        assert launcher.stdout.readline()
        launcher.send_signal(number)
        assert launcher.wait() == 5


def test_the_signal_that_ended_it_is_returned() -> None:
    done = subprocess.run(forked("import os; os.kill(os.getpid(), 9)"))
    assert done.returncode == -signal.SIGKILL


def test_a_terminal_that_hangs_up_at_its_end_leaves_its_exit_code() -> None:
    # The terminal hangs up when the fork closes it: before its launcher hears of its end, or after.
    codes = {os.waitstatus_to_exitcode(pty.spawn(forked("raise SystemExit(7)"))) for _ in range(20)}
    assert codes == {7}


def test_it_is_killed_with_its_launcher() -> None:
    with subprocess.Popen(forked(WAITS), stdin=PIPE, stdout=PIPE, text=True) as launcher:
        assert launcher.stdout is not None
        pid = int(launcher.stdout.readline())
        assert is_running(pid)
        launcher.kill()
        # The end of its output is the end of the fork: nobody else holds the pipe.
        assert launcher.stdout.read() == ""
    assert subprocess.run(forked("print('the server goes on')"), stdout=PIPE, text=True).stdout


def test_a_command_does_in_a_fork_what_it_does_in_an_interpreter() -> None:
    code = "from robbdd_tools.cli import main; raise SystemExit(main())"
    arguments = ["check", str(Path(__file__).parents[1] / "examples" / "pickplace")]
    one, other = (
        subprocess.run([*start, *arguments], capture_output=True, text=True)
        for start in (forked(code), [sys.executable, "-m", "robbdd_tools.cli"])
    )
    assert (one.stdout, one.stderr, one.returncode) == (other.stdout, other.stderr, other.returncode)
