"""A file has one URI, on POSIX and on Windows, however a client writes it."""

from __future__ import annotations

from pathlib import PurePath, PurePosixPath, PureWindowsPath

import pytest

from robbdd_tools.base.uris import canonical_uri, drive_uri, path_of, uri_of

PAIRS = [
    (PurePosixPath("/home/you/lab.scene"), "file:///home/you/lab.scene"),
    (PurePosixPath("/a b/(1)/ä+,#%.bdd"), "file:///a%20b/%281%29/%C3%A4%2B%2C%23%25.bdd"),
    (PurePosixPath("/c:/lab.scene"), "file:///c%3A/lab.scene"),
    (PurePosixPath("/no-utf8-\udcff.bdd"), "file:///no-utf8-%FF.bdd"),
    (PureWindowsPath("c:/Users/You/lab.scene"), "file:///c%3A/Users/You/lab.scene"),
    (PureWindowsPath(r"c:\a b\lab.scene"), "file:///c%3A/a%20b/lab.scene"),
    (PureWindowsPath(r"\\server\share\lab.scene"), "file://server/share/lab.scene"),
]
SAME = [
    (PurePosixPath, "file:///a/(b)+/x.bdd", "file:///a/%28b%29%2B/x.bdd"),
    (PurePosixPath, "file:///a/%28b%29%2b/x.bdd", "file:///a/%28b%29%2B/x.bdd"),
    (PurePosixPath, "file:/a/x.bdd", "file:///a/x.bdd"),
    (PurePosixPath, "FILE://LocalHost/a/x.bdd", "file:///a/x.bdd"),
    (PurePosixPath, "file:///C:/x.bdd", "file:///C%3A/x.bdd"),
    (PureWindowsPath, "file:///C:/X/x.bdd", "file:///c%3A/X/x.bdd"),
    (PureWindowsPath, "file:///c%3a/X/x.bdd", "file:///c%3A/X/x.bdd"),
    (PureWindowsPath, "file://Server/Share/x.bdd", "file://server/Share/x.bdd"),
]
OTHERS = ["untitled:Untitled-1", "package:lab/x.scene", "http://e.org/(a)", "file:x.bdd", "file:///a?b", "file:///a#b"]


@pytest.mark.parametrize(("path", "uri"), PAIRS)
def test_a_path_and_its_uri_lead_to_each_other(path: PurePath, uri: str) -> None:
    assert uri_of(path) == uri
    assert path_of(uri, type(path)) == path
    assert canonical_uri(uri, type(path)) == uri


@pytest.mark.parametrize(("kind", "uri", "canonical"), SAME)
def test_what_clients_write_is_the_same_file(kind: type[PurePath], uri: str, canonical: str) -> None:
    assert canonical_uri(uri, kind) == canonical
    assert path_of(uri, kind) == path_of(canonical, kind)


def test_the_letter_of_a_drive_has_no_case() -> None:
    assert uri_of(PureWindowsPath("C:/x.bdd")) == uri_of(PureWindowsPath("c:/x.bdd"))
    assert uri_of(PurePosixPath("/C:/x.bdd")) != uri_of(PurePosixPath("/c:/x.bdd"))


@pytest.mark.parametrize("uri", OTHERS)
def test_what_is_no_file_stays_as_it_is(uri: str) -> None:
    assert canonical_uri(uri) == uri
    assert path_of(uri) is None


def test_only_windows_reads_files_of_another_machine() -> None:
    assert path_of("file://server/share/x.bdd", PurePosixPath) is None
    assert path_of("file://server/share/x.bdd", PureWindowsPath) == PureWindowsPath("//server/share/x.bdd")


@pytest.mark.parametrize("path", ["C:/cell/lab.scene", "c:/cell/lab.scene"])
def test_only_windows_has_drives(path: str) -> None:
    assert drive_uri(path, PureWindowsPath) == "file:///c%3A/cell/lab.scene"
    assert drive_uri(path, PurePosixPath) is None
    assert drive_uri("cell/lab.scene", PureWindowsPath) is None
