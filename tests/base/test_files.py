"""Whatever a file holds, reading it gives a text or a sentence."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robbdd_tools.base.document import Document, Position, Span
from robbdd_tools.base.files import LARGEST_FILE, Unreadable, path_to_uri, read_text, uri_to_path


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
        (b"a" * (LARGEST_FILE + 1), "file-too-large", "split the model"),
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
