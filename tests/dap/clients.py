"""A client of the Debug Adapter Protocol that holds each message to the protocol's published schema."""

from __future__ import annotations

import json
import subprocess
from collections import deque
from functools import cache
from pathlib import Path
from typing import Any, BinaryIO

import debugpy
from jsonschema import Draft4Validator

SCHEMA = "_vendored/pydevd/_pydevd_bundle/_debug_adapter/debugProtocol.json"
OWN_REQUESTS = {"robbdd/scene"}


@cache
def _schema() -> dict[str, Any]:
    """The schema of the protocol, as debugpy ships it."""
    path = Path(str(debugpy.__file__)).parent / SCHEMA
    return json.loads(path.read_text(encoding="utf-8"))


@cache
def _validator(name: str) -> Draft4Validator:
    return Draft4Validator({"$ref": f"#/definitions/{name}", "definitions": _schema()["definitions"]})


def definition_of(message: dict[str, Any]) -> str:
    """Return the name of the schema's definition that a message of an adapter must fit."""
    kind = {"event": "Event", "response": "Response", "request": "Request"}[message["type"]]
    if kind == "Response" and not message["success"]:
        return "ErrorResponse"
    name = message["event"] if kind == "Event" else message["command"]
    own = f"{name[0].upper()}{name[1:]}{kind}"
    return own if own in _schema()["definitions"] else kind


class Client:
    """Drives an adapter over its standard streams, or over a connection."""

    def __init__(self, received: BinaryIO, sent: BinaryIO) -> None:
        self._received = received
        self._sent = sent
        self._number = 0
        self._unread: deque[dict[str, Any]] = deque()
        self.output = ""
        """Everything that the adapter has printed to the console."""

    @classmethod
    def of(cls, process: subprocess.Popen[bytes]) -> Client:
        """Return the client of an adapter over its standard input and output."""
        assert process.stdin is not None
        assert process.stdout is not None
        found: Any = process
        return cls(found.stdout, found.stdin)

    def send(self, command: str, **arguments: object) -> int:
        """Send a request; return its number."""
        self._number += 1
        content = json.dumps({"seq": self._number, "type": "request", "command": command, "arguments": arguments})
        self._sent.write(f"Content-Length: {len(content)}\r\n\r\n{content}".encode())
        self._sent.flush()
        return self._number

    def response(self, command: str, **arguments: object) -> dict[str, Any]:
        """Send a request and return its response; other messages remain to be read."""
        number = self.send(command, **arguments)
        kept: list[dict[str, Any]] = []
        while True:
            message = self.read()
            if message["type"] == "response" and message["request_seq"] == number:
                self._unread.extendleft(reversed(kept))
                return message
            kept.append(message)

    def ask(self, command: str, **arguments: object) -> Any:
        """Send a request, which must succeed; return the body of its response."""
        found = self.response(command, **arguments)
        assert found["success"], found
        return found.get("body")

    def refused(self, command: str, **arguments: object) -> str:
        """Send a request, which must fail; return the reason."""
        found = self.response(command, **arguments)
        assert not found["success"]
        return found["message"]

    def event(self, name: str) -> dict[str, Any]:
        """Return the body of the next event of a kind; those before it are dropped."""
        while True:
            message = self.read()
            if message["type"] == "event" and message["event"] == name:
                return message["body"]

    def read(self) -> dict[str, Any]:
        """Return the next message. Raises ``EOFError``."""
        if self._unread:
            return self._unread.popleft()
        length = 0
        while line := self._received.readline().strip():
            length = int(line.rpartition(b":")[2])
        if not length:
            raise EOFError(self.output)
        message = json.loads(self._received.read(length))
        # The library leaves some types open.
        validator: Any = _validator(definition_of(message))
        validator.validate(message)
        if message.get("event") == "output":
            self.output += message["body"]["output"]
        return message

    def launch(self, program: Path, *lines: int, filters: tuple[str, ...] = (), **arguments: object) -> list[Any]:
        """Debug a scenario, with breakpoints on some lines of its file; return the answers to these."""
        self.ask("initialize", adapterID="robbdd", linesStartAt1=True, pathFormat="path")
        self.ask("launch", program=str(program), **{"noStore": True, **arguments})
        self.event("initialized")
        stated = [{"line": line} for line in lines]
        found = self.ask("setBreakpoints", source={"path": str(program)}, breakpoints=stated)
        self.ask("setExceptionBreakpoints", filters=list(filters))
        self.ask("configurationDone")
        return found["breakpoints"]

    def variables(self, frame: int = 0) -> dict[str, dict[str, str]]:
        """Return the variables of a frame: name and value by scope."""
        scopes = self.ask("scopes", frameId=frame)["scopes"]
        return {scope["name"]: self.inside(scope["variablesReference"]) for scope in scopes}

    def inside(self, reference: int) -> dict[str, str]:
        """Return the variables with a reference: values by name."""
        found = self.ask("variables", variablesReference=reference)["variables"]
        return {one["name"]: one["value"] for one in found}
