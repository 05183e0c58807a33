"""Messages between the server and the validation process.

A frame is a length (4 bytes, big endian) and a pickled object: to the process a tuple of ``Request`` and ``Forget``, in
which a shared text is stored once; from it a ``Begun`` or an ``Answer``. Both ends are the same installation. A request
replaces an older one for the same file, even during its validation, but only a limited number of times.
"""

from __future__ import annotations

import pickle
import struct
from dataclasses import dataclass, field

from robbdd_tools.base.diagnostic import Diagnostic
from robbdd_tools.base.document import Document
from robbdd_tools.graph.shapes.project_shapes import EditorShapes

LENGTH = struct.Struct(">I")


@dataclass(frozen=True, slots=True)
class Request:
    """Validate ``uri``; ``texts`` holds version and text of every open file, ``shapes`` the shapes added by the editor.

    An unopened file is ``surveyed``: all findings are wanted, with the texts that contain them. Its ``importers`` are
    the files that import it, open or not; without them, declarations used only there would seem unused.
    """

    revision: int
    uri: str
    texts: dict[str, tuple[int, str]]
    shapes: EditorShapes
    surveyed: bool = False
    importers: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Forget:
    """Stop validating ``uri`` and drop its state."""

    uri: str


@dataclass(frozen=True, slots=True)
class Begun:
    """The process is now working on ``uri``, until it answers or begins another file (empty: it is idle)."""

    uri: str


@dataclass(frozen=True, slots=True)
class Answer:
    """The findings about a file and its imports, or the internal error.

    For a surveyed file also the files ``reached``, found or missing, and the ``documents`` that the findings refer to.
    """

    revision: int
    uri: str
    diagnostics: tuple[Diagnostic, ...]
    error: str = ""
    reached: frozenset[str] = frozenset()
    documents: dict[str, Document] = field(default_factory=dict[str, Document])


def frame(content: tuple[Request | Forget, ...] | Begun | Answer) -> bytes:
    """Return messages as one frame."""
    data = pickle.dumps(content)
    return LENGTH.pack(len(data)) + data
