"""The messages between the server and the validation process.

A frame consists of a length (4 bytes, big endian) and a pickled object. The server sends tuples of ``Request`` and
``Forget``, in which a shared text is stored once. The process sends ``Begun`` and ``Answer``. Both ends belong to the
same installation. A request replaces an older one for the same file, even while that is being validated, but only a
limited number of times.
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
    """A request to validate the file ``uri``.

    - ``texts``: the version and the text of every open file.
    - ``shapes``: the shapes that the editor adds.
    - ``surveyed``: true for an unopened file. All its findings are wanted, with the texts that contain them.
    - ``importers``: the files that import it, open or not. Without them, declarations that only they use would be
      reported as unused.
    """

    revision: int
    uri: str
    texts: dict[str, tuple[int, str]]
    shapes: EditorShapes
    surveyed: bool = False
    importers: tuple[str, ...] = ()


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
    ``documents`` are the texts to which the findings refer.
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
