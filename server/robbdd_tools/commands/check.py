"""``robbdd check``: every finding about models and what they import."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.commands import FAILED, FINDINGS, OK
from robbdd_tools.commands.models import diagnostic_json, load, model_files, not_a_model, print_diagnostic
from robbdd_tools.commands.output import fail, print_document, print_line, print_note
from robbdd_tools.features.diagnostics import all_diagnostics


def check(paths: Sequence[Path], as_json: bool) -> int:
    """Print the findings about files and folders; returns the exit code."""
    files = model_files(paths)
    if not files:
        return fail(f"there is no model in {', '.join(map(str, paths))}")
    stranger = not_a_model(files)
    if stranger is not None:
        print_note(stranger)
        return FAILED
    snapshot, uris = load(files)
    found: dict[Diagnostic, None] = {}
    for uri in uris:
        found |= dict.fromkeys(all_diagnostics(snapshot, uri))
    for diagnostic in found:
        if as_json:
            print_document(diagnostic_json(snapshot, diagnostic) + "\n")
        else:
            print_diagnostic(snapshot, diagnostic, print_line)
    errors = sum(diagnostic.severity is Severity.ERROR for diagnostic in found)
    if not as_json:
        print_line(_summary(len(files), errors, len(found) - errors))
    if any(snapshot.unreadable(uri) for uri in uris):
        return FAILED
    return FINDINGS if errors else OK


def _summary(files: int, errors: int, others: int) -> str:
    return f"{_counted(files, 'file')}: {_counted(errors, 'error')}, {_counted(others, 'other remark')}"


def _counted(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"
