"""Stack dumps of the interpreter become places in the user's code."""

from __future__ import annotations

import threading
from dataclasses import replace
from pathlib import Path

import pytest

from robbdd_tools.agent import stack_dumps
from robbdd_tools.protocol.run_folder import NOTE_SIZE, call_file, dump_file
from robbdd_tools.run.crashes import Crash, take_crash
from run.recorded import spec

OURS = str(Path(stack_dumps.__file__).with_name("__main__.py"))
MAIN = f'  File "{OURS}", line 30 in _main\n  File "<frozen runpy>", line 88 in _run_code\n'
IDLE = f'  File "{threading.__file__}", line 982 in run\n'


@pytest.fixture
def code(tmp_path: Path) -> Path:
    file = tmp_path / "träge.py"
    file.write_text("def spin():\n    while True:\n        pass\n", encoding="utf-8")
    return file


def escaped(file: Path) -> str:
    return str(file).encode("ascii", "backslashreplace").decode()


def crash(tmp_path: Path, dump: str, note: str = "") -> Crash:
    base = tmp_path / "agent-1"
    dump_file(base).write_text(dump, encoding="ascii")
    call_file(base).write_bytes(note.encode("utf-8", "surrogateescape").ljust(NOTE_SIZE, b"\0"))
    found = take_crash(base, tmp_path)
    assert not dump_file(base).exists()
    assert not call_file(base).exists()
    return found


def test_the_thread_that_crashed_counts(tmp_path: Path, code: Path) -> None:
    dump = (
        "Fatal Python error: Segmentation fault\n\n"
        f"Thread 0x01 (most recent call first):\n{IDLE}\n"
        f'Current thread 0x02 [own] (most recent call first):\n  File "{escaped(code)}", line 3 in spin\n{IDLE}\n'
        f"Thread 0x03 (most recent call first):\n{MAIN}\nExtension modules: numpy.core (total: 1)\n"
    )
    fault = crash(tmp_path, dump).fault("the process ended", None, {})
    assert fault is not None
    assert fault.place is not None
    assert (fault.place.file, fault.place.line, fault.place.text) == (str(code), 3, "pass")
    assert fault.code == "träge:spin"
    assert list(fault.traceback())[-1] == fault.summary == "the process ended"
    assert fault.digest


def test_where_none_crashed_the_main_thread_counts(tmp_path: Path, code: Path) -> None:
    dump = (
        "Timeout (0:00:03)!\n"
        f'Thread 0x01 (most recent call first):\n  File "{escaped(code)}", line 1 in <module>\n{IDLE}\n'
        f'Thread 0x02 (most recent call first):\n  File "{escaped(code)}", line 2 in spin\n{MAIN}'
    )
    fault = crash(tmp_path, dump).fault("still running", None, {})
    assert fault is not None
    assert [(frame.file, frame.line) for frame in fault.frames] == [(str(code), 2)]


def test_the_latest_dump_counts(tmp_path: Path, code: Path) -> None:
    early = (
        f'Timeout (0:00:03)!\nThread 0x02 (most recent call first):\n  File "{escaped(code)}", line 1 in spin\n{MAIN}'
    )
    late = f'Stack (most recent call first):\n  File "{escaped(code)}", line 2 in spin\n{MAIN}'
    fault = crash(tmp_path, early + late).fault("left", None, {})
    assert fault is not None
    assert fault.frames[0].line == 2


def test_copies_of_steps_lead_to_their_originals(tmp_path: Path, code: Path) -> None:
    copy = tmp_path / "features" / "model_steps.py"
    dump = f'Stack (most recent call first):\n  File "features/../features/model_steps.py", line 2 in spin\n{MAIN}'
    fault = crash(tmp_path, dump).fault("left", None, {str(copy): str(code)})
    assert fault is not None
    assert fault.frames[0].file == str(code)


def test_a_crash_in_our_own_code_is_no_fault_of_the_user(tmp_path: Path) -> None:
    dump = f'Current thread 0x02 (most recent call first):\n  File "{np_file()}", line 2 in solve\n{MAIN}'
    assert crash(tmp_path, dump).fault("ended", spec(0), {}) is None
    assert Crash().fault("ended", None, {}) is None


def np_file() -> str:
    import numpy as np

    return str(np.__file__)


def test_without_a_dump_the_called_code_and_its_definition_are_known(tmp_path: Path, code: Path) -> None:
    fault = crash(tmp_path, "", f"träge:spin\0{code}\0001\0").fault("killed", replace(spec(0)), {})
    assert fault is not None
    assert (fault.code, fault.origin) == ("träge:spin", "")
    assert fault.place is not None
    assert (fault.place.file, fault.place.line, fault.place.text) == (str(code), 1, "def spin():")


@pytest.mark.parametrize("note", ["\0\0", "name", "name\0file\0line\0", "\udcff" * 10])
def test_damaged_notes_and_dumps_raise_nothing(tmp_path: Path, note: str) -> None:
    crash(tmp_path, 'Thread 0x (most recent call first):\n  File "x", line 99999999999 in f\n  File', note).fault(
        "ended", None, {}
    )


def test_a_process_that_left_nothing_behind_was_in_no_known_code(tmp_path: Path) -> None:
    assert take_crash(tmp_path / "agent-1", tmp_path) == Crash()
