"""Unopened files are searched without parsing them, and give the names that parsing finds."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from edits import PIECES, Edit
from kit import EXAMPLES, MODEL, SCENE
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.features.workspace_files import model_files
from robbdd_tools.features.workspace_symbols import Named, workspace_symbols
from robbdd_tools.names.project import Project
from robbdd_tools.syntax.parse import parse_declaration

TEXTS = {
    "main.bdd": MODEL,
    "lab.scene": SCENE,
    "odd.bdd": "ns t = 'urn:t:' Event (ns=t) ΑΣ Event (ns=t) a Event (ns=t) ΑΣ",
}
QUERIES = ("", "washers.washer1", "carry", "bench.tray", "robot", "tf", "ΑΣ", "ας.", "zzz", "places")
EDITS = st.builds(
    Edit,
    st.just(0),
    st.sampled_from(["replace", "delete", "duplicate", "half"]),
    st.floats(0, 1),
    st.sampled_from([0, 0, 1, 5, 20]),
    st.sampled_from(PIECES),
)


def shown(found: Sequence[Named]) -> list[tuple[str, str, str, int]]:
    return [(one.document.uri, one.path, str(one.kind), one.span.start) for one in found]


def agrees(folder: Path, queries: Sequence[str]) -> None:
    """Compare the search in closed files with the one in loaded files."""
    uri, closed, loaded = path_to_uri(folder), Project().snapshot(), Project()
    for name in model_files([uri]):
        loaded.load(name)
    for query in queries:
        expected = workspace_symbols(loaded.snapshot(), [], query)
        assert shown(workspace_symbols(closed, [uri], query)) == shown(expected)


@pytest.mark.parametrize(
    "folder", sorted(path for path in EXAMPLES.iterdir() if path.is_dir()), ids=lambda path: path.name
)
def test_names_in_the_examples_are_those_of_parsing_them(folder: Path) -> None:
    agrees(folder, ("", "a", "tray", "bench.ws", "fet.ba"))


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=30)
@given(st.sampled_from(sorted(TEXTS)), st.lists(EDITS, max_size=3), st.sampled_from(QUERIES))
def test_names_in_broken_files_are_those_of_parsing_them(
    tmp_path: Path, name: str, edits: Sequence[Edit], query: str
) -> None:
    history = [TEXTS[name]]
    for edit in edits:
        edit.apply(history)
    (tmp_path / name).write_bytes(history[-1].encode())
    agrees(tmp_path, (query, query[:3], query[2:5]))


def test_declarations_that_cannot_fit_are_not_parsed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "main.bdd").write_text(f"{MODEL}Event (ns=t) broken (\n", encoding="utf-8")
    parsed: list[str] = []

    def watched(language: str, text: str) -> object:
        parsed.append(" ".join(text.split()[:2]))
        return parse_declaration(language, text)

    monkeypatch.setattr("robbdd_tools.features.workspace_symbols.parse_declaration", watched)
    snapshot, folder = Project().snapshot(), path_to_uri(tmp_path)
    assert [found.path for found in workspace_symbols(snapshot, [folder], "fetchgoal")] == ["fetch.goal"]
    assert parsed == ["Event (ns=t)", "Scenario Template"]
