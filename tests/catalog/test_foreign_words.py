"""Words of other packages: usable ones are added, others are left out with the reason."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from importlib.metadata import EntryPoint
from pathlib import Path

import pytest

from kit import EXAMPLES
from robbdd_tools.catalog.foreign_words import GROUP, foreign_words
from robbdd_tools.catalog.registry import load_catalog

TEXT = (EXAMPLES / "plugin" / "robbdd_turning" / "turns_slower_than.py").read_text(encoding="utf-8")
PHRASE = 'phrase="<object> turns slower than #limit"'
ENTRY = EntryPoint("turns", "turning:TURNS_SLOWER_THAN", GROUP)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    yield tmp_path
    sys.modules.pop("turning", None)


def added(folder: Path, text: str, *entries: EntryPoint) -> tuple[list[str], list[str]]:
    """Return the names of the words of a module with this text, and the problems."""
    (folder / "turning.py").write_text(text, encoding="utf-8")
    own = [("here", word) for word in load_catalog().predicates.values()]
    words, problems = foreign_words(entries or (ENTRY,), own)
    return [word.name for _, word in words], problems


def test_a_usable_word_is_added_with_its_origin(folder: Path) -> None:
    assert added(folder, TEXT) == (["turns-slower-than"], [])


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ("TURNS_SLOWER_THAN = ", "OTHER = ", "cannot be loaded: AttributeError"),
        ("TURNS_", 'raise SystemExit("over")\nTURNS_', "cannot be loaded: SystemExit: over"),
        ("TURNS_", "1 / 0\nTURNS_", "cannot be loaded: ZeroDivisionError"),
        ("TURNS_SLOWER_THAN = Predicate(", "TURNS_SLOWER_THAN = dict(", "is not a Predicate, Behaviour"),
        ('name="turns-slower-than"', 'name="touches"', "'touches' is the name of a word in here"),
        (PHRASE, 'phrase="<thing> turns slower than #limit"', "must have each of its slots once: limit, object"),
        (PHRASE, 'phrase="<object> is tilted less than #limit"', "is that of 'is-tilted-less-than' in here"),
        (PHRASE, f'{PHRASE}, aliases=("<object> turns",)', "the phrase '<object> turns' must have each of its slots"),
        ('\'"{object}" turns', '\'"{thing}" turns', "must have each slot once, in braces: limit, object"),
        ('"https://example.org/robbdd-turning/T', '"turn:T', "'turn:TurnsSlowerThanPredicate' must be an IRI, or have"),
        ('"rbw:limit"', '"limit"', "'limit' must be an IRI, or have a prefix of bdd, "),
    ],
)
def test_an_unusable_word_is_left_out_with_the_reason(folder: Path, old: str, new: str, reason: str) -> None:
    assert old in TEXT
    text = TEXT.replace(old, new, 1)
    found, (problem,) = added(folder, text)
    assert found == []
    assert problem.startswith("the word 'turns' of a package is left out: ")
    assert reason in problem


def test_of_two_packages_with_one_word_the_first_in_order_is_used(folder: Path) -> None:
    second = EntryPoint("turns-too", "turning:TURNS_SLOWER_THAN", GROUP)
    found, (problem,) = added(folder, TEXT, second, ENTRY)
    assert found == ["turns-slower-than"]
    assert problem.startswith("the word 'turns-too' of a package is left out: 'turns-slower-than' is the name")
