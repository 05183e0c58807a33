"""Names of Python code in models complete, are described and lead to their file; the code is never executed."""

from pathlib import Path

import pytest

from robbdd_tools.base.document import Document
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.features.completion import complete
from robbdd_tools.features.describe_entry import describe_entry
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.features.outside_names import OutsideName, outside_name_at
from robbdd_tools.names.project import Project, Snapshot

POLICIES = '''"""How we judge."""
raise SystemExit("executed")
from tools.reach import near as nearby
import numpy
LIMIT = 3

def apart(times, first, *, least: float = 0.1) -> list[bool]:
    """Return whether two things are apart.

    Times are in s.
    """

größe = 1; kürzer = 2

class Carry:
    """Carries a part."""

    def __init__(self, speed: float = 1.0) -> None: ...

def _hidden(): ...
'''
FILES = {
    "policies.py": POLICIES,
    "tools/__init__.py": "from .reach import near, Reach\n",
    "tools/reach.py": "# größe\ndef near(a, b):\n    '''Whether two things are near.'''\nclass Reach: ...\n",
    "notes.txt": "",
    "data/table.csv": "",
}


def model(folder: Path, written: str) -> tuple[Snapshot, str, int]:
    for name, text in FILES.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    text = f"ns x = 'https://example.org/x/'\nbhv impl (ns=x) own {{ {written}"
    offset = text.index("$0")
    uri, project = path_to_uri(folder / "run.bddx"), Project()
    project.open(uri, 1, text.replace("$0", ""))
    return project.snapshot(), uri, offset


def offered(folder: Path, written: str) -> list[tuple[str, str]]:
    found = sorted(complete(*model(folder, written)), key=lambda one: (one.rank, one.label))
    return [(one.label, one.detail) for one in found]


def at(folder: Path, written: str) -> OutsideName | None:
    return outside_name_at(*model(folder, written))


def place(folder: Path, written: str) -> str:
    found = at(folder, written)
    where = None if found is None else found.definition()
    assert where is not None
    document = Document(where.uri, 0, where.text)
    line = document.position(where.span.start).line + 1
    return f"{where.uri.rpartition('/')[2]}:{line}:{where.text[where.span.start : where.span.end]}"


def test_modules_next_to_the_model_are_offered(tmp_path: Path) -> None:
    assert offered(tmp_path, "py { module: $0 }") == [("policies", ""), ("tools", "")]
    assert offered(tmp_path, "py { module: tools.r$0") == [("tools.reach", "")]


def test_attributes_are_offered_with_what_can_be_called_first(tmp_path: Path) -> None:
    assert offered(tmp_path, "py { module: policies, attr: $0 } }") == [
        ("Carry", "(speed: float=1.0)"),
        ("apart", "(times, first, *, least: float=0.1) -> list[bool]"),
        ("LIMIT", ""),
        ("größe", ""),
        ("kürzer", ""),
        ("nearby", "imported"),
        ("numpy", "imported"),
    ]


def test_a_completion_replaces_the_whole_dotted_name(tmp_path: Path) -> None:
    snapshot, uri, offset = model(tmp_path, "py { module: tools.re$0ch, attr: near } }")
    (found,) = complete(snapshot, uri, offset)
    text = snapshot.document(uri).text
    assert (found.text, text[found.whole.start : found.whole.end]) == ("tools.reach", "tools.rech")


def test_a_completion_is_described_by_signature_and_docstring(tmp_path: Path) -> None:
    snapshot, uri, offset = model(tmp_path, "py { module: policies, attr: ap$0")
    found = next(one for one in complete(snapshot, uri, offset) if one.label == "apart")
    assert found.origin is not None
    words = describe_entry(snapshot, found.kind, *found.origin)
    assert words == (
        "```python\ndef apart(times, first, *, least: float=0.1) -> list[bool]\n```\n\n"
        "Return whether two things are apart.\n\nTimes are in s.\n\n`policies.py:7`"
    )


@pytest.mark.parametrize(
    ("written", "wanted"),
    [
        ("py { module: policies, attr: ap$0art } }", "policies.py:7:apart"),
        ("py { module: policies, attr: Car$0ry } }", "policies.py:15:Carry"),
        ("py { module: policies, attr: kürz$0er } }", "policies.py:13:kürzer"),
        ("py { module: policies, attr: nearby$0 } }", "reach.py:2:near"),
        ("py { module: tools, attr: Re$0ach } }", "reach.py:4:Reach"),
        ("py { module: tools, attr: rea$0ch } }", "reach.py:1:"),
        ("py { module: tools.re$0ach, attr: near } }", "reach.py:1:"),
        ("py { module: pol$0icies, attr: apartt } }", "policies.py:1:"),
    ],
)
def test_a_name_leads_to_its_definition(tmp_path: Path, written: str, wanted: str) -> None:
    assert place(tmp_path, written) == wanted


def test_the_module_is_described_by_its_docstring(tmp_path: Path) -> None:
    found = at(tmp_path, "py { module: polic$0ies, attr: apart } }")
    assert found is not None
    assert found.describe() == "**module** `policies`\n\nHow we judge.\n\n`policies.py`"


def test_what_does_not_exist_has_no_description(tmp_path: Path) -> None:
    found = at(tmp_path, "py { module: policies, attr: gon$0e } }")
    assert found is not None
    assert found.describe() is None
    assert found.definition() is None


def test_circular_imports_end(tmp_path: Path) -> None:
    (tmp_path / "one.py").write_text("from two import x\n", encoding="utf-8")
    (tmp_path / "two.py").write_text("from one import x\n", encoding="utf-8")
    found = at(tmp_path, "py { module: one, attr: x$0 } }")
    assert found is not None
    assert found.definition() is not None


def test_the_nearest_module_of_a_package_is_suggested(tmp_path: Path) -> None:
    snapshot, uri, _ = model(tmp_path, "py { module: tools.raech, attr: near } }$0")
    (found,) = (one for one in fast_diagnostics(snapshot, uri) if one.code == "python-source")
    assert found.message == "there is no module 'tools.raech'; did you mean 'tools.reach'?"
    assert [fix.edits[0].text for fix in found.fixes] == ["tools.reach"]


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("x = 1\n" * 200_000, "the names in the module 'large' are not checked: 'large.py' has 1.1 MiB; the limit is"),
        ("x = " + "-" * 50_000 + "1\n", "the names in the module 'large' are not checked: its expressions are nested"),
        ("def f(\n", "the module 'large' cannot be imported: "),
    ],
)
def test_a_huge_or_broken_file_is_reported_and_not_executed(tmp_path: Path, source: str, message: str) -> None:
    snapshot, uri, offset = model(tmp_path, "py { module: large, attr: a$0 } }")
    (tmp_path / "large.py").write_text(source, encoding="utf-8")
    assert [one.label for one in complete(snapshot, uri, offset)] == []
    assert outside_name_at(snapshot, uri, offset) is not None
    (found,) = (one for one in fast_diagnostics(snapshot, uri) if one.code == "python-source")
    assert found.message.startswith(message)
