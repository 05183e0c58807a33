"""``unverified-requirement``: no scenario verifies a requirement."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.checks.usage import has_story
from robbdd_tools.names.requirement_links import key_of, requirements_of, verifiers

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot


def unverified_requirement(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report each unverified requirement in a file that has scenarios or that a file with scenarios imports."""
    requirements = requirements_of(file)
    if not requirements:
        return
    importers = (snapshot.file(uri) for uri in snapshot.importers(file.document.uri))
    if not has_story(file) and not any(other is not None and has_story(other) for other in importers):
        return
    found = verifiers(snapshot, requirements)
    for one in requirements:
        if not found[key_of(one)]:
            name = one.symbol.path
            message = (
                f"no scenario verifies the requirement '{name}': write 'verifies: <{name}>' in a user story, "
                f"a scenario or its template, or 'verifies <{name}>' after a clause"
            )
            yield Diagnostic(file.document.uri, one.span, Severity.WARNING, "unverified-requirement", message)
