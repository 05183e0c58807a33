"""Names of files are accepted on Windows as well."""

from __future__ import annotations

from pathlib import PureWindowsPath

import pytest

from robbdd_tools.base.file_names import safe_stem


@pytest.mark.parametrize(
    ("name", "stem"),
    [
        ("part-to-bin", "part-to-bin"),
        ("größe.2", "größe.2"),
        ("https://e.org/a?b", "https___e.org_a_b"),
        ("a b:c", "a_b_c"),
        ("..", "_"),
        ("", "_"),
        ("dots...", "dots"),
        ("aux", "_aux"),
        ("NUL.left", "_NUL.left"),
        ("com1", "_com1"),
        ("common", "common"),
    ],
)
def test_a_name_becomes_one_that_every_file_system_accepts(name: str, stem: str) -> None:
    assert safe_stem(name) == stem
    assert safe_stem(stem) == stem
    assert PureWindowsPath(f"{stem}.feature").name == f"{stem}.feature"
