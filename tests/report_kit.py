"""Everything that is reported of a model, as text: places, messages, related places and what each fix changes.

A message that is improved changes the reports: write them anew (``ACCEPT``) and read what changed.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Iterator
from pathlib import Path

from checks.models import fixes_of
from kit import FOLDER, Fixture, fixture
from robbdd_tools.base.diagnostic import Diagnostic, Fix
from robbdd_tools.base.document import Document, Span
from robbdd_tools.features.diagnostics import fast_diagnostics

HEADING = "//== reported\n"
"""Begins the expected report below the text of a fixture."""
ACCEPT = "ROBBDD_ACCEPT"
"""Environment variable: when set, the reports are written anew; read what changed before you commit it."""
MOST_FIXES = 2
"""Fixes of a finding that are shown: there may be one for each word of the catalog."""
_WORDS = re.compile(r"(?<=none of the words )[^;]*")
"""The words of the catalog's models, in the message on an element without a model."""


def check_report(path: Path, report: Callable[[Fixture], Iterator[str]] | None = None) -> None:
    """Compare a report on a model, by default that of its findings, with what stands below the model in its file."""
    text, _, expected = path.read_text(encoding="utf-8").partition(HEADING)
    found = "".join(f"{line}\n" for line in (report or reported)(fixture(text)))
    if ACCEPT in os.environ:
        path.write_text(text + HEADING + found, encoding="utf-8", newline="\n")
    assert found == expected or ACCEPT in os.environ


def reported(case: Fixture) -> Iterator[str]:
    """Yield the report on all files of a fixture, in the order of their names."""
    for uri in sorted(case.project.texts()):
        for entry in fast_diagnostics(case.snapshot, uri):
            yield from _finding(case, entry)


def _finding(case: Fixture, entry: Diagnostic) -> Iterator[str]:
    yield heading(case, entry)
    yield f"  {message_of(entry)}"
    for related in entry.related:
        yield f"  see {place(case, related.uri, related.span)} {related.message}"
    for fix in fixes_of(case, entry)[:MOST_FIXES]:
        yield f"  fix {fix.title}: {' and '.join(_changes(case, fix))}"


def heading(case: Fixture, entry: Diagnostic) -> str:
    """Return code, severity and place of a finding."""
    return f"{entry.code} {entry.severity.name.lower()} {place(case, entry.uri, entry.span)}"


def message_of(entry: Diagnostic) -> str:
    """Return the message of a finding; without the words that the catalog happens to have."""
    return _WORDS.sub("…", entry.message)


def _changes(case: Fixture, fix: Fix) -> Iterator[str]:
    if fix.new_file is not None:
        yield f"new {fix.new_file.uri.removeprefix(FOLDER)} {json.dumps(fix.new_file.text, ensure_ascii=False)}"
    for edit in fix.edits:
        yield f"{place(case, edit.uri, edit.span)} -> {json.dumps(edit.text, ensure_ascii=False)}"


def place(case: Fixture, uri: str, span: Span) -> str:
    """Return file, line, column and text of a span."""
    text = case.project.texts()[uri][1] if uri in case.project.texts() else ""
    at = Document(uri, 0, text).position(span.start)
    placed = json.dumps(text[span.start : span.end], ensure_ascii=False)
    return f"{uri.removeprefix(FOLDER)}:{at.line + 1}:{at.column + 1} {placed}"
