"""Models that break one rule each, and what all tests of rules do with them."""

from __future__ import annotations

from kit import EVENTS, STORY, TEMPLATE, Fixture, assert_diagnostics, fixture
from robbdd_tools.base.diagnostic import Diagnostic, Fix, Severity
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.features.fixes_on_demand import fixes_on_demand

LINES = STORY[STORY.index("                var ") : STORY.index("        }\n}")]
SETS = TEMPLATE.replace("var goal\n", "var goal\n    set var goals\n").replace(
    "        in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)",
    "        ( var y exists in <goals> ) such that { in-tray: holds(<part> is located at <y>, after <end>) }",
)
"""A template with an additional ``set var``."""


def story(lines: str, template: str = TEMPLATE) -> str:
    """Return a model whose only variant has these lines of a variation."""
    return EVENTS + template + STORY.replace(LINES, lines)


def marked(text: str, line: str, expected: str) -> str:
    """Put a marker below the line with a piece of text, with carets under the part in ``«…»``."""
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
    """Apply the first fix (with this beginning of its title) of the first finding with a code; return the result.

    The finding is gone afterwards and there is no new error.
    """
    case = fixture(text)
    before = fast_diagnostics(case.snapshot, case.uri)
    offered = (fix for entry in before if entry.code == code for fix in fixes_of(case, entry))
    fix = next(fix for fix in offered if fix.title.startswith(title))
    apply(case, fix)
    after = fast_diagnostics(case.snapshot, case.uri)
    assert sum(entry.code == code for entry in after) < sum(entry.code == code for entry in before), after
    assert _errors(after) <= _errors(before), after
    return text_of(case)


def _errors(findings: list[Diagnostic]) -> set[tuple[str, str]]:
    return {(entry.code, entry.message) for entry in findings if entry.severity is Severity.ERROR}


def fixes_of(case: Fixture, finding: Diagnostic) -> tuple[Fix, ...]:
    """Return all fixes of a finding, as an editor is offered them."""
    return (*finding.fixes, *fixes_on_demand(case.snapshot, finding.uri, finding))


def apply(case: Fixture, fix: Fix) -> None:
    """Make the file and apply the edits of a fix to the project of a fixture, as an editor would."""
    if fix.new_file is not None:
        case.project.open(fix.new_file.uri, 1, fix.new_file.text)
    for edit in sorted(fix.edits, key=lambda edit: edit.span, reverse=True):
        text = case.project.texts()[edit.uri][1]
        case.project.open(edit.uri, 2, text[: edit.span.start] + edit.text + text[edit.span.end :])


def text_of(case: Fixture) -> str:
    """Return the present text of a fixture's first file."""
    return case.project.texts()[case.uri][1]
