"""Models that break one rule each, and what all tests of rules do with them."""

from __future__ import annotations

from kit import EVENTS, STORY, TEMPLATE, Fixture, assert_diagnostics, fixture
from robbdd_tools.base.diagnostic import Diagnostic, Fix, Severity
from robbdd_tools.features.diagnostics import fast_diagnostics

LINES = STORY[STORY.index("                var ") : STORY.index("        }\n}")]
SETS = TEMPLATE.replace("var goal\n", "var goal\n    set var goals\n").replace(
    "        in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)",
    "        ( var y exists in <goals> ) such that { in-tray: holds(<part> is located at <y>, after <end>) }",
)
"""A template with a ``set var`` beside the others."""


def story(lines: str, template: str = TEMPLATE) -> str:
    """Return a model whose only variant has these lines of a variation."""
    return EVENTS + template + STORY.replace(LINES, lines)


def marked(text: str, line: str, expected: str) -> str:
    """Put a marker below the line that holds a piece of text, with carets under what stands in ``«…»``."""
    opened, closed = line.index("«"), line.index("»") - 1
    plain = line.replace("«", "").replace("»", "")
    assert text.count(plain) == 1, plain
    start = text.index(plain)
    column = start - text.rfind("\n", 0, start) - 1 + opened
    end = text.find("\n", start)
    carets = "//".ljust(column) + "^" * (closed - opened)
    return f"{text[:end]}\n{carets} {expected}{text[end:]}"


def check(text: str) -> Fixture:
    """Check that the fast diagnostics of a fixture are the expected ones."""
    case = fixture(text)
    assert_diagnostics(fast_diagnostics(case.snapshot, case.uri), case)
    return case


def found(text: str, *codes: str) -> list[Diagnostic]:
    """Return the fast diagnostics of a fixture, those of some codes only where codes are given."""
    case = fixture(text)
    every = fast_diagnostics(case.snapshot, case.uri)
    return [entry for entry in every if not codes or entry.code in codes]


def fixed(text: str, code: str, title: str = "") -> str:
    """Apply the first fix (whose title begins so) of the first finding with a code; see what it does.

    The finding is gone afterwards and there is no error that was not there before.
    """
    case = fixture(text)
    before = fast_diagnostics(case.snapshot, case.uri)
    finding = next(entry for entry in before if entry.code == code and _fixes(entry, title))
    fix = _fixes(finding, title)[0]
    apply(case, fix)
    after = fast_diagnostics(case.snapshot, case.uri)
    assert sum(entry.code == code for entry in after) < sum(entry.code == code for entry in before), after
    assert _errors(after) <= _errors(before), after
    return text_of(case)


def _fixes(finding: Diagnostic, title: str) -> list[Fix]:
    return [fix for fix in finding.fixes if fix.title.startswith(title)]


def _errors(findings: list[Diagnostic]) -> set[tuple[str, str]]:
    return {(entry.code, entry.message) for entry in findings if entry.severity is Severity.ERROR}


def apply(case: Fixture, fix: Fix) -> None:
    """Apply the edits of a fix to the project of a fixture, as an editor would."""
    for edit in sorted(fix.edits, key=lambda edit: edit.span, reverse=True):
        text = case.project.texts()[edit.uri][1]
        case.project.open(edit.uri, 2, text[: edit.span.start] + edit.text + text[edit.span.end :])


def text_of(case: Fixture) -> str:
    """Return the present text of a fixture's first file."""
    return case.project.texts()[case.uri][1]
