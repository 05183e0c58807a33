"""Whatever happens while a file is written, it holds the old content or the new one."""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Callable
from pathlib import Path
from typing import Any, TextIO

import pytest

from kit import make_fifo
from robbdd_tools.base.writing import replace_file, replacing


def fail_with(code: int) -> Callable[..., Any]:
    def fail(*_: object, **__: object) -> None:
        raise OSError(code, os.strerror(code))

    return fail


def write_half(file: TextIO) -> None:
    file.write("Feature: half")
    file.flush()
    raise RuntimeError


def listing(folder: Path) -> list[str]:
    return sorted(entry.name for entry in folder.iterdir())


@pytest.mark.parametrize("content", ["new ü\n", b"new \xc3\xbc\n"])
def test_a_file_has_the_new_content(tmp_path: Path, content: str | bytes) -> None:
    path = tmp_path / "m.bdd"
    replace_file(path, content)
    replace_file(path, content)
    assert path.read_bytes() == "new ü\n".encode()
    assert listing(tmp_path) == ["m.bdd"]


@pytest.mark.parametrize("call", ["fsync", "fchmod"])
def test_a_full_disk_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, call: str) -> None:
    path = tmp_path / "m.bdd"
    path.write_text("old")
    monkeypatch.setattr(os, call, fail_with(errno.ENOSPC))
    with pytest.raises(OSError, match="No space left") as raised:
        replace_file(path, "new")
    assert raised.value.filename == str(path)
    assert path.read_text() == "old"
    assert listing(tmp_path) == ["m.bdd"]


def test_a_file_that_is_begun_and_fails_leaves_no_trace(tmp_path: Path) -> None:
    path = tmp_path / "m.feature"
    with pytest.raises(RuntimeError), replacing(path) as file:
        write_half(file)
    assert listing(tmp_path) == []


def test_a_file_is_not_there_before_it_is_whole(tmp_path: Path) -> None:
    path = tmp_path / "m.feature"
    with replacing(path) as file:
        file.write("whole\n")
        assert not path.exists()
    assert path.read_bytes() == b"whole\n"


def test_mode_and_new_files_are_as_the_user_has_them(tmp_path: Path) -> None:
    path = tmp_path / "m.bdd"
    before = os.umask(0o027)
    try:
        replace_file(path, "new")
        assert stat.S_IMODE(path.stat().st_mode) == 0o640
        path.chmod(0o755)
        replace_file(path, "newer")
    finally:
        os.umask(before)
    assert stat.S_IMODE(path.stat().st_mode) == 0o755


def test_the_target_of_a_link_is_replaced(tmp_path: Path) -> None:
    (tmp_path / "there").mkdir()
    target, link = tmp_path / "there" / "m.bdd", tmp_path / "m.bdd"
    target.write_text("old")
    link.symlink_to("there/m.bdd")
    replace_file(link, "new")
    assert link.is_symlink()
    assert target.read_text() == "new"


def test_all_hard_links_show_the_new_content(tmp_path: Path) -> None:
    path, other = tmp_path / "m.bdd", tmp_path / "other.bdd"
    path.write_text("something older and longer")
    os.link(path, other)
    replace_file(path, "new")
    assert (path.read_text(), other.read_text()) == ("new", "new")
    assert path.samefile(other)
    assert listing(tmp_path) == ["m.bdd", "other.bdd"]


def test_a_disk_that_fills_up_in_a_hard_link_loses_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path, other = tmp_path / "m.bdd", tmp_path / "other.bdd"
    path.write_text("old")
    os.link(path, other)
    calls = iter([os.fsync, fail_with(errno.ENOSPC), os.fsync])

    def sync(descriptor: int) -> None:
        next(calls)(descriptor)

    monkeypatch.setattr(os, "fsync", sync)
    replace_file(path, "new")
    assert path.read_text() == "new"
    assert listing(tmp_path) == ["m.bdd", "other.bdd"]


def denied(*_: object) -> bool:
    return False


def test_a_file_that_may_not_be_written_stays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "m.bdd"
    path.write_text("old")
    monkeypatch.setattr(os, "access", denied)  # tests may run as root
    with pytest.raises(PermissionError):
        replace_file(path, "new")
    assert path.read_text() == "old"


def test_what_is_no_file_is_written_to_or_refused(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    make_fifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    replace_file(pipe, "new")
    assert os.read(reader, 10) == b"new"
    os.close(reader)
    with pytest.raises(IsADirectoryError):
        replace_file(tmp_path, "new")
    with pytest.raises(FileNotFoundError) as raised:
        replace_file(tmp_path / "none" / "m.bdd", "new")
    assert raised.value.filename == str(tmp_path / "none")
    (tmp_path / "loop").symlink_to("loop")
    with pytest.raises(OSError, match="symbolic links"):
        replace_file(tmp_path / "loop", "new")


def test_a_stream_that_is_sent_to_a_file_stays_that_stream(tmp_path: Path) -> None:
    with (tmp_path / "out").open("wb") as out:
        replace_file(Path(f"/proc/self/fd/{out.fileno()}"), "first\n")
        assert os.fstat(out.fileno()).st_nlink == 1
    assert (tmp_path / "out").read_text() == "first\n"


def test_an_error_names_the_file_that_was_asked_for_and_no_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Path, "replace", fail_with(errno.ENOSPC))
    path = tmp_path / "m.bdd"
    with pytest.raises(OSError, match="No space left") as raised:
        replace_file(path, "new")
    assert str(raised.value) == f"[Errno {errno.ENOSPC}] {os.strerror(errno.ENOSPC)}: '{path}'"
