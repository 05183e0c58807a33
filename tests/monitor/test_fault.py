"""Errors in users' code as data."""

from __future__ import annotations

from dataclasses import replace

from robbdd_tools.monitor.fault import Fault, Frame

USER = Frame("/work/policy.py", 12, "judge", "return 1 / 0")
LIBRARY = Frame("/usr/lib/numbers.py", 7, own=False)
FAULT = Fault("ZeroDivisionError", "division\n  by zero", "policy:judge", (USER, LIBRARY))


def test_the_place_is_the_innermost_call_in_the_users_own_files() -> None:
    assert FAULT.place == USER
    assert replace(FAULT, frames=(USER, replace(USER, line=20), LIBRARY)).place == replace(USER, line=20)
    assert replace(FAULT, frames=(LIBRARY,)).place == LIBRARY
    assert replace(FAULT, frames=()).place is None


def test_a_traceback_has_the_form_of_python() -> None:
    assert list(FAULT.traceback()) == [
        '  File "/work/policy.py", line 12, in judge',
        "    return 1 / 0",
        '  File "/usr/lib/numbers.py", line 7',
        "ZeroDivisionError: division by zero",
    ]


def test_a_summary_without_message_is_the_exception() -> None:
    assert replace(FAULT, message="").summary == "ZeroDivisionError"


def test_the_same_error_has_the_same_identifier_whatever_its_message() -> None:
    assert FAULT.id == replace(FAULT, message="of 3 by zero").id
    assert len(FAULT.id) == 12
    others = (replace(FAULT, origin="x:policy"), replace(FAULT, code="x:y"), replace(FAULT, frames=(USER,)))
    assert len({FAULT.id, *(other.id for other in others)}) == 4
