"""One file that is named in different upper and lower case letters, where the file system ignores case."""

from __future__ import annotations

from pathlib import Path

import pytest

from case_kit import CaseIgnored
from kit import MODEL, SCENE
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.base.spellings import Spellings
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.features.fixes_on_demand import fixes_on_demand
from robbdd_tools.features.import_graph import ImportGraph
from robbdd_tools.features.references import references
from robbdd_tools.features.rename_files import affected_files, import_edits
from robbdd_tools.names.project import Project
from robbdd_tools.workbench.model import load, load_all


@pytest.fixture
def cell(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with ``main.bdd``, which imports ``lab.scene``, and ``Lab.scene``. The file system ignores case."""
    folder = tmp_path / "cell"
    folder.mkdir()
    (folder / "main.bdd").write_text(MODEL, encoding="utf-8")
    (folder / "Lab.scene").write_text(SCENE, encoding="utf-8")
    CaseIgnored(monkeypatch, tmp_path)
    return folder


def test_an_open_document_is_the_file_that_others_import_in_other_letters(cell: Path) -> None:
    main, stored, written = (path_to_uri(cell / name) for name in ("main.bdd", "Lab.scene", "lab.scene"))
    project = Project()
    project.load(main)
    assert set(project.snapshot().sources) == {main, written}
    project.open(stored, 1, SCENE)
    snapshot = project.snapshot()
    assert set(snapshot.sources) == {main, stored}
    assert snapshot.importers(stored) == (main,)
    found = references(snapshot, main, MODEL.index("arms.panda"), True)
    assert {uri for uri, _ in found} == {main, stored}


@pytest.mark.parametrize("opened", ["Lab.scene", "lab.scene", "LAB.scene"])
def test_the_spelling_of_the_client_stands_for_the_file_until_another_one_is_opened(cell: Path, opened: str) -> None:
    project = Project()
    project.load(path_to_uri(cell / "main.bdd"))
    project.load(path_to_uri(cell / "Lab.scene"))
    uri = path_to_uri(cell / opened)
    project.open(uri, 1, SCENE)
    assert set(project.snapshot().sources) == {path_to_uri(cell / "main.bdd"), uri}
    project.close(uri)
    other = path_to_uri(cell / "laB.scene")
    project.open(other, 1, SCENE)
    assert set(project.snapshot().sources) == {path_to_uri(cell / "main.bdd"), other}


def test_two_documents_of_one_file_keep_their_texts(cell: Path) -> None:
    one, other = path_to_uri(cell / "Lab.scene"), path_to_uri(cell / "lab.scene")
    project = Project()
    project.open(one, 1, SCENE)
    project.open(other, 1, f"{SCENE}// other\n")
    texts = project.texts()
    assert set(texts) == {one, other}
    project.replace(texts)
    assert project.texts() == texts


def test_a_change_of_the_file_is_seen_whatever_spelling_reports_it(cell: Path) -> None:
    main, written = path_to_uri(cell / "main.bdd"), path_to_uri(cell / "lab.scene")
    project = Project()
    project.load(main)
    assert project.snapshot().document(written).text == SCENE
    (cell / "Lab.scene").write_text(f"{SCENE}// new\n", encoding="utf-8")
    project.refresh(path_to_uri(cell / "Lab.scene"))
    assert project.snapshot().document(written).text.endswith("// new\n")


def test_files_are_compared_once_and_then_looked_up(cell: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    disk = CaseIgnored(monkeypatch, cell)
    project = Project()
    project.open(path_to_uri(cell / "Lab.scene"), 1, SCENE)
    main = path_to_uri(cell / "main.bdd")
    project.open(main, 1, MODEL)
    assert project.snapshot().file(main) is not None
    before = disk.compared
    for version in range(2, 5):
        project.open(main, version, f"{MODEL}\n// edit {version}\n")
        assert project.snapshot().file(main) is not None
    assert disk.compared == before


def test_an_import_in_other_letters_is_reported_and_corrected(cell: Path) -> None:
    main = path_to_uri(cell / "main.bdd")
    project = Project()
    project.load(main)
    snapshot = project.snapshot()
    (found,) = fast_diagnostics(snapshot, main)
    assert (found.code, found.severity.name) == ("import", "WARNING")
    assert found.message == "the file is called 'Lab.scene': other systems do not find it as 'lab.scene'"
    assert MODEL[found.span.start : found.span.end] == "lab.scene"
    fix = next(iter(fixes_on_demand(snapshot, main, found)))
    assert [edit.text for edit in fix.edits] == ["Lab.scene"]


@pytest.mark.parametrize(
    ("path", "named"),
    [
        ("./PARTS/bin.scene", "parts/bin.scene"),
        ("parts/Bin.scene", "parts/bin.scene"),
        ("../CELL/parts/bin.scene", "cell/parts/bin.scene"),
        ("../cell/./parts/bin.scene", None),
        ("parts/bin.scene", None),
    ],
)
def test_folders_are_compared_as_far_as_the_import_names_them(cell: Path, path: str, named: str | None) -> None:
    (cell / "parts").mkdir()
    (cell / "parts" / "bin.scene").write_text("", encoding="utf-8")
    # The folders above have other letters, too, but no import names them.
    main = path_to_uri(cell.parent / "Cell" / "main.bdd")
    project = Project()
    project.open(main, 1, f'import "{path}"\n')
    messages = [found.message for found in fast_diagnostics(project.snapshot(), main) if found.code == "import"]
    assert [named] * (named is not None) == [message.split("'")[1] for message in messages]


def test_where_case_matters_a_missing_file_is_told_from_one_in_other_letters(tmp_path: Path) -> None:
    (tmp_path / "Parts").mkdir()
    (tmp_path / "Parts" / "Lab.scene").write_text("", encoding="utf-8")
    main = path_to_uri(tmp_path / "main.bdd")
    project = Project()
    project.open(main, 1, 'import "parts/lab.scene"\n')
    snapshot = project.snapshot()
    found = next(found for found in fast_diagnostics(snapshot, main) if found.code == "import")
    assert found.severity.name == "ERROR"
    lab = tmp_path / "Parts" / "Lab.scene"
    assert f"but there is {lab}: upper and lower case letters differ" in found.message
    assert next(iter(fixes_on_demand(snapshot, main, found))).edits[0].text == "Parts/Lab.scene"


def test_two_files_whose_names_differ_in_case_are_two_files_where_case_matters(tmp_path: Path) -> None:
    for name in ("lab.scene", "Lab.scene"):
        (tmp_path / name).write_text(SCENE, encoding="utf-8")
    model = load_all([tmp_path])
    assert [Path(file.name).name for file in model.files] == ["Lab.scene", "lab.scene"]


def test_two_names_of_one_file_on_the_disk_are_one_model(tmp_path: Path) -> None:
    (tmp_path / "Lab.scene").write_text(SCENE, encoding="utf-8")
    (tmp_path / "lab.scene").hardlink_to(tmp_path / "Lab.scene")
    (tmp_path / "main.bdd").write_text(MODEL, encoding="utf-8")
    model = load_all([tmp_path / "Lab.scene", tmp_path / "main.bdd"])
    assert {Path(uri).name for uri in model.files[0].snapshot.sources} == {"Lab.scene", "main.bdd"}
    # Both names are on the disk, so every system finds the file.
    assert not [found for found in load(tmp_path / "main.bdd").diagnostics if found.code == "import"]


def test_a_file_is_compared_again_after_it_has_changed(tmp_path: Path) -> None:
    one, other = tmp_path / "Lab.scene", tmp_path / "lab.scene"
    one.write_text("", encoding="utf-8")
    other.hardlink_to(one)
    spellings = Spellings()
    assert spellings.of(path_to_uri(one)) == spellings.of(path_to_uri(other)) == path_to_uri(one)
    other.unlink()
    other.write_text("", encoding="utf-8")
    assert sorted(spellings.reset(path_to_uri(other))) == [path_to_uri(one), path_to_uri(other)]
    assert spellings.of(path_to_uri(one)) != spellings.of(path_to_uri(other))


def test_the_files_that_import_one_are_found_on_the_disk(cell: Path) -> None:
    main, stored = path_to_uri(cell / "main.bdd"), path_to_uri(cell / "Lab.scene")
    graph = ImportGraph.of([stored, main])
    assert graph.importers(stored) == graph.importers(path_to_uri(cell / "LAB.scene")) == {main}


def test_an_import_follows_a_file_that_is_renamed(cell: Path) -> None:
    main, stored = path_to_uri(cell / "main.bdd"), path_to_uri(cell / "Lab.scene")
    moves = {stored: path_to_uri(cell / "Hall.scene")}
    edits = import_edits(affected_files([main, stored], moves), moves)
    assert [(edit.uri, edit.text) for edit in edits] == [(main, "Hall.scene")]
