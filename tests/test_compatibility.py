"""docs/compatibility.md names every word of the language, and is correct about models by others."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from kit import DOCS, ROOT, corpus
from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.features.diagnostics import all_diagnostics
from robbdd_tools.names.project import Project

PAGE = (DOCS / "compatibility.md").read_text(encoding="utf-8")
TABLE = [[cell.strip() for cell in line.strip("|").split("|")] for line in PAGE.splitlines() if line.startswith("|")]
STATES = {"runs", "checked", "unknown", "rewritten", "error"}
WORD = re.compile(r"'([A-Za-z][\w\-]*)'")
TOKEN = re.compile(r'//[^\n]*|"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])*\'|<[^>]*>|(?P<word>[A-Za-z][\w\-]*)')


def words_of_grammars() -> set[str]:
    texts = (path.read_text(encoding="utf-8") for path in (ROOT / "grammar").glob("*.tx"))
    return {word for text in texts for word in WORD.findall(re.sub(r"//[^\n]*", "", text))}


def is_named(word: str) -> bool:
    return re.search(rf"(?<![\w\-]){re.escape(word)}(?![\w\-])", PAGE) is not None


def test_every_word_of_the_grammar_is_named() -> None:
    assert sorted(word for word in words_of_grammars() if not is_named(word)) == []


def test_every_phrase_of_the_catalog_is_named() -> None:
    catalog = load_catalog()
    phrases = [word.phrase for word in (*catalog.predicates.values(), *catalog.behaviours.values())]
    words = {word for phrase in phrases for word in re.sub(r"<[^>]*>", " ", phrase).split() if word.isalpha()}
    assert sorted(word for word in words if not is_named(word)) == []


def test_every_row_has_a_state_and_every_link_a_page() -> None:
    rows = [row for row in TABLE if len(row) == 3 and not set(row[0]) <= set("-")]
    assert {row[1] for row in rows} - {"here"} == STATES
    for place in re.findall(r"\]\(([^)#]+)", PAGE):
        assert (DOCS / place).is_file(), place


def used_words(path: Path) -> set[str]:
    """The words of a model that are keywords of the language."""
    found = (match["word"] for match in TOKEN.finditer(path.read_text(encoding="utf-8")))
    return {word for word in found if word} & words_of_grammars()


def test_models_of_others_use_no_word_that_is_not_named_and_have_no_error() -> None:
    project = Project()
    paths = corpus(".bdd", ".bddx", ".scene", ".scenex", ".ktree")
    for path in paths:
        assert all(map(is_named, used_words(path))), path
        project.load(path_to_uri(path))
    snapshot = project.snapshot()
    for path in paths:
        found = all_diagnostics(snapshot, path_to_uri(path))
        assert [one for one in found if one.severity is Severity.ERROR] == []


@pytest.mark.parametrize("state", sorted(STATES - {"runs"}))
def test_a_state_is_explained(state: str) -> None:
    assert f"| **{state}** |" in PAGE
