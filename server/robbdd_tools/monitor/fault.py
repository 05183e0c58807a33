"""Errors in users' code as plain data."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Frame:
    """One call in a traceback.

    It has an absolute path, a line (from 1), the function, and the text of the line without indentation. ``own`` is
    false for a call in a library that the user's code calls.
    """

    file: str
    line: int
    function: str = ""
    text: str = ""
    own: bool = True


@dataclass(frozen=True, slots=True)
class Fault:
    """An error in users' code: an exception, an invalid return value, or the end of the process in that code.

    - ``exception``: the name of the exception's type; empty without an exception.
    - ``message``: the text of the error.
    - ``code``: the called code, which is ``module:attribute`` or the sentence of a step.
    - ``frames``: the calls outside of this package, outermost first.
    - ``origin``: the IRI of the behaviour, policy, tree or model that names the code; empty for steps.
    - ``digest``: the SHA-256 of the file that contains ``place``; empty if it cannot be read.
    """

    exception: str
    message: str
    code: str
    frames: tuple[Frame, ...] = ()
    origin: str = ""
    digest: str = ""

    @property
    def place(self) -> Frame | None:
        """The innermost call in the user's own files; if there is none, the innermost call in any file."""
        own = [frame for frame in self.frames if frame.own]
        return (own or list(self.frames) or [None])[-1]

    @property
    def id(self) -> str:
        """The identifier of the error.

        It is equal in all scenarios and processes, and does not depend on values in the message.
        """
        calls = [f"{frame.file}:{frame.line}" for frame in self.frames]
        return hashlib.sha256("\0".join((self.exception, self.code, self.origin, *calls)).encode()).hexdigest()[:12]

    @property
    def summary(self) -> str:
        """The exception and the message in one line."""
        return ": ".join(part for part in (self.exception, " ".join(self.message.split())) if part)

    @property
    def words(self) -> str:
        """The message, the type and the place of the error in one line."""
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
