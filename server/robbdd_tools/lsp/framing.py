"""The messages between the server and its processes: the validation process, and the one that re-judges edits.

A frame consists of a length (4 bytes, big endian) and a pickled object. The server sends tuples of ``Request`` and
``Forget``, in which a shared text is stored once. The process sends ``Begun`` and ``Answer``. Both ends belong to the
same installation. A request replaces an older one for the same file, even during the validation, but only a limited
number of times. The server sends ``Edited`` to the other process, which answers with ``Rejudged``.
"""

from __future__ import annotations

import pickle
import struct
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from robbdd_tools.base.diagnostic import Diagnostic
from robbdd_tools.base.document import Document
from robbdd_tools.features.run_verdicts import RejudgedExecution
from robbdd_tools.graph.shapes.project_shapes import EditorShapes

LENGTH = struct.Struct(">I")


@dataclass(frozen=True, slots=True)
class Request:
    """A request to validate the file ``uri``.

    - ``texts``: the version and the text of every open file.
    - ``shapes``: the shapes that the editor adds.
    - ``surveyed``: true for an unopened file. All its findings are wanted, with the texts that contain them.
    - ``importers``: the files that import it, open or not. Without them, declarations that only they use would be
      reported as unused.
    - ``sources``: the unsaved texts of other files, such as Python code and descriptions of robots.
    """

    revision: int
    uri: str
    texts: dict[str, tuple[int, str]]
    shapes: EditorShapes
    surveyed: bool = False
    importers: tuple[str, ...] = ()
    sources: Mapping[Path, str] = field(default_factory=dict[Path, str])


@dataclass(frozen=True, slots=True)
class Forget:
    """A request to stop validating ``uri`` and to drop its state."""

    uri: str


@dataclass(frozen=True, slots=True)
class Begun:
    """The process has begun to work on ``uri``, and continues until it answers or begins another file.

    If ``uri`` is empty, the process is idle.
    """

    uri: str


@dataclass(frozen=True, slots=True)
class Answer:
    """The findings about a file and its imports, or the internal error that prevented them.

    For a surveyed file, ``reached`` are the files that it imports, found or missing, and the files that import it.
    ``together`` are the file and the files that both import it and are imported by it; the findings are about all of
    these. ``documents`` are the texts to which the findings refer. ``named`` maps each file of ``together`` to the
    files that it names and that are not models, such as Python code.
    """

    revision: int
    uri: str
    diagnostics: tuple[Diagnostic, ...]
    error: str = ""
    together: tuple[str, ...] = ()
    reached: frozenset[str] = frozenset()
    documents: dict[str, Document] = field(default_factory=dict[str, Document])
    named: Mapping[str, frozenset[str]] = field(default_factory=dict[str, frozenset[str]])


Execution = tuple[int, int]
"""The number of a stored run, and of an execution in it."""


@dataclass(frozen=True, slots=True)
class Edited:
    """The texts of the open files after an edit that concerns the model ``uri``.

    - ``store``: the folder of the model's stored runs.
    - ``executions``: the numbers of the shown executions, for each run.
    - ``sources``: the unsaved texts of other files, such as steps.
    """

    revision: int
    uri: str
    texts: Mapping[str, tuple[int, str]]
    store: str
    executions: Mapping[int, tuple[int, ...]]
    sources: Mapping[Path, str] = field(default_factory=dict[Path, str])


@dataclass(frozen=True, slots=True)
class Rejudged:
    """Executions of a model whose clauses were re-judged, or that cannot be re-judged.

    - ``executions``: results by run and number of the execution.
    - ``total``: the number of executions that the edits concern. ``done``: how many of them have been answered.
    - ``problem``: why nothing was judged.
    """

    revision: int
    uri: str
    executions: Mapping[Execution, RejudgedExecution]
    done: int
    total: int
    problem: str = ""

    @property
    def is_last(self) -> bool:
        """Whether this is the last message about the revision."""
        return bool(self.problem) or self.done == self.total


def frame(content: object) -> bytes:
    """Return a message, or a tuple of messages, as one frame."""
    data = pickle.dumps(content)
    return LENGTH.pack(len(data)) + data
