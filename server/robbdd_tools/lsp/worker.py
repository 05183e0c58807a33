"""The validation process: reads texts, answers with the shapes' findings. It ends when its input ends.

Frames in both directions are a length (4 bytes, big endian) and a pickled ``Request``, ``Forget`` or ``Answer``; both
ends are the same installation. A request replaces an older one for the same file, even while that is being worked on;
only the newest gets an answer.
"""

from __future__ import annotations

import pickle
import struct
import sys
import threading
from dataclasses import dataclass, field
from typing import BinaryIO

from robbdd_tools.base.diagnostic import Diagnostic
from robbdd_tools.features.diagnostics import shape_diagnostics
from robbdd_tools.graph.incremental import Superseded, Validation
from robbdd_tools.graph.user_shapes import EditorShapes
from robbdd_tools.names.project import Project

LENGTH = struct.Struct(">I")


@dataclass(frozen=True, slots=True)
class Request:
    """Validate ``uri``; ``texts`` holds the version and text of every open file, ``shapes`` what the editor adds."""

    revision: int
    uri: str
    texts: dict[str, tuple[int, str]]
    shapes: EditorShapes


@dataclass(frozen=True, slots=True)
class Forget:
    """Stop validating ``uri`` and drop what is known of it."""

    uri: str


@dataclass(frozen=True, slots=True)
class Answer:
    """The findings about a file and its imports, or what went wrong inside."""

    revision: int
    uri: str
    diagnostics: tuple[Diagnostic, ...]
    error: str = ""


def frame(message: Request | Forget | Answer) -> bytes:
    """Return a message as it is sent."""
    data = pickle.dumps(message)
    return LENGTH.pack(len(data)) + data


class Inbox:
    """The newest request of each file, in the order in which the files were first asked for.

    A thread reads while the process works, so that the work can tell that it is no longer wanted.
    """

    def __init__(self, stream: BinaryIO) -> None:
        self._stream = stream
        self._changed = threading.Condition()
        self._waiting: dict[str, Request | Forget] = {}
        self._ended = False
        threading.Thread(target=self._read, name="inbox", daemon=True).start()

    def take(self) -> Request | Forget | None:
        """Wait for something to do; ``None`` when the input has ended."""
        with self._changed:
            self._changed.wait_for(lambda: self._waiting or self._ended)
            return None if self._ended else self._waiting.pop(next(iter(self._waiting)))

    def has_news_of(self, uri: str) -> bool:
        """Tell whether work on a file has become useless."""
        return self._ended or uri in self._waiting

    def _read(self) -> None:
        while True:
            head = self._stream.read(LENGTH.size)
            body = self._stream.read(LENGTH.unpack(head)[0]) if len(head) == LENGTH.size else b""
            with self._changed:
                if body:
                    message: Request | Forget = pickle.loads(body)
                    self._waiting[message.uri] = message
                self._ended = not body
                self._changed.notify_all()
            if not body:
                return


@dataclass(slots=True)
class Worker:
    """What the process knows between two requests."""

    inbox: Inbox
    project: Project = field(default_factory=Project)
    validations: dict[str, Validation] = field(default_factory=dict[str, Validation])

    def answer(self, request: Request) -> Answer | None:
        """Return the findings about a file; ``None`` when a newer request for it has come meanwhile."""
        self.project.replace(request.texts)
        validation = self.validations.setdefault(request.uri, Validation())

        def is_superseded() -> bool:
            return self.inbox.has_news_of(request.uri)

        try:
            snapshot = self.project.snapshot()
            found = shape_diagnostics(snapshot, request.uri, request.shapes, validation, is_superseded)
        except Superseded:
            return None
        except Exception as error:  # An error of ours must cost one answer, not the process.
            del self.validations[request.uri]
            return Answer(request.revision, request.uri, (), f"{type(error).__name__}: {error}")
        return Answer(request.revision, request.uri, tuple(found))


def main() -> None:
    """Answer requests until the input ends."""
    stdout = sys.stdout.buffer
    # Whatever a library prints must not get between the frames.
    sys.stdout = sys.stderr
    worker = Worker(Inbox(sys.stdin.buffer))
    while (message := worker.inbox.take()) is not None:
        if isinstance(message, Forget):
            worker.validations.pop(message.uri, None)
        elif (answer := worker.answer(message)) is not None:
            stdout.write(frame(answer))
            stdout.flush()
