"""Errors in users' code as plain data."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Frame:
    """One call of a traceback: an absolute path, a line from 1, the function and the line's text without indentation.

    ``own`` is false for a library called by the user's code.
    """

    file: str
    line: int
    function: str = ""
    text: str = ""
    own: bool = True


@dataclass(frozen=True, slots=True)
class Fault:
    """An exception raised by users' code, an invalid return value, or the end of the process in it.

    ``exception`` is the type's name, empty without an exception, and ``message`` its text; ``code`` is the called
    code (``module:attribute`` or a step's sentence); ``frames`` are the calls outside of this package, outermost
    first. ``origin`` is the IRI of the behaviour, policy, tree or model that names the code, empty for steps.
    ``digest`` is the SHA-256 of the file that ``place`` is in, empty if it cannot be read.
    """

    exception: str
    message: str
    code: str
    frames: tuple[Frame, ...] = ()
    origin: str = ""
    digest: str = ""

    @property
    def place(self) -> Frame | None:
        """The innermost call in the user's own files, or in any file if none is the user's."""
        own = [frame for frame in self.frames if frame.own]
        return (own or list(self.frames) or [None])[-1]

    @property
    def id(self) -> str:
        """Identifier of an error: equal across scenarios and processes, whatever values its message contains."""
        calls = [f"{frame.file}:{frame.line}" for frame in self.frames]
        return hashlib.sha256("\0".join((self.exception, self.code, self.origin, *calls)).encode()).hexdigest()[:12]

    @property
    def summary(self) -> str:
        """Exception and message in one line."""
        return ": ".join(part for part in (self.exception, " ".join(self.message.split())) if part)

    @property
    def words(self) -> str:
        """The failure, its type and its place in one line."""
        place = self.place
        where = "" if place is None else f" ({place.file}:{place.line})"
        return f"{self.code} failed: {self.summary}{where}"

    def traceback(self) -> Iterator[str]:
        """Yield the lines of the traceback in Python's format, which terminals turn into links."""
        for frame in self.frames:
            within = f", in {frame.function}" if frame.function else ""
            yield f'  File "{frame.file}", line {frame.line}{within}'
            if frame.text:
                yield f"    {frame.text}"
        yield self.summary
