"""``external-system``: a process has no program, an endpoint has no address, or a time limit is out of range."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.external_systems import command_words, endpoint_host
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot

CODE = "external-system"
MOST_SECONDS = 3600.0
"""Maximum value (s) of the time within which a system must answer."""


def external_system(_: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report external systems that cannot be started or reached."""
    for placed in file.declarations:
        root = placed.declaration.tree
        if isinstance(root, tree.Implementation) and not placed.declaration.faults:
            for node, message in _faults(root.source):
                span = node.span.shifted(placed.offset)
                yield Diagnostic(file.document.uri, span, Severity.ERROR, CODE, message)


def system_fault(kind: str, name: str) -> str:
    """Return the fault of a process's command line or of an endpoint's address; empty if there is none."""
    if kind == "process" and not command_words(name):
        return (
            'a process needs a command line with closed quotes: write a program and its arguments, such as "./policy"'
        )
    if kind == "endpoint" and not endpoint_host(name):
        return f'\'{name}\' is not the address of an endpoint: write "ws://HOST:PORT" or "wss://HOST:PORT"'
    return ""


def _faults(source: tree.Node) -> Iterator[tuple[tree.Node, str]]:
    match source:
        case tree.ProcessSystem(command=name, limit=limit):
            problem = system_fault("process", name.value)
        case tree.EndpointSystem(address=name, limit=limit):
            problem = system_fault("endpoint", name.value)
        case _:
            return
    if problem:
        yield name, problem
    if limit is not None and not 0.0 < float(limit.value) <= MOST_SECONDS:
        yield (
            limit,
            f"a system answers within more than 0 s and at most {MOST_SECONDS:g} s, not {float(limit.value):g} s",
        )
