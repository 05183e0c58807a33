"""Counts that follow edits equal those of a fresh look at the whole file."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

from hypothesis import given
from hypothesis import strategies as st
from tests.bench.models import long_story

from edits import PIECES, Edit
from kit import FOLDER, MODEL
from robbdd_tools.base.document import Document
from robbdd_tools.checks.file_caches import without_cache
from robbdd_tools.checks.tally import Counts, Tally
from robbdd_tools.names.index import FileIndex, index_file
from robbdd_tools.syntax.declaration import Declaration

URI = f"{FOLDER}main.bdd"
EDITS = st.builds(
    Edit,
    st.just(0),
    st.sampled_from(["replace", "delete", "duplicate", "half", "undo"]),
    st.floats(0, 1),
    st.sampled_from([0, 0, 1, 5, 100, 400]),
    st.sampled_from([*PIECES, "Scenario bench-to-tray1-1 {"]),
)


def names(declaration: Declaration) -> Iterator[str]:
    return (symbol.name for symbol in declaration.symbols)


def counted(file: FileIndex) -> Counter[str]:
    found: Counter[str] = Counter()
    for placed in file.declarations:
        for part in [part.declaration for part in placed.declaration.parts] or [placed.declaration]:
            found.update(names(part))
    return found


@given(st.sampled_from([MODEL, long_story(60)]), st.lists(EDITS, max_size=10))
def test_counts_over_any_edits_are_those_of_the_text(text: str, edits: Sequence[Edit]) -> None:
    tally, history, file = Tally(names), [text], None
    for version, edit in enumerate([Edit(0, "replace", 0, 0, ""), *edits]):
        file = index_file(Document(URI, version, edit.apply(history)), file)
        assert tally.of(file).by_fact == counted(file)


def test_only_changed_declarations_are_counted_again_and_equal_counts_stay_the_same() -> None:
    asked: list[str] = []

    def watched(declaration: Declaration) -> Iterator[str]:
        asked.append(declaration.text.split("{")[0].strip())
        return names(declaration)

    tally = Tally(watched)
    first = index_file(Document(URI, 1, MODEL))
    before: Counts[str] = tally.of(first)
    asked.clear()
    after = tally.of(index_file(Document(URI, 2, MODEL.replace("var robot", "var  robot")), first))
    assert asked == ["Scenario Template (ns=t) fetch"] * 2
    assert after is before
    with without_cache():
        assert tally.of(first).by_fact == before.by_fact
        assert len(asked) > 5
