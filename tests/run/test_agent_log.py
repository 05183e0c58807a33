"""An agent's log keeps the beginning and the end of the output, and never blocks the writer."""

from __future__ import annotations

from pathlib import Path

import pytest

from robbdd_tools.run.agent_log import BoundedLog


def logged(path: Path, text: str, limit: int) -> str:
    log = BoundedLog(path, limit)
    with log.stream as stream:
        data = text.encode()
        while data:
            data = data[stream.write(data) :]
    log.wait(60)
    return path.read_text(encoding="utf-8")


@pytest.mark.parametrize("size", [0, 1, 99, 100])
def test_what_fits_is_kept_as_it_is(tmp_path: Path, size: int) -> None:
    text = "0123456789" * 10
    assert logged(tmp_path / "log", text[:size], 100) == text[:size]


@pytest.mark.parametrize("size", [101, 5000, 1_000_000])
def test_of_what_does_not_fit_the_middle_is_left_out(tmp_path: Path, size: int) -> None:
    text = "".join(f"{number:010}" for number in range(size // 10 + 1))[:size]
    cut = f"\n… {size - 100} bytes left out: the output exceeds the log's limit …\n"
    assert logged(tmp_path / "log", text, 100) == text[:50] + cut + text[-50:]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no full device")
def test_a_full_disk_does_not_hold_up_who_writes() -> None:
    log = BoundedLog(Path("/dev/full"), 1000)
    with log.stream as stream:
        for _ in range(100):
            stream.write(b"x" * 10_000)
    log.wait(60)


def test_the_last_line_that_says_something_is_found(tmp_path: Path) -> None:
    log = BoundedLog(tmp_path / "log")
    log.stream.write(b"one\ntwo \xff\n\n  \n")
    log.stream.close()
    log.wait(60)
    assert log.last_line() == "two �"
