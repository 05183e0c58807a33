"""Exchange MessagePack messages with an external system under test: a process, or an endpoint on a WebSocket."""

from __future__ import annotations

import os
import subprocess
import sys
from collections import deque
from contextlib import ExitStack, suppress
from importlib import import_module
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Thread
from typing import IO, Any, Protocol, cast

from robbdd_tools.base.external_systems import command_words
from robbdd_tools.base.interpreter import inherited_paths
from robbdd_tools.base.isolation import NO_USER_CODE, SEARCHED
from robbdd_tools.base.printable import encodable

MOST_BYTES = 1 << 20
"""Maximum size of a message in bytes."""
ENDING = 0.5
"""A process that is no longer needed may end by itself within this time (s)."""
PYTHON = "python"
"""As the program of a command line, this means the interpreter that executes RobBDD, with its packages."""
INSTALL = "install robbdd-tools[external]"


class SystemFailed(Exception):
    """The system does not run, does not answer in time, or answers with invalid data; the message gives the reason."""


class SystemLink(Protocol):
    """A connection to an external system. Messages are maps with text keys."""

    def send(self, message: dict[str, Any]) -> None:
        """Send a message. Raises ``SystemFailed``."""
        ...

    def receive(self, seconds: float) -> dict[str, Any]:
        """Return the next message. Raises ``SystemFailed`` if none arrives within ``seconds``."""
        ...

    def close(self) -> None:
        """End the connection, and the process if there is one."""
        ...


def open_link(kind: str, name: str, folder: Path | None, seconds: float) -> SystemLink:
    """Start the process, or connect to the endpoint, of an implementation. Raises ``SystemFailed``.

    ``folder`` is the working directory of the process, ``seconds`` the limit for connecting.
    """
    if os.environ.get(NO_USER_CODE):
        raise SystemFailed("is not used, as users' code is not run")
    if kind == "process":
        return ProcessLink(name, folder)
    return EndpointLink(name, seconds)


class ProcessLink(SystemLink):
    """A process that reads messages from its standard input and writes its answers to its standard output.

    Its standard error is copied to the log of the agent.
    """

    def __init__(self, command: str, folder: Path | None) -> None:
        self._codec = _library("msgpack")
        environment = dict(os.environ)
        if inherited_paths():
            environment[SEARCHED] = os.pathsep.join(inherited_paths())
        words = command_words(command)
        if words[:1] == [PYTHON]:
            words[0] = sys.executable
        try:
            self._process = subprocess.Popen(
                words,
                cwd=folder,
                env=environment,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
            )
        except (OSError, ValueError, IndexError) as error:
            raise SystemFailed(f"cannot be started: {getattr(error, 'strerror', None) or error}") from None
        self._answers: SimpleQueue[Any] = SimpleQueue()
        self._errors: deque[str] = deque(maxlen=20)
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        assert self._process.stderr is not None
        self._input: IO[bytes] = self._process.stdin
        self._reader = Thread(target=self._read, args=(self._process.stdout,), daemon=True)
        self._logger = Thread(target=self._log, args=(self._process.stderr,), daemon=True)
        self._reader.start()
        self._logger.start()

    def send(self, message: dict[str, Any]) -> None:
        """Send a message."""
        try:
            self._input.write(self._codec.packb(message))
            self._input.flush()
        except OSError:
            raise SystemFailed(self._ending()) from None

    def receive(self, seconds: float) -> dict[str, Any]:
        """Return the next message."""
        try:
            answer = self._answers.get(timeout=seconds)
        except Empty:
            raise SystemFailed(_late(seconds)) from None
        if answer is None:
            raise SystemFailed(self._ending())
        if isinstance(answer, Exception):
            raise SystemFailed(f"{_not_a_message(answer)}: nothing else may be printed to standard output")
        return _checked(answer)

    def close(self) -> None:
        """Close the input of the process, and end it if it does not end by itself."""
        with suppress(OSError):
            self._input.close()
        try:
            self._process.wait(ENDING)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def _read(self, stream: IO[bytes]) -> None:
        unpacker = self._codec.Unpacker(max_buffer_size=MOST_BYTES)
        try:
            while chunk := os.read(stream.fileno(), 65536):
                unpacker.feed(chunk)
                for message in unpacker:
                    self._answers.put(message)
        except Exception as error:  # an answer of any content must not end the thread silently
            self._answers.put(error)
        self._answers.put(None)

    def _log(self, stream: IO[bytes]) -> None:
        for line in stream:
            text = encodable(line.decode("utf-8", "replace").rstrip())
            self._errors.append(text)
            print(text, file=sys.stderr, flush=True)

    def _ending(self) -> str:
        try:
            code = self._process.wait(ENDING)
        except subprocess.TimeoutExpired:
            return "closed its input or output"
        self._logger.join(ENDING)
        last = next((line for line in reversed(self._errors) if line.strip()), "")
        how = f"was ended by signal {-code}" if code < 0 else f"ended with exit code {code}"
        return f"{how}: {last.strip()[:200]}" if last else how


class EndpointLink(SystemLink):
    """A server of a WebSocket. Each message is one binary frame."""

    def __init__(self, address: str, seconds: float) -> None:
        self._codec = _library("msgpack")
        self._opened = ExitStack()
        client = _library("websockets.sync.client")
        try:
            connecting = client.connect(address, open_timeout=seconds, compression=None, max_size=MOST_BYTES)
            self._socket: Any = self._opened.enter_context(connecting)
        except Exception as error:  # the library documents errors of several unrelated types
            raise SystemFailed(f"cannot be reached: {_words(error)}") from None

    def send(self, message: dict[str, Any]) -> None:
        """Send a message."""
        try:
            self._socket.send(self._codec.packb(message))
        except Exception as error:  # see above
            raise SystemFailed(f"closed the connection: {_words(error)}") from None

    def receive(self, seconds: float) -> dict[str, Any]:
        """Return the next message."""
        try:
            frame = self._socket.recv(timeout=seconds)
        except TimeoutError:
            raise SystemFailed(_late(seconds)) from None
        except Exception as error:  # see above
            raise SystemFailed(f"closed the connection: {_words(error)}") from None
        try:
            if not isinstance(frame, bytes):
                raise TypeError("a text frame")
            return _checked(self._codec.unpackb(frame))
        except SystemFailed:
            raise
        except Exception as error:  # a frame of any content
            raise SystemFailed(_not_a_message(error)) from None

    def close(self) -> None:
        """Close the connection."""
        self._opened.close()


def _library(name: str) -> Any:
    try:
        return import_module(name)
    except ImportError:
        raise SystemFailed(f"needs {name.partition('.')[0]}: {INSTALL}") from None


def _checked(message: Any) -> dict[str, Any]:
    if not isinstance(message, dict):
        raise SystemFailed(f"sent {message!r:.60} instead of a map")
    # The keys are checked where they are read.
    return cast("dict[str, Any]", message)


def _late(seconds: float) -> str:
    return f"did not answer within {seconds:g} s"


def _not_a_message(error: Exception) -> str:
    return f"sent something that is not MessagePack ({type(error).__name__})"


def _words(error: Exception) -> str:
    return " ".join(str(error).split())[:200] or type(error).__name__
