"""A minimal client of a language server in a separate process, which records the arrival time of each message."""

from __future__ import annotations

import json
import os
import subprocess
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import IO, Any, Self

PATIENCE = 60.0
"""Seconds after which a server is taken for dead."""
Message = dict[str, Any]
CAPABILITIES: Mapping[str, Any] = {
    "general": {"positionEncodings": ["utf-16"]},
    "window": {"workDoneProgress": True},
    "workspace": {"inlayHint": {"refreshSupport": True}, "codeLens": {"refreshSupport": True}},
    "textDocument": {
        "completion": {"completionItem": {"snippetSupport": True, "insertReplaceSupport": True}},
        "hover": {"contentFormat": ["markdown"]},
        "documentSymbol": {"hierarchicalDocumentSymbolSupport": True},
        "publishDiagnostics": {"versionSupport": True, "relatedInformation": True},
        "semanticTokens": {
            "requests": {"full": {"delta": True}, "range": True},
            "formats": ["relative"],
            "tokenTypes": [],
            "tokenModifiers": [],
        },
    },
}


class Client:
    """Talks to ``command`` over its standard input and output; all times are seconds of ``time.monotonic``."""

    def __init__(
        self, command: Sequence[str], environment: Mapping[str, str] | None = None, errors: IO[bytes] | None = None
    ) -> None:
        self.started = time.monotonic()
        self._process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=errors,
            env={**os.environ, **(environment or {})},
        )
        self._heard: list[tuple[float, Message]] = []
        self._changed = threading.Condition()
        self._sending = threading.Lock()
        self._asked = 0
        threading.Thread(target=self._listen, daemon=True).start()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if error is None:
            self.close()
        self.kill()

    @property
    def pid(self) -> int:
        """The server's process."""
        return self._process.pid

    def close(self) -> int:
        """End the session as an editor does; returns the server's exit code."""
        self.request("shutdown", None)
        self.notify("exit", None)
        return self._process.wait(PATIENCE)

    def kill(self) -> None:
        """End the server at once."""
        self._process.kill()
        self._process.wait()

    def initialize(self, folder: Path, capabilities: Mapping[str, Any] = CAPABILITIES) -> None:
        """Begin a session on one workspace folder."""
        folders = [{"uri": folder.as_uri(), "name": folder.name}]
        parameters = {"processId": os.getpid(), "rootUri": folder.as_uri(), "workspaceFolders": folders}
        self.request("initialize", {**parameters, "capabilities": capabilities})
        self.notify("initialized", {})

    def open(self, uri: str, text: str, version: int = 1) -> None:
        """Open a document."""
        document = {"uri": uri, "languageId": "bdd", "version": version, "text": text}
        self.notify("textDocument/didOpen", {"textDocument": document})

    def request(self, method: str, parameters: object) -> Any:
        """Return the result of a request; raises ``RuntimeError`` when the server answers with an error."""
        answer = self.answer(self.ask(method, parameters))[1]
        if "error" in answer:
            raise RuntimeError(f"{method}: {answer['error']}")
        return answer["result"]

    def ask(self, method: str, parameters: object) -> int:
        """Send a request and return its identifier, for ``answer``."""
        self._asked += 1
        self._send({"id": self._asked, "method": method, "params": parameters})
        return self._asked

    def answer(self, number: int) -> tuple[float, Message]:
        """Wait for the answer to a request; returns it and when it came."""
        return self.wait(lambda message: message.get("id") == number and "method" not in message)

    def notify(self, method: str, parameters: object) -> None:
        """Send a notification."""
        self._send({"method": method, "params": parameters})

    def wait(self, wanted: Callable[[Message], bool]) -> tuple[float, Message]:
        """Wait for a message; return it with its arrival time. Messages since the last ``forget`` count, too.

        Raises ``TimeoutError`` if the server has ended or is silent.
        """
        place = 0
        with self._changed:
            while True:
                for entry in self._heard[place:]:
                    if wanted(entry[1]):
                        return entry
                place = len(self._heard)
                if not self._changed.wait(PATIENCE) or self._process.poll() is not None:
                    raise TimeoutError("the server does not answer")

    def heard(self) -> list[tuple[float, Message]]:
        """Return everything that came since the last ``forget``, with its time."""
        with self._changed:
            return list(self._heard)

    def forget(self) -> None:
        """Drop all received messages."""
        with self._changed:
            self._heard.clear()

    def processor_time(self) -> float | None:
        """Return the processor time (s) of the server's own threads so far, where the system counts it finely."""
        tasks = Path(f"/proc/{self._process.pid}/task")
        try:
            return sum(int((task / "schedstat").read_text().split()[0]) for task in tasks.iterdir()) / 1e9
        except (OSError, IndexError, ValueError):
            return None

    def _send(self, message: Message) -> None:
        data = json.dumps({"jsonrpc": "2.0", **message}).encode()
        assert self._process.stdin is not None
        with self._sending:
            self._process.stdin.write(b"Content-Length: %d\r\n\r\n%s" % (len(data), data))
            self._process.stdin.flush()

    def _listen(self) -> None:
        stream = self._process.stdout
        assert stream is not None
        while head := stream.readline():
            length = 0
            while head.strip():
                name, _, value = head.partition(b":")
                length = int(value) if name.lower() == b"content-length" else length
                head = stream.readline()
            data = stream.read(length)
            came = time.monotonic()
            message: Message = json.loads(data)
            if "id" in message and "method" in message:
                self._send({"id": message["id"], "result": None})
            with self._changed:
                self._heard.append((came, message))
                self._changed.notify_all()
        with self._changed:
            self._changed.notify_all()
