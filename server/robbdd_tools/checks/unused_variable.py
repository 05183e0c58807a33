"""``unused-variable``: no clause uses a variable, so varying it only repeats scenarios."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Fix, Severity
from robbdd_tools.base.removals import removal
from robbdd_tools.checks.facts import facts_of
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot

CODE = "unused-variable"


def unused_variable(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report unused variables of templates and quantifiers. If scenarios give them values, the report is a warning."""
    uri = file.document.uri
    candidates: list[tuple[tree.Template, tree.Variable, Span, Span]] = []
    for placed in file.parts():
        facts = facts_of(placed.declaration)
        for bound in facts.unused_bounds:
            message = f"no clause uses '{bound.variable.text}': use it, or remove the quantifier"
            yield Diagnostic(uri, bound.variable.span.shifted(placed.offset), Severity.HINT, CODE, message)
        root = placed.declaration.tree
        if facts.unused and isinstance(root, tree.Template):
            candidates += [
                (root, variable, variable.name.span.shifted(placed.offset), variable.span.shifted(placed.offset))
                for variable in facts.unused
            ]
    if not candidates:
        return
    spoken_of, assigned = _used_by_stories(file)
    candidates = [entry for entry in candidates if _path(*entry[:2]) not in spoken_of]
    if candidates and not snapshot.is_imported(uri):
        for template, variable, span, extent in candidates:
            has_values = _path(template, variable) in assigned
            message = f"no clause uses '{variable.name.text}': use it in a clause, or remove it"
            fixes: tuple[Fix, ...] = ()
            if not has_values:
                fixes = (removal(file.document, f"Remove the variable '{variable.name.text}'", extent),)
            severity = Severity.WARNING if has_values else Severity.HINT
            yield Diagnostic(uri, span, severity, CODE, message, fixes=fixes)


def _path(template: tree.Template, variable: tree.Variable) -> str:
    return f"{template.name.text}.{variable.name.text}"


def _used_by_stories(file: FileAnalysis) -> tuple[set[str], set[str]]:
    """Return the variables in the clauses of variants, and all other variables that variants name."""
    spoken_of: set[str] = set()
    named: set[str] = set()
    for placed in file.of(tree.Story):
        spoken_of |= facts_of(placed.declaration).clause_paths
        named |= {reference.ref.path for reference in placed.declaration.references}
    return spoken_of, named
