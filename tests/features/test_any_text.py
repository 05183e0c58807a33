"""No request fails on damaged text: models of every file kind, cut and mixed at random."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from random import Random

import pytest

from kit import EXAMPLES, MODELS
from robbdd_tools.base.document import Span
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.features.call_hierarchy import callable_at, calls_from, calls_to
from robbdd_tools.features.clause_results import clause_hints, row_hints
from robbdd_tools.features.completion import complete
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.features.document_links import document_links
from robbdd_tools.features.fixes_on_demand import fixes_on_demand
from robbdd_tools.features.folding import folds
from robbdd_tools.features.format_range import format_on_type, format_range
from robbdd_tools.features.goto_definition import definition
from robbdd_tools.features.hover import hover
from robbdd_tools.features.implementation import implementation
from robbdd_tools.features.layout import lay_out
from robbdd_tools.features.outline import outline
from robbdd_tools.features.refactor_clauses import extracted_clauses
from robbdd_tools.features.refactor_declarations import modernised, split_scene
from robbdd_tools.features.refactor_variations import variation_refactorings
from robbdd_tools.features.references import highlights, references
from robbdd_tools.features.rename import RenameRefused, linked_places, prepare_rename, rename
from robbdd_tools.features.run_verdicts import NOTHING
from robbdd_tools.features.scenario_hints import scenario_hints
from robbdd_tools.features.selection_ranges import selections
from robbdd_tools.features.semantic_tokens import semantic_tokens
from robbdd_tools.features.type_definition import type_definition
from robbdd_tools.features.type_hints import type_hints
from robbdd_tools.features.workspace_symbols import workspace_symbols
from robbdd_tools.names.project import Project, Snapshot

BROKEN = 6
"""Broken texts of each model."""
PLACES = 6
"""Cursors in each text."""


def renamed(snapshot: Snapshot, uri: str, offset: int) -> object:
    try:
        return rename(snapshot, uri, offset, "other")
    except RenameRefused as refused:
        return str(refused)


def called(snapshot: Snapshot, uri: str, offset: int) -> object:
    found = callable_at(snapshot, uri, offset)
    return found and (list(calls_from(snapshot, found)), list(calls_to(snapshot, found)))


AT_A_CURSOR: list[Callable[[Snapshot, str, int], object]] = [
    complete,
    hover,
    definition,
    type_definition,
    implementation,
    lambda snapshot, uri, offset: references(snapshot, uri, offset, with_declaration=True),
    highlights,
    prepare_rename,
    renamed,
    linked_places,
    called,
    selections,
    lambda snapshot, uri, offset: extracted_clauses(snapshot, uri, Span(offset, offset)),
    split_scene,
    lambda snapshot, uri, offset: list(variation_refactorings(snapshot, uri, Span(offset, offset))),
]


def ask_everything(snapshot: Snapshot, uri: str, places: list[int]) -> None:
    file = snapshot.file(uri)
    assert file is not None
    document = file.document
    whole = Span(0, len(document.text))
    for found in fast_diagnostics(snapshot, uri):
        assert 0 <= found.span.start <= found.span.end <= len(document.text)
        fixes_on_demand(snapshot, uri, found)
    semantic_tokens(snapshot, uri)
    document_links(snapshot, uri)
    folds(snapshot, uri)
    outline(snapshot, uri)
    workspace_symbols(snapshot, (), "a")
    modernised(snapshot, uri)
    lay_out(document.text)
    format_range(document, whole)
    list(type_hints(snapshot, uri, whole))
    list(scenario_hints(snapshot, uri, whole))
    list(clause_hints(snapshot, uri, NOTHING))
    list(row_hints(snapshot, uri, NOTHING))
    for place in places:
        for sign in "\n}|":
            format_on_type(document, place, sign)
        for ask in AT_A_CURSOR:
            ask(snapshot, uri, place)


def broken(text: str, random: Random) -> str:
    """The text cut off, or without some of its parts, or with one part in another's place."""
    one, other, third = sorted(random.randrange(len(text) + 1) for _ in range(3))
    kind = random.randrange(4)
    if kind == 0:
        return text[:one]
    if kind == 1:
        return text[other:]
    if kind == 2:
        return text[:one] + text[min(one + random.randrange(1, 30), len(text)) :]
    return text[:one] + text[other:third] + text[one:other] + text[third:]


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.relative_to(EXAMPLES).as_posix())
def test_no_request_fails_on_a_broken_text(path: Path) -> None:
    text, uri = path.read_text(encoding="utf-8"), path_to_uri(path)
    random = Random(path.name)
    for number in range(BROKEN):
        project = Project()
        changed = broken(text, random)
        project.open(uri, number, changed)
        places = [random.randrange(len(changed) + 1) for _ in range(PLACES)]
        ask_everything(project.snapshot(), uri, places)
