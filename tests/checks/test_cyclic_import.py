"""Files that import each other are reported at their imports."""

from checks.models import found

CIRCLE = "//- a.scene\nimport 'b.scene'\n//- b.scene\nimport 'c.scene'\n//- c.scene\n"


def test_an_import_that_leads_back_is_a_warning_on_its_path() -> None:
    (entry,) = found(CIRCLE + "import 'a.scene'\n", "cyclic-import")
    assert entry.message.startswith("'b.scene' also imports 'a.scene': move what both need")
    assert (entry.span.start, entry.span.end) == (8, 15)


def test_imports_without_a_circle_are_fine() -> None:
    assert found(CIRCLE, "cyclic-import") == []


def test_a_circle_that_this_file_is_not_part_of_is_reported_elsewhere() -> None:
    assert found(CIRCLE + "import 'b.scene'\n", "cyclic-import") == []


def test_a_file_that_imports_itself_is_told_once() -> None:
    assert [entry.code for entry in found("//- a.scene\nimport 'a.scene'\n")] == ["import"]
