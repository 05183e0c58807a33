"""Findings that are kept while the declarations around them move."""

from __future__ import annotations

from dataclasses import replace

from kit import FOLDER, Fixture, fixture
from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, Related, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.names.analysis import PlacedDeclaration
from robbdd_tools.names.anchors import Anchors

MAIN, OTHER = f"{FOLDER}main.bdd", f"{FOLDER}other.bdd"
TEXT = "ns t = 'https://t/'\nEvent (ns=t) first\nEvent (ns=t) second\nTask (ns=t) third\n"
AWAY = "ns o = 'https://o/'\nEvent (ns=o) fourth\n"


def test_all_spans_of_a_finding_move_with_their_declarations() -> None:
    case = fixture(f"//- main.bdd\n{TEXT}//- other.bdd\n{AWAY}//- empty.bdd\n")
    found = Diagnostic(
        MAIN,
        span(TEXT, "second"),
        Severity.ERROR,
        "code",
        "message",
        (Related(MAIN, span(TEXT, "third"), "below"), Related(OTHER, span(AWAY, "fourth"), "elsewhere")),
        (
            Fix("one", (Edit(MAIN, span(TEXT, "second"), "2"), Edit(OTHER, span(AWAY, "fourth"), "4"))),
            Fix("two", (Edit(MAIN, span(TEXT, "first"), "1"), Edit(f"{FOLDER}empty.bdd", Span(0, 0), "new"))),
        ),
    )
    kept = Anchors(case.snapshot).loosened(found, MAIN, own(case))
    assert Anchors(case.snapshot).fixed(kept, MAIN, own(case)) == found
    moved = "// a line more\n" + TEXT.replace("Task", "Event (ns=t) before\nTask")
    away = AWAY.replace("Event", "Event (ns=o) before\nEvent")
    case.project.open(MAIN, 2, moved)
    case.project.open(OTHER, 2, away)
    back = Anchors(case.snapshot).fixed(kept, MAIN, own(case))
    below, elsewhere = found.related
    second, fourth = found.fixes[0].edits
    first, new = found.fixes[1].edits
    assert back == replace(
        found,
        span=span(moved, "second"),
        related=(replace(below, span=span(moved, "third")), replace(elsewhere, span=span(away, "fourth"))),
        fixes=(
            Fix("one", (replace(second, span=span(moved, "second")), replace(fourth, span=span(away, "fourth")))),
            Fix("two", (replace(first, span=span(moved, "first")), new)),
        ),
    )


def span(text: str, word: str) -> Span:
    start = text.index(word)
    return Span(start, start + len(word))


def own(case: Fixture) -> PlacedDeclaration:
    """Return the declaration of the second event."""
    file = case.snapshot.file(MAIN)
    assert file is not None
    return next(placed for placed in file.declarations if "second" in placed.declaration.text)
