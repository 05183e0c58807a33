"""The validation process: reads texts, answers with the shapes' findings. It ends when its input ends.

Frames in both directions are a length (4 bytes, big endian) and a pickled ``Request`` or ``Answer``; both ends are
the same installation.
"""

from __future__ import annotations

import pickle
import struct
import sys
from dataclasses import dataclass
from typing import BinaryIO

from robbdd_tools.base.diagnostic import Diagnostic
from robbdd_tools.features.diagnostics import shape_diagnostics
from robbdd_tools.names.project import Project

LENGTH = struct.Struct(">I")


@dataclass(frozen=True, slots=True)
class Request:
    """Validate ``uri``; ``texts`` holds the version and text of every open file."""

    revision: int
    uri: str
    texts: dict[str, tuple[int, str]]


@dataclass(frozen=True, slots=True)
class Answer:
    """The findings about a file and its imports, or what went wrong inside."""

    revision: int
    uri: str
    diagnostics: tuple[Diagnostic, ...]
    error: str = ""


def frame(message: Request | Answer) -> bytes:
    """Return a message as it is sent."""
    data = pickle.dumps(message)
    return LENGTH.pack(len(data)) + data


def main() -> None:
    """Answer requests until the input ends."""
    stdin, stdout = sys.stdin.buffer, sys.stdout.buffer
    # Whatever a library prints must not get between the frames.
    sys.stdout = sys.stderr
    project = Project()
    while (request := _read(stdin)) is not None:
        stdout.write(frame(_answer(project, request)))
        stdout.flush()


def _read(stream: BinaryIO) -> Request | None:
    head = stream.read(LENGTH.size)
    if len(head) < LENGTH.size:
        return None
    return pickle.loads(stream.read(LENGTH.unpack(head)[0]))


def _answer(project: Project, request: Request) -> Answer:
    project.replace(request.texts)
    try:
        found = shape_diagnostics(project.snapshot(), request.uri)
    except Exception as error:  # An error of ours must cost one answer, not the process.
        return Answer(request.revision, request.uri, (), f"{type(error).__name__}: {error}")
    return Answer(request.revision, request.uri, tuple(found))
