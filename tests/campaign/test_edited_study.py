"""A study in an editor: it is checked against the texts of the editor, and its names lead to its models."""

from __future__ import annotations

from pathlib import Path

import pytest

from campaign.study_agents import write_study
from kit import EXAMPLES
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.campaign.edited_study import study_diagnostics
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.features.document_links import document_links
from robbdd_tools.features.goto_definition import definition
from robbdd_tools.features.hover import hover
from robbdd_tools.features.references import highlights, references
from robbdd_tools.features.rename import rename
from robbdd_tools.features.rename_files import import_edits
from robbdd_tools.names.index import FileIndex
from robbdd_tools.names.project import Project, Snapshot

HEAD = 'import "m.bdd"\nStudy s {\n'


class Editing:
    """The text of a study in an editor. ``$0`` is the cursor."""

    def __init__(self, folder: Path, text: str, **others: str) -> None:
        self.cursor = text.find("$0")
        self.text = text.replace("$0", "")
        self.uri = path_to_uri(write_study(folder, self.text))
        self.project = Project()
        self.project.open(self.uri, 1, self.text)
        for name, content in others.items():
            self.project.open(path_to_uri(folder / name.replace("_", ".")), 1, content)

    @property
    def snapshot(self) -> Snapshot:
        return self.project.snapshot()

    def shown(self) -> list[str]:
        found = [*fast_diagnostics(self.snapshot, self.uri), *study_diagnostics(self.project, self.uri)]
        return [f"{self.text[one.span.start : one.span.end]} [{one.code}] {one.message}" for one in found]


def test_a_study_without_errors_has_no_findings(tmp_path: Path) -> None:
    assert Editing(tmp_path, f"{HEAD}scenarios: {{ <bench-to-tray> }} repeat: 2 }}").shown() == []


@pytest.mark.parametrize(
    ("setting", "expected"),
    [
        ("repeat: 0", "0 [syntax] 'repeat' is a whole number from 1 to 1000000, not 0"),
        ("scenarios: { <gone> }", "<gone> [study] there is no scenario 'gone'; the model has bench-to-tray"),
        ('where: "prt=bolt"', "prt=bolt [study] where, column 1: unknown variable 'prt'"),
        ('factor scene: { "gone.scenex" }', "gone.scenex [study] there is no file gone.scenex"),
        ("factor bhv <x>: { pick-place }", "pick-place [study] there is no behaviour implementation 'x'"),
    ],
)
def test_each_error_is_at_its_place(tmp_path: Path, setting: str, expected: str) -> None:
    (found,) = Editing(tmp_path, f"{HEAD}{setting} }}").shown()
    assert found.startswith(expected)


def test_texts_in_the_editor_count_instead_of_the_disk(tmp_path: Path) -> None:
    text = f"{HEAD}scenarios: {{ <bench-to-tray> }} }}"
    stored = (write_study(tmp_path, text).parent / "m.bdd").read_text(encoding="utf-8")
    renamed = Editing(tmp_path, text, m_bdd=stored.replace("bench-to-tray", "bench-to-box"))
    (found,) = renamed.shown()
    assert found.startswith("<bench-to-tray> [study] there is no scenario 'bench-to-tray'; the model has bench-to-box")
    (found,) = Editing(tmp_path, text, m_bdd="Task (ns=x) t").shown()
    assert found.startswith("m.bdd [broken-import] 'm.bdd' has an error, the first: there is no namespace 'x'")
    (found,) = Editing(tmp_path, text, m_bdd="ns x = 'https://example.org/x/'").shown()
    assert found == "m.bdd [study] the model has no scenario to run"


def test_a_name_leads_to_its_declaration_in_the_model(tmp_path: Path) -> None:
    case = Editing(tmp_path, f"{HEAD}scenarios: {{ <bench$0-to-tray> }} }}")
    found = definition(case.snapshot, case.uri, case.cursor)
    assert found is not None
    uri, span = found
    assert (uri.rpartition("/")[2], case.snapshot.document(uri).text[span.start : span.end]) == (
        "m.bdd",
        "bench-to-tray",
    )
    shown = hover(case.snapshot, case.uri, case.cursor)
    assert shown is not None
    assert shown.markdown.startswith("**scenario variant** `fetching.bench-to-tray`")
    assert case.text[shown.span.start : shown.span.end] == "bench-to-tray"


