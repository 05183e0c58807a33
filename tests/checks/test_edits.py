"""Edits of whole lines, with every kind of line end, comments and a byte order mark; lists of words in messages."""

from __future__ import annotations

import pytest

from kit import FOLDER, Fixture, fixture
from robbdd_tools.base.diagnostic import Edit
from robbdd_tools.base.document import Document, Span
from robbdd_tools.base.removals import removal
from robbdd_tools.checks.finding import article, listed
from robbdd_tools.checks.lines import import_edit, import_removal, line_below, line_end
from robbdd_tools.names.analysis import FileAnalysis
from robbdd_tools.syntax import tree

URI = f"{FOLDER}main.bdd"


def edited(text: str, edits: tuple[Edit, ...]) -> str:
    """Apply edits of one file."""
    assert {edit.uri for edit in edits} == {URI}
    for edit in sorted(edits, key=lambda edit: edit.span, reverse=True):
        text = text[: edit.span.start] + edit.text + text[edit.span.end :]
    return text


def analysis(case: Fixture) -> FileAnalysis:
    found = case.snapshot.file(case.uri)
    assert found is not None
    return found


@pytest.mark.parametrize(
    ("text", "left"),
    [
        ("one\n«two»\nthree", "one\nthree"),
        ("one\r\n  «two»  \r\nthree", "one\r\nthree"),
        ("«one»\r\n\r\ntwo", "\r\ntwo"),
        ("one\n«two»", "one\n"),
        ("one «two»\nthree", "one \nthree"),
        ("«one» two\nthree", " two\nthree"),
        ("one\n «two\nthree» \nfour", "one\nfour"),
        ("one\n«two» // why\nthree", "one\n // why\nthree"),
    ],
)
def test_a_removal_takes_the_lines_that_would_be_empty(text: str, left: str) -> None:
    span = Span(text.index("«"), text.index("»") - 1)
    document = Document(URI, 1, text.replace("«", "").replace("»", ""))
    fix = removal(document, "Remove it", span)
    assert (fix.title, edited(document.text, fix.edits)) == ("Remove it", left)


@pytest.mark.parametrize(
    ("text", "changed"),
    [
        ("", 'import "x.scene"\n'),
        ("ns t = 'https://t/'\n", "import \"x.scene\"\nns t = 'https://t/'\n"),
        ("\ufeffns t = 'https://t/'\n", "\ufeffimport \"x.scene\"\nns t = 'https://t/'\n"),
        ('import "lab.scene"\n', 'import "lab.scene"\nimport "x.scene"\n'),
        ('// first\nimport "lab.scene" // why\n\n', '// first\nimport "lab.scene" // why\nimport "x.scene"\n\n'),
        ('import "lab.scene"  \n', 'import "lab.scene"  \nimport "x.scene"\n'),
        (
            "import \"lab.scene\" ns t = 'https://t/'\n",
            'import "lab.scene"\nimport "x.scene" ns t = \'https://t/\'\n',
        ),
    ],
)
def test_an_import_is_added_below_the_last_one_or_as_the_first_line(text: str, changed: str) -> None:
    assert edited(text, (import_edit(analysis(fixture(text)), "x.scene"),)) == changed


def test_a_line_is_added_below_the_first_kind_of_declaration_that_there_is() -> None:
    text = "ns t = 'https://t/'\nEvent (ns=t) a\nTask (ns=t) b\n"
    file = analysis(fixture(text))
    for kinds, place in (((tree.Event, tree.Namespace), "a\n"), ((tree.Import, tree.Task), "b\n")):
        edit = line_below(file, kinds, "Event (ns=t) c")
        assert edited(text, (edit,)) == text.replace(place, f"{place}Event (ns=t) c\n")


@pytest.mark.parametrize(
    ("text", "end"), [("ab  \ncd", 4), ("ab // c\nd", 7), ("ab cd\ne", 2), ("ab", 2), ("ab /c\n", 2), ("ab c //\n", 2)]
)
def test_the_end_of_a_line_includes_white_space_and_a_comment(text: str, end: int) -> None:
    assert line_end(Document(URI, 1, text), 2) == end


def test_the_removal_of_an_import_leaves_all_other_lines() -> None:
    text = 'ns t = \'https://t/\'\nimport "lab.scene"\nimport "other.scene"\nEvent (ns=t) a\n'
    file = analysis(fixture(f"//- main.bdd\n{text}//- other.scene\n"))
    for link, path in zip(file.imports, ("lab", "other"), strict=True):
        (fix,) = import_removal(file, link, "Remove this import")
        assert edited(text, fix.edits) == text.replace(f'import "{path}.scene"\n', "")


def test_names_are_listed_as_in_a_sentence() -> None:
    assert [listed(["a"]), listed(["a", "b"]), listed(["a", "b", "c"])] == ["'a'", "'a' and 'b'", "'a', 'b' and 'c'"]
    assert [article("object"), article("agent"), article("workspace")] == ["an object", "an agent", "a workspace"]
