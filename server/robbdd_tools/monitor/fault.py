"""Errors in users' code, as plain data: why the evidence for a clause is missing."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Frame:
    """One call of a traceback: an absolute path, a line from 1, the function and the line's text without indent.

    ``own`` is false for a library that the user's code calls.
    """

    file: str
    line: int
    function: str = ""
    text: str = ""
    own: bool = True


@dataclass(frozen=True, slots=True)
class Fault:
    """An exception that users' code raised, or an answer that it must not give.

    ``exception`` is the type's name and ``message`` its words; ``code`` names what was called (``module:attribute`` or
    a step's sentence); ``frames`` are the calls outside of this package, outermost first. ``origin`` is the IRI of the
    behaviour, policy, tree or model that names the code, empty for steps. ``digest`` is the SHA-256 of the file that
    ``place`` is in, empty where it cannot be read.
    """

    exception: str
    message: str
    code: str
    frames: tuple[Frame, ...] = ()
    origin: str = ""
    digest: str = ""

    @property
    def place(self) -> Frame | None:
        """The innermost call in the user's own files, or in any file when none is the user's."""
        own = [frame for frame in self.frames if frame.own]
        return (own or list(self.frames) or [None])[-1]

    @property
    def id(self) -> str:
        """The same for the same error in several scenarios and processes, whatever values its message holds."""
        calls = [f"{frame.file}:{frame.line}" for frame in self.frames]
        return hashlib.sha256("\0".join((self.exception, self.code, self.origin, *calls)).encode()).hexdigest()[:12]

    @property
    def summary(self) -> str:
        """Exception and message in one line."""
        return ": ".join(part for part in (self.exception, " ".join(self.message.split())) if part)

    def traceback(self) -> Iterator[str]:
        """Yield the lines of the traceback in Python's own form, which terminals turn into links."""
        for frame in self.frames:
            within = f", in {frame.function}" if frame.function else ""
            yield f'  File "{frame.file}", line {frame.line}{within}'
            if frame.text:
                yield f"    {frame.text}"
        yield self.summary
