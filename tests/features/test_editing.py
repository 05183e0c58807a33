"""Names typed over together, moved files, layout of parts of a text."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from kit import MODEL, MODELS, SCENE, fixture
from robbdd_tools.base.diagnostic import Edit
from robbdd_tools.base.document import Document, Span
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.features.format_range import format_on_type, format_range
from robbdd_tools.features.layout import lay_out
from robbdd_tools.features.rename import linked_places
from robbdd_tools.features.rename_files import affected_files, import_edits
from robbdd_tools.features.workspace_files import model_files
from robbdd_tools.names.index import FileIndex, imports_of, index_file


def edited(text: str, edits: list[Edit]) -> str:
    for edit in sorted(edits, key=lambda edit: edit.span, reverse=True):
        text = text[: edit.span.start] + edit.text + text[edit.span.end :]
    return text


def linked(old: str, new: str) -> list[str]:
    case = fixture(MODEL.replace(old, new, 1))
    text = case.project.texts()[case.uri][1]
    return [text[span.start : span.end] for span in linked_places(case.snapshot, case.uri, case.cursor)]


def test_a_name_of_one_document_is_typed_over_everywhere() -> None:
    assert linked("var goal", "var go$0al") == ["goal"] * 5
    assert linked("<pick-start> until", "<pick-$0start> until") == ["pick-start"] * 3


def test_a_name_that_other_documents_use_is_not_linked() -> None:
    assert linked("<places.bench_ws>", "<places.ben$0ch_ws>") == []
    assert linked("So That", "So T$0hat") == []


def test_imports_follow_a_moved_file_and_a_moved_importer(tmp_path: Path) -> None:
    (tmp_path / "cells").mkdir()
    (tmp_path / ".git").mkdir()
    (tmp_path / ".git" / "x.scene").write_text(SCENE, encoding="utf-8")
    (tmp_path / "cells" / "lab.scene").write_text(SCENE, encoding="utf-8")
    text = MODEL.replace("lab.scene", "cells/lab.scene")
    (tmp_path / "main.bdd").write_text(text, encoding="utf-8")
    main, lab = path_to_uri(tmp_path / "main.bdd"), path_to_uri(tmp_path / "cells" / "lab.scene")
    folder = path_to_uri(tmp_path)
    assert model_files([folder]) == [lab, main]

    def after(moves: dict[str, str]) -> str:
        found = import_edits(affected_files(model_files([folder]), moves), moves)
        return edited(text, [edit for edit in found if edit.uri == main]).split("\n")[0]

    assert after({lab: f"{folder}/bench.scene"}) == 'import "bench.scene"'
    assert after({f"{folder}/cells": f"{folder}/rooms/cells"}) == 'import "rooms/cells/lab.scene"'
    assert after({main: f"{folder}/cells/main.bdd"}) == 'import "lab.scene"'
    assert after({main: f"{folder}/a/main.bdd", lab: f"{folder}/a/lab.scene"}) == 'import "lab.scene"'
    assert after({f"{folder}/other.scene": f"{folder}/more.scene"}) == 'import "cells/lab.scene"'


def test_an_unsaved_import_follows_a_moved_file() -> None:
    case = fixture(MODEL)
    files = [file for file in case.snapshot.sources.values() if isinstance(file, FileIndex)]
    (edit,) = import_edits(files, {"file:///fixture/lab.scene": "file:///fixture/deep/lab.scene"})
    assert (edit.uri, edit.text) == (case.uri, "deep/lab.scene")


def test_only_files_that_a_move_concerns_are_read_closely(tmp_path: Path) -> None:
    for name, text in {"lab.scene": SCENE, "main.bdd": MODEL, "other.bdd": MODEL.replace("lab.", "barn.")}.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    folder = path_to_uri(tmp_path)
    (found,) = affected_files(model_files([folder]), {f"{folder}/lab.scene": f"{folder}/x.scene"})
    assert found.document.uri == f"{folder}/main.bdd"


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.name)
def test_imports_are_found_without_reading_the_rest(path: Path) -> None:
    document = Document(path_to_uri(path), 0, path.read_text(encoding="utf-8"))
    assert imports_of(document) == index_file(document).imports


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.name)
def test_laying_out_all_lines_is_laying_out_the_text(path: Path) -> None:
    text = path.read_text(encoding="utf-8").replace("    ", " ").replace(" {", "   {")
    document = Document("file:///x.bdd", 0, text)
    assert edited(text, format_range(document, Span(0, len(text)))) == lay_out(text)


@pytest.mark.parametrize("ending", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize(
    "text",
    [
        "\n\n  Event  (ns=t)  a\n\n\n\nEvent (ns=t) b   // c\n  \n\n",
        "Event  (ns=t) a",
        "// a\x0bb\u2028c\n  // d\x0ce\nns  t = 'x'\n",
        "User Story (ns=t) s {\nAs A  'one\n  two'\n}\n\n\n",
        "{\n| <a> |\n|---|\n| 1\n 2 |\n\n\n}\n",
        "\ufeffns  t = 'x'\n",
        "  \n",
    ],
)
def test_every_line_keeps_its_own_ending_when_it_is_laid_out(text: str, ending: str) -> None:
    document = Document("x", 0, text.replace("\n", ending))
    found = edited(document.text, format_range(document, Span(0, len(document.text))))
    assert found.replace("\r\n", "\n").replace("\r", "\n") == lay_out(text)
    assert set(re.findall(r"\r\n|\r|\n", found)) <= {ending if "\n" in text else "\n"}


def test_sound_lines_are_left_alone() -> None:
    text = MODEL.replace("    var part\n", "  var   part\n\n\n\n").replace("\n", "\r\n")
    found = format_range(Document("x", 0, text), Span(0, len(text)))
    assert [(text[edit.span.start : edit.span.end], edit.text) for edit in found] == [
        ("  var   part", "    var part"),
        ("\r\n\r\n", ""),
    ]


def test_only_the_selected_lines_are_laid_out() -> None:
    text = MODEL.replace("    var part", "  var   part").replace("    var goal", "  var   goal")
    start = text.index("  var   part")
    found = edited(text, format_range(Document("x", 0, text), Span(start, start + 5)))
    assert found == MODEL.replace("    var goal", "  var   goal")


def test_a_new_line_is_indented_as_the_layout_has_it() -> None:
    text = MODEL.replace("    When:\n", "    When:\n\n", 1)
    line = text.index("    When:\n") + len("    When:\n")
    (edit,) = format_on_type(Document("x", 0, text), line, "\n")
    assert (edit.span, edit.text) == (Span(line, line), " " * 8)


def test_a_closing_brace_goes_below_its_opening_line_and_a_bar_aligns_its_table() -> None:
    text = "Scenario Template (ns=t) x {\n    var a\n    }"
    assert edited(text, format_on_type(Document("x", 0, text), len(text), "}")) == text[:-5] + "}\n"
    rows = "| <a> | <bb> |\n|---|---|\n| 1 | 2 |"
    assert edited(rows, format_on_type(Document("x", 0, rows), len(rows), "|")).rstrip() == lay_out(rows).rstrip()
