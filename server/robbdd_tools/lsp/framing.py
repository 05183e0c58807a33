"""What the server and the validation process say to each other.

A frame is a length (4 bytes, big endian) and something pickled: towards the process a tuple of ``Request`` and
``Forget``, in which a text stands once however many of them name it; from it a ``Begun`` or an ``Answer``. Both ends
are the same installation. A request replaces an older one for the same file, even while that is being worked on, but
not endlessly.
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
    """Validate ``uri``; ``texts`` holds the version and text of every open file, ``shapes`` what the editor adds.

    A file that is not open is ``surveyed``: all findings are wanted, with the texts that they stand in. Its
    ``importers`` are the files that build on it, open or not, without which what only they use would seem unused.
    """

    revision: int
    uri: str
    texts: dict[str, tuple[int, str]]
    shapes: EditorShapes
    surveyed: bool = False
    importers: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Forget:
    """Stop validating ``uri`` and drop what is known of it."""

    uri: str


@dataclass(frozen=True, slots=True)
class Begun:
    """The process works on ``uri`` from now on, until it answers or begins something else (``""``: it waits)."""

    uri: str


@dataclass(frozen=True, slots=True)
class Answer:
    """The findings about a file and its imports, or what went wrong inside.

    Of a surveyed file also the files that were ``reached``, looked at or missed, and the ``documents`` that the
    findings name.
    """

    revision: int
    uri: str
    diagnostics: tuple[Diagnostic, ...]
    error: str = ""
    reached: frozenset[str] = frozenset()
    documents: dict[str, Document] = field(default_factory=dict[str, Document])


def frame(content: tuple[Request | Forget, ...] | Begun | Answer) -> bytes:
    """Return messages as they are sent."""
    data = pickle.dumps(content)
    return LENGTH.pack(len(data)) + data
