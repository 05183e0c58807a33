"""Whatever a file holds, reading it gives a text or a sentence."""

import os
import socket
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from kit import make_fifo
from robbdd_tools.base import files
from robbdd_tools.base.document import Document, Position, Span
from robbdd_tools.base.files import (
    Unreadable,
    UnreadableFile,
    file_state,
    open_regular,
    path_to_uri,
    read_text,
    uri_to_path,
)
from robbdd_tools.base.limits import MODEL_SIZE


@pytest.mark.parametrize(
    ("data", "text"),
    [(b"", ""), (b"\xef\xbb\xbfns", "ns"), ("ü 🤖\r\n".encode(), "ü 🤖\r\n")],
)
def test_utf8_is_read_with_or_without_a_byte_order_mark(tmp_path: Path, data: bytes, text: str) -> None:
    path = tmp_path / "m.bdd"
    path.write_bytes(data)
    assert read_text(path) == text


@pytest.mark.parametrize(
    ("data", "code", "words"),
    [
        (b"a\0b", "file-binary", "binary"),
        (b"one\ntwo \xff", "file-encoding", "line 2"),
        (b"a" * (MODEL_SIZE.default + 1), "file-too-large", "split the model"),
        (None, "file-missing", "there is no file 'm.bdd'"),
    ],
)
def test_what_cannot_be_read_says_why(tmp_path: Path, data: bytes | None, code: str, words: str) -> None:
    path = tmp_path / "m.bdd"
    if data is not None:
        path.write_bytes(data)
    found = read_text(path)
    assert isinstance(found, Unreadable)
    assert found.code == code
    assert words in found.reason


def test_a_folder_is_no_file(tmp_path: Path) -> None:
    found = read_text(tmp_path)
    assert isinstance(found, Unreadable)
    assert found.code == "file-is-folder"


def returns(value: object) -> Callable[..., object]:
    def answer(*_: object) -> object:
        return value

    return answer


def refuse(*_: object) -> int:
    raise PermissionError(13, "Permission denied")


def a_socket(path: Path) -> None:
    # A path of a socket is short.
    place = os.open(path.parent, os.O_RDONLY)
    socket.socket(socket.AF_UNIX).bind(f"/proc/self/fd/{place}/{path.name}")
    os.close(place)


NO_FILES: dict[str, tuple[Callable[[Path], object], str, str]] = {
    "pipe": (make_fifo, "file-not-regular", "'m.bdd' is a named pipe; only regular files are read"),
    "zeros": (lambda path: path.symlink_to("/dev/zero"), "file-not-regular", "is a device (through a link)"),
    "socket": (a_socket, "file-not-regular", "'m.bdd' is a socket"),
    "folder": (Path.mkdir, "file-is-folder", "'m.bdd' is a folder"),
    "loop": (lambda path: path.symlink_to(path.name), "file-unreadable", "its symbolic links form a loop"),
    "dangling": (
        lambda path: path.symlink_to("gone"),
        "file-missing",
        "it is a symbolic link to gone, which does not exist",
    ),
}


@pytest.mark.parametrize(("make", "code", "words"), NO_FILES.values(), ids=NO_FILES)
def test_what_is_no_regular_file_is_not_opened(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, make: Callable[[Path], object], code: str, words: str
) -> None:
    path = tmp_path / "m.bdd"
    make(path)
    with monkeypatch.context() as patched:
        patched.setattr(os, "open", refuse)
        found = read_text(path)
    assert isinstance(found, Unreadable)
    assert found.code == code
    assert words in found.reason
    assert file_state(path_to_uri(path)) is None


def test_a_file_that_becomes_a_pipe_meanwhile_does_not_block(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "m.bdd"
    make_fifo(path)
    monkeypatch.setattr(files, "unreadable", returns(None))
    with pytest.raises(UnreadableFile, match="is a named pipe"):
        open_regular(path)


def test_permission_denied_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "m.bdd"
    path.touch()
    monkeypatch.setattr(os, "open", refuse)  # tests may run as root
    assert read_text(path) == Unreadable("file-unreadable", "'m.bdd' cannot be read: Permission denied")


def test_a_file_that_grows_while_it_is_read_ends_at_the_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(MODEL_SIZE.variable, "10")
    path = tmp_path / "m.bdd"
    path.write_bytes(b"12345678901234567890")
    small = SimpleNamespace(st_mode=path.stat().st_mode, st_size=3)
    monkeypatch.setattr(os, "fstat", returns(small))
    found = read_text(path)
    assert isinstance(found, Unreadable)
    assert found.code == "file-too-large"
    assert "grows while it is read" in found.reason


def test_a_nul_in_a_path_is_said() -> None:
    found = read_text(Path("/models/a\0b.bdd"))
    assert isinstance(found, Unreadable)
    assert "'/models/a\\x00b.bdd' is not a path" in found.reason
    assert file_state("file:///models/a%00b.bdd") is None


def test_a_path_comes_back_from_its_uri(tmp_path: Path) -> None:
    path = tmp_path / "a folder" / "ü#%.bdd"
    assert uri_to_path(path_to_uri(path)) == path
    assert uri_to_path("untitled:Untitled-1") is None


@given(st.text(alphabet="a\n\r🤖", max_size=30), st.integers(0, 30))
def test_offsets_and_positions_are_inverse(text: str, offset: int) -> None:
    document = Document("file:///x", 0, text)
    offset = min(offset, len(text))
    position = document.position(offset)
    line_end = document.line_starts[position.line] + len(document.line_text(position.line))
    assert document.offset(position) == min(offset, line_end)


def test_a_position_beyond_the_text_is_its_end() -> None:
    document = Document("file:///x", 0, "ab\r\nc")
    assert document.offset(Position(0, 9)) == 2
    assert document.offset(Position(7, 0)) == 5
    assert document.line_starts == (0, 4)


def test_a_span_includes_the_cursor_behind_it() -> None:
    assert Span(2, 4).contains(4)
    assert not Span(2, 4).contains(5)
