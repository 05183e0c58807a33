"""What editors and systems do to a file changes nothing: line ends, tabs, marks, letters of any script."""

from collections.abc import Callable
from pathlib import Path

import pytest

from kit import EVENTS, MODEL, SCENE, fixture
from robbdd_tools.base.diagnostic import Diagnostic
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.features.layout import lay_out
from robbdd_tools.graph.rdf.serialize import serialize
from robbdd_tools.graph.write.build import build_graph
from robbdd_tools.names.project import Project
from syntax.test_published import PUBLISHED, SCENE_IMPORT


def findings(text: str, name: str = "main.bdd") -> list[Diagnostic]:
    case = fixture(f"//- {name}\n{text}")
    analysis = case.snapshot.file(case.uri)
    assert analysis is not None
    return list(analysis.diagnostics)


def graph(text: str) -> str:
    case = fixture(text)
    return serialize(build_graph(case.snapshot, case.uri).graph, "ttl")


CHANGES: dict[str, Callable[[str], str]] = {
    "crlf": lambda text: text.replace("\n", "\r\n"),
    "cr": lambda text: text.replace("\n", "\r"),
    "tabs": lambda text: text.replace("    ", "\t"),
    "no newline at the end": lambda text: text.rstrip(),
    "byte-order mark": lambda text: "\ufeff" + text,
    "comments": lambda text: text.replace("\n", " // größer als <nichts> { \n"),
    "one line": lambda text: " ".join(text.split()),
}


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES.keys())
@pytest.mark.parametrize("model", [MODEL, SCENE_IMPORT + PUBLISHED], ids=["current", "published"])
def test_the_layout_of_a_file_changes_nothing(model: str, change: Callable[[str], str]) -> None:
    changed = change(model)
    assert findings(changed) == []
    assert graph(changed) == graph(model)


@pytest.mark.parametrize("name", ["größe", "κύβος", "куб", "部品", "_x", "a-1"])
def test_names_may_have_letters_of_any_script(name: str) -> None:
    text = EVENTS + f"Event (ns=t) {name}\nconst set (ns=t) s-{name} {{ 1 }}\n"
    assert findings(text + MODEL.removeprefix(EVENTS).replace("<pick-start>", f"<{name}>")) == []


def test_strings_may_hold_anything() -> None:
    assert graph(MODEL.replace('"parts fetched"', '"it\'s \\"größer\\" → 部品 🤖"')).count("🤖") == 1


def test_a_string_of_several_lines_means_the_same_whatever_ends_them() -> None:
    text = MODEL.replace('"parts fetched"', '"parts\n   fetched"')
    assert graph(text) == graph(text.replace("\n", "\r\n")) == graph(lay_out(text.replace("\n", "\r\n")))


def test_a_file_on_disk_may_begin_with_a_byte_order_mark(tmp_path: Path) -> None:
    (tmp_path / "lab.scene").write_bytes(b"\xef\xbb\xbf" + SCENE.encode())
    (tmp_path / "main.bdd").write_bytes(b"\xef\xbb\xbf" + MODEL.replace("\n", "\r\n").encode())
    project = Project()
    uri = path_to_uri(tmp_path / "main.bdd")
    project.load(uri)
    analysis = project.snapshot().file(uri)
    assert analysis is not None
    assert analysis.diagnostics == ()
