"""How scenes and behaviours are executed, as plain data: what a ``.scenex`` and a ``.bddx`` say.

Names are IRIs where the graph is read and CURIEs in a run. Python code is named ``module:attribute``; nothing here
imports it.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Origin:
    """Where something is written: a file (an absolute path), line and column, both from 1.

    Paths that a model names are relative to the file's folder, and user code may lie there.
    """

    file: str
    line: int
    column: int

    def __str__(self) -> str:
        """Return ``file:line:column`` as messages have it."""
        return f"{self.file}:{self.line}:{self.column}"


@dataclass(frozen=True, slots=True)
class Implementation:
    """What executes a behaviour: ``kind`` is ``catalog``, ``python`` or ``ros-action``; ``name`` says which.

    ``origin`` is where that is written, ``None`` for a graph without source text.
    """

    iri: str
    kind: str
    name: str
    origin: Origin | None = None