def test_an_import_leads_to_its_file(tmp_path: Path) -> None:
    case = Editing(tmp_path, f"{HEAD.replace('m.bdd', 'm$0.bdd')}}}")
    found = definition(case.snapshot, case.uri, case.cursor)
    assert found is not None
    assert found[0].endswith("/m.bdd")
    assert [one.target for one in document_links(case.snapshot, case.uri)] == [found[0]]


def test_a_rename_changes_the_studies_that_name_a_scenario(tmp_path: Path) -> None:
    case = Editing(tmp_path, f"{HEAD}scenarios: {{ <bench$0-to-tray> }} }}")
    edits = rename(case.snapshot, case.uri, case.cursor, "away")
    assert sorted({one.uri.rpartition("/")[2] for one in edits}) == ["m.bdd", "x.study"]
    (own,) = [one for one in edits if one.uri == case.uri]
    assert f"{case.text[: own.span.start]}{own.text}{case.text[own.span.end :]}" == f"{HEAD}scenarios: {{ <away> }} }}"
    places = references(case.snapshot, case.uri, case.cursor, with_declaration=True)
    assert sorted(places) == sorted((one.uri, one.span) for one in edits)
    assert [(one.start, one.end) for one in highlights(case.snapshot, case.uri, case.cursor)] == [
        (own.span.start, own.span.end)
    ]


def test_the_local_name_of_an_iri_is_a_reference_and_another_iri_is_none(tmp_path: Path) -> None:
    local = Editing(tmp_path, f"{HEAD}scenarios: {{ <bench$0-to-tray> }} }}")
    (uri, span), *_ = references(local.snapshot, local.uri, local.cursor, with_declaration=True)
    model = local.snapshot.file(uri)
    assert model is not None
    iri = next(one.iri for one in model.definitions.values() if one.span == span)
    case = Editing(tmp_path, f"{HEAD}scenarios: {{ <{iri}> }} }}")
    assert case.shown() == []
    assert definition(case.snapshot, case.uri, case.text.index("bench-to-tray")) == (uri, span)
    assert definition(case.snapshot, case.uri, case.text.index("https")) is None
    other = Editing(tmp_path, f"{HEAD}scenarios: {{ <https://elsewhere.org/bench-to-tray> }} }}")
    assert definition(other.snapshot, other.uri, other.text.index("bench-to-tray")) is None


def test_a_moved_model_or_scene_is_followed(tmp_path: Path) -> None:
    case = Editing(tmp_path, f'{HEAD}factor scene: {{ "a.scenex" }} }}')
    folder = case.uri.rpartition("/")[0]
    file = case.snapshot.sources[case.uri]
    assert isinstance(file, FileIndex)
    moves = {f"{folder}/m.bdd": f"{folder}/in/m.bdd", f"{folder}/a.scenex": f"{folder}/b.scenex"}
    edits = import_edits([file], moves)
    assert sorted(one.text for one in edits) == ["b.scenex", "in/m.bdd"]


def test_an_implementation_leads_to_the_execution(tmp_path: Path) -> None:
    for path in (EXAMPLES / "pickplace").iterdir():
        if path.is_file():
            (tmp_path / path.name).write_bytes(path.read_bytes())
    stored = next(tmp_path.glob("*.bddx"))
    name = stored.read_text(encoding="utf-8").partition("bhv impl (ns=")[2].partition(") ")[2].split()[0]
    text = f'import "{stored.name}"\nStudy s {{ factor bhv <{name}>: {{ pick-place }} }}'
    uri = path_to_uri(tmp_path / "p.study")
    project = Project()
    project.open(uri, 1, text)
    assert study_diagnostics(project, uri) == []
    found = definition(project.snapshot(), uri, text.index(f"<{name}") + 1)
    assert found is not None
    assert found[0].endswith(stored.name)
