"""Open documents, files on disk, and what is found at a place of a file."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit import FOLDER, MODEL, fixture
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.names.imports import import_path, import_uri, missing_package, not_a_path, reached, reached_from
from robbdd_tools.names.project import Project


def test_a_document_that_is_closed_is_the_file_on_disk_again(tmp_path: Path) -> None:
    path = tmp_path / "m.bdd"
    path.write_text("ns t = 'https://x/disk/'\n")
    uri, project = path_to_uri(path), Project()
    assert not project.has(uri)
    project.open(uri, 3, "ns t = 'https://x/open/'\n")
    assert project.has(uri)
    assert project.texts() == {uri: (3, "ns t = 'https://x/open/'\n")}
    assert project.snapshot().document(uri).text.endswith("open/'\n")
    project.close(uri)
    assert project.texts() == {}
    project.load(uri)
    assert project.has(uri)
    assert project.snapshot().document(uri).text.endswith("disk/'\n")


def test_a_file_on_disk_is_read_again_when_it_may_have_changed(tmp_path: Path) -> None:
    path = tmp_path / "m.bdd"
    path.write_text("ns one = 'https://x/'\n")
    uri, project = path_to_uri(path), Project()
    project.load(uri)
    before = project.revision
    path.write_text("ns two = 'https://x/'\n")
    assert list(project.snapshot().document(uri).text.split())[1] == "one"
    project.refresh(uri)
    assert project.revision == before + 1
    project.load(uri)
    assert list(project.snapshot().document(uri).text.split())[1] == "two"


def test_replacing_the_open_documents_closes_the_others_and_rereads_files(tmp_path: Path) -> None:
    path = tmp_path / "m.bdd"
    path.write_text("ns one = 'https://x/'\n")
    disk, project = path_to_uri(path), Project()
    project.open("file:///a.bdd", 1, "ns a = 'https://a/'\n")
    project.open("file:///b.bdd", 1, "ns b = 'https://b/'\n")
    project.load(disk)
    path.write_text("ns two = 'https://x/'\n")
    kept = project.load("file:///b.bdd")
    project.replace({"file:///b.bdd": (2, "ns b = 'https://b/'\n"), "file:///c.bdd": (5, "")})
    assert project.texts() == {"file:///b.bdd": (1, "ns b = 'https://b/'\n"), "file:///c.bdd": (5, "")}
    assert project.load("file:///b.bdd") is kept
    assert (project.has("file:///a.bdd"), project.has(disk)) == (False, False)
    project.load(disk)
    assert project.snapshot().document(disk).text.startswith("ns two")


def test_a_file_that_cannot_be_read_has_an_empty_document(tmp_path: Path) -> None:
    uri, project = path_to_uri(tmp_path / "none.bdd"), Project()
    project.load(uri)
    snapshot = project.snapshot()
    assert (snapshot.document(uri).uri, snapshot.document(uri).text, snapshot.file(uri)) == (uri, "", None)
    assert snapshot.unreadable(uri) is not None


def test_joined_graph_files_are_kept_with_their_first() -> None:
    project = Project()
    before = project.revision
    project.join("file:///a.ttl", ["file:///b.ttl", "file:///c.ttl"])
    assert project.revision == before + 1
    assert project.snapshot().joined == {"file:///a.ttl": ("file:///b.ttl", "file:///c.ttl")}


def test_the_part_at_an_offset_is_the_last_that_begins_before_it() -> None:
    case = fixture(MODEL)
    analysis = case.snapshot.file(case.uri)
    assert analysis is not None
    text = case.project.texts()[case.uri][1]
    for word, first in (
        ("Event (ns=t) end", "Event (ns=t) end"),
        ("var robot", "Scenario Template"),
        ("import", "import"),
    ):
        part = analysis.part_at(text.index(word))
        assert part is not None
        assert part.declaration.text.startswith(first)
        assert part.offset == text.index(part.declaration.text)
    inside = analysis.part_at(text.index("template: <fetch>"))
    assert inside is not None
    assert inside.declaration.text.lstrip().startswith("Scenario bench-to-tray")
    last = analysis.part_at(len(text) + 10)
    assert last is not None
    assert last.offset <= len(text)
    empty = fixture("").snapshot.file(f"{FOLDER}main.bdd")
    assert empty is not None
    assert empty.part_at(0) is None


@pytest.mark.parametrize(
    ("path", "uri"),
    [
        ("lab.scene", "file:///w/models/lab.scene"),
        ("../lab.scene", "file:///w/lab.scene"),
        ("a b.scene", "file:///w/models/a%20b.scene"),
        ("no_such_package:cells/lab.scene", "package:no_such_package/cells/lab.scene"),
        ("https://x/lab.scene", "address:https%3A//x/lab.scene"),
        ("//host/lab.scene", "address://host/lab.scene"),
    ],
)
def test_the_path_of_an_import_is_that_of_a_file_a_package_or_no_path(path: str, uri: str) -> None:
    found = import_uri("file:///w/models/m.bdd", path)
    assert found == uri
    assert (missing_package(found) is not None) == found.startswith("package:")
    assert (not_a_path(found) is not None) == found.startswith("address:")
    if found.startswith("file:"):
        assert import_path("file:///w/models/m.bdd", found) == path


def test_what_cannot_be_imported_names_what_was_written() -> None:
    package = missing_package(import_uri("file:///m.bdd", "no_such_package:cells/lab.scene"))
    assert package is not None
    assert "'no_such_package'" in package
    assert "'cells/lab.scene'" in package
    windows = not_a_path(import_uri("file:///m.bdd", "cells\\lab.scene"))
    assert windows is not None
    assert "'cells\\lab.scene'" in windows
    assert "'cells/lab.scene'" in windows
    assert import_path("untitled:m.bdd", "file:///lab.scene") is None
    assert import_path("file://host/m.bdd", "file:///lab.scene") is None


def test_what_is_reached_goes_through_every_edge() -> None:
    edges = {"a": ["b", "c"], "b": ["d"], "c": ["a", "e"], "d": [], "x": ["y"]}
    assert reached(edges, "a") == {"b", "c", "d", "e"}
    assert reached_from(edges, ["b", "x"]) == {"b", "d", "x", "y"}
    assert reached(edges, "y") == frozenset()


@pytest.mark.parametrize("path", ["\ud800.scene", "x/\udfff.scene", "pkg:\udcff.scene", "//h/\ud800"])
def test_half_a_character_in_an_import_is_a_diagnostic(path: str) -> None:
    uri, project = "file:///a/main.bdd", Project()
    project.open(uri, 1, f'import "{path}"\n')
    file = project.snapshot().file(uri)
    assert file is not None
    assert [found.code for found in file.diagnostics if found.code == "import"] == ["import"]
