"""The validation process. It reads texts and answers with the findings of the shapes until its input ends."""

from __future__ import annotations

import pickle
import sys
import threading
from dataclasses import dataclass, field
from typing import BinaryIO, Generic, Protocol, TypeVar

from robbdd_tools.base.document import Document
from robbdd_tools.base.files import read_text, uri_to_path
from robbdd_tools.base.memory import collect_rarely, collect_recent
from robbdd_tools.base.processes import lower_priority
from robbdd_tools.base.source_texts import use_unsaved
from robbdd_tools.campaign.edited_study import study_diagnostics
from robbdd_tools.features.diagnostics import fast_diagnostics, shape_diagnostics
from robbdd_tools.features.outside_files import outside_uris
from robbdd_tools.features.studies import is_study
from robbdd_tools.graph.shapes.incremental import Superseded, Validation
from robbdd_tools.lsp.framing import LENGTH, Answer, Begun, Forget, Request, frame
from robbdd_tools.names.project import Project, Snapshot
from robbdd_tools.workbench.log_findings import log_findings
from robbdd_tools.workbench.scene_findings import SceneChecker


class AboutFile(Protocol):
    """A message about one file."""

    @property
    def uri(self) -> str:
        """The file."""
        ...


Message = TypeVar("Message", bound=AboutFile)
MAX_LEFT = 8
"""After this many validations of a file in a row were abandoned for newer ones, one finishes even during typing."""


class Inbox(Generic[Message]):
    """The latest message about each file, in the order in which the files were first mentioned.

    A thread reads the input while a message is worked on, so that the work can detect that it is outdated.
    """

    def __init__(self, stream: BinaryIO) -> None:
        self._stream = stream
        self._changed = threading.Condition()
        self._waiting: dict[str, Message] = {}
        self._ended = False
        threading.Thread(target=self._read, name="inbox", daemon=True).start()

    def take(self) -> Message | None:
        """Wait for a message and return it; return ``None`` at the end of the input."""
        with self._changed:
            self._changed.wait_for(lambda: self._waiting or self._ended)
            return None if self._ended else self._waiting.pop(next(iter(self._waiting)))

    def has_newer(self, uri: str) -> bool:
        """Return whether the work on a file is outdated, because a newer message is waiting or the input has ended."""
        return self._ended or uri in self._waiting

    def _read(self) -> None:
        while True:
            head = self._stream.read(LENGTH.size)
            body = self._stream.read(LENGTH.unpack(head)[0]) if len(head) == LENGTH.size else b""
            with self._changed:
                if body:
                    messages: tuple[Message, ...] = pickle.loads(body)
                    self._waiting |= {message.uri: message for message in messages}
                self._ended = not body
                self._changed.notify_all()
            if not body:
                return


@dataclass(slots=True)
class Worker:
    """The state of the process between two requests."""

    inbox: Inbox[Request | Forget]
    project: Project = field(default_factory=Project)
    validations: dict[str, Validation] = field(default_factory=dict[str, Validation])
    left: dict[str, int] = field(default_factory=dict[str, int])
    """Number of abandoned validations in a row, by file."""
    scenes: SceneChecker = field(default_factory=SceneChecker)

    def forget(self, uri: str) -> None:
        """Drop the state of a file."""
        self.validations.pop(uri, None)
        self.left.pop(uri, None)

    def answer(self, request: Request) -> Answer | None:
        """Return the findings about a file, or ``None`` if the work was abandoned because of a newer request."""
        self.project.replace(request.texts)
        use_unsaved(request.sources)
        if request.surveyed:
            return self._survey(request)
        validation = self.validations.setdefault(request.uri, Validation())
        left = self.left.pop(request.uri, 0)

        def is_superseded() -> bool:
            return left < MAX_LEFT and self.inbox.has_newer(request.uri)

        try:
            snapshot = self.project.snapshot()
            if is_study(request.uri):
                found = study_diagnostics(self.project, request.uri)
            else:
                found = shape_diagnostics(snapshot, request.uri, request.shapes, validation, is_superseded)
                found += [] if is_superseded() else self.scenes.findings(snapshot, request.uri)
                found += [] if is_superseded() else log_findings(snapshot, request.uri)
        except Superseded:
            self.left[request.uri] = left + 1
            return None
        except Exception as error:  # An internal error must cost one answer, not the process.
            del self.validations[request.uri]
            return Answer(request.revision, request.uri, (), f"{type(error).__name__}: {error}")
        return Answer(request.revision, request.uri, tuple(found))

    def _survey(self, request: Request) -> Answer:
        """Return all findings about an unopened file and the files that form a cycle of imports with it."""
        for uri in (request.uri, *request.importers):
            self.project.load(uri)
        snapshot = self.project.snapshot()
        together = snapshot.reachability.cycle(request.uri)
        try:
            found = [entry for uri in together for entry in fast_diagnostics(snapshot, uri)]
            if is_study(request.uri):
                found += study_diagnostics(self.project, request.uri)
            else:
                found += shape_diagnostics(snapshot, request.uri, request.shapes, together=together)
            found += [entry for uri in together for entry in self.scenes.findings(snapshot, uri)]
            found += [entry for uri in together for entry in log_findings(snapshot, uri)]
        except Exception as error:  # As above.
            return Answer(request.revision, request.uri, (), f"{type(error).__name__}: {error}", together)
        named = {entry.uri for entry in found} | {place.uri for entry in found for place in entry.related}
        documents = {uri: _document(snapshot, uri) for uri in named}
        outside = {uri: outside_uris(snapshot, uri) for uri in together}
        reached = frozenset((*snapshot.reachability.walk(request.uri), *snapshot.importers(request.uri)))
        findings = tuple(dict.fromkeys(found))
        return Answer(request.revision, request.uri, findings, "", together, reached, documents, outside)


def _document(snapshot: Snapshot, uri: str) -> Document:
    """Return the document of a file. A file that is not a model, such as a configuration, is read from disk."""
    path = None if uri in snapshot.sources else uri_to_path(uri)
    text = None if path is None else read_text(path)
    return Document(uri, 0, text) if isinstance(text, str) else snapshot.document(uri)


def main(in_passing: bool = False) -> None:
    """Answer requests until the input ends. If ``in_passing`` is true, the process has low priority."""
    if in_passing:
        lower_priority()
    stdout = sys.stdout.buffer
    # Output of libraries must not get between the frames.
    sys.stdout = sys.stderr
    collect_rarely()
    inbox: Inbox[Request | Forget] = Inbox(sys.stdin.buffer)
    worker = Worker(inbox)

    def tell(message: Begun | Answer) -> None:
        stdout.write(frame(message))
        stdout.flush()

    while (message := worker.inbox.take()) is not None:
        if isinstance(message, Forget):
            worker.forget(message.uri)
            continue
        tell(Begun(message.uri))
        tell(worker.answer(message) or Begun(""))
        collect_recent()
