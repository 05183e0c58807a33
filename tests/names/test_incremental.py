"""After any edits, the analysis of a file equals a fresh analysis of the same text.

``ROBBDD_FUZZ`` sets the number of edit sequences (``make fuzz`` sets a large one); a failure shrinks to few edits.
"""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from tests.bench.models import long_story

from edits import PIECES, Edit
from kit import EXAMPLES, MODEL, SCENE
from robbdd_tools.base.document import Span
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.checks.file_caches import without_cache
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.features.folding import folds
from robbdd_tools.features.outline import outline
from robbdd_tools.features.scenario_hints import scenario_hints
from robbdd_tools.features.semantic_tokens import semantic_tokens
from robbdd_tools.features.type_hints import type_hints
from robbdd_tools.names.analysis import FileAnalysis
from robbdd_tools.names.clause_places import clauses_in
from robbdd_tools.names.project import Project

IN_CI = 125
SEQUENCES = int(os.environ.get("ROBBDD_FUZZ", IN_CI))
LENGTH = 16
"""Edits of a sequence."""


def _texts() -> list[dict[str, str]]:
    """Pairs of model and scene that users would have open together: ours, and foreign ones if available."""
    pairs = [{"main.bdd": MODEL, "lab.scene": SCENE}, {"main.bdd": long_story(40), "lab.scene": SCENE}]
    folder = EXAMPLES / "pickplace"
    pairs.append({path.name: path.read_text(encoding="utf-8") for path in sorted(folder.glob("*.[bs]*"))})
    corpus = os.environ.get("ROBBDD_CORPUS")
    for path in sorted(Path(corpus, "current").glob("*.bdd")) if corpus else []:
        scene = path.with_name("lab.scene")
        pairs.append({file.name: file.read_text(encoding="utf-8") for file in (path, scene)})
    return pairs


TEXTS = _texts()
WHOLE_TEXTS = [text for pair in TEXTS for text in pair.values()]


@st.composite
def foreign_pieces(draw: st.DrawFn) -> str:
    """Some text of one of the files, as a user would paste it."""
    text = draw(st.sampled_from(WHOLE_TEXTS))
    start = int(draw(st.floats(0, 1)) * len(text))
    return text[start : start + draw(st.integers(0, 60))]


EDITS = st.builds(
    Edit,
    st.integers(0, 1),
    st.sampled_from(["replace", "replace", "replace", "delete", "duplicate", "half", "undo"]),
    st.floats(0, 1),
    st.sampled_from([0, 0, 0, 1, 1, 2, 5, 20, 100, 400]),
    st.one_of(st.sampled_from(PIECES), foreign_pieces()),
)


def known(project: Project, uri: str) -> object:
    """Everything that users see of a file."""
    snapshot = project.snapshot()
    analysis = snapshot.file(uri)
    assert isinstance(analysis, FileAnalysis)
    definitions = {
        path: (found.span, found.extent, found.kind, found.iri) for path, found in analysis.definitions.items()
    }
    targets = [(placed.offset, dict(placed.targets)) for placed in analysis.declarations]
    whole = Span(0, len(analysis.document.text))
    told = [
        folds(snapshot, uri),
        outline(snapshot, uri),
        type_hints(snapshot, uri, whole),
        scenario_hints(snapshot, uri, whole),
        list(clauses_in(snapshot, uri)),
    ]
    return fast_diagnostics(snapshot, uri), definitions, targets, analysis.imports, semantic_tokens(snapshot, uri), told


@settings(max_examples=SEQUENCES, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(st.sampled_from(TEXTS), st.lists(EDITS, min_size=LENGTH, max_size=LENGTH))
def test_an_edited_project_equals_a_fresh_one(texts: dict[str, str], edits: list[Edit]) -> None:
    folder = Path("/fuzz")
    files = {path_to_uri(folder / name): text for name, text in texts.items()}
    uris = list(files)
    edited = Project()
    for uri, text in files.items():
        edited.open(uri, 0, text)
    histories = {uri: [text] for uri, text in files.items()}
    for version, edit in enumerate(edits, start=1):
        uri = uris[edit.file % len(uris)]
        files[uri] = edit.apply(histories[uri])
        _compare(edited, files, uri, version)
    for uri in uris:
        files[uri] = histories[uri][0]
        _compare(edited, files, uri, len(edits) + 1)


def test_there_are_enough_edits_without_asking_for_more() -> None:
    assert IN_CI * LENGTH >= 2000


@pytest.mark.parametrize(
    ("kind", "length", "expected"),
    [
        ("replace", 3, "x\na +c d\n"),
        ("delete", 2, "x\na  d\n"),
        ("duplicate", 1, "x\na bb bb c d\n"),
        ("half", 1, "x\na\n"),
        ("undo", 0, "x\n"),
    ],
)
def test_an_edit_is_what_a_user_does(kind: str, length: int, expected: str) -> None:
    history = ["x\n", "x\na bb c d\n"]
    edit = Edit(0, kind, 0.4, length, "+")
    assert edit.apply(history) == expected
    assert history[-1] == expected


def _compare(edited: Project, files: dict[str, str], changed: str, version: int) -> None:
    edited.open(changed, version, files[changed])
    fresh = Project()
    for uri, text in files.items():
        fresh.open(uri, 0, text)
    for uri in files:
        with without_cache():
            expected = known(fresh, uri)
        assert known(edited, uri) == expected
