"""The session's frame: headers, sizes, the end."""

from __future__ import annotations

import io
import json
import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from subprocess import PIPE
from typing import Any

import pytest

from fork_kit import ROBBDD_LSP
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.base.interruptible_input import CAN_INTERRUPT
from robbdd_tools.base.limits import MESSAGE_SIZE
from robbdd_tools.lsp.stdio import StdioConnection
from robbdd_tools.lsp.transport import LONGEST_HEADER, BoundedInput

INVALID_REQUEST, REQUEST_FAILED = -32600, -32803
PATIENCE = 120
Message = dict[str, Any]
INITIALIZE: Message = {"id": 1, "method": "initialize", "params": {"capabilities": {}}}
INITIALIZED: Message = {"method": "initialized", "params": {}}
SHUTDOWN: Message = {"id": 2, "method": "shutdown"}
EXIT: Message = {"method": "exit"}


def framed(message: Message) -> bytes:
    body = json.dumps({"jsonrpc": "2.0", **message}).encode()
    return b"Content-Length: %d\r\n\r\n%s" % (len(body), body)


def contents(data: bytes) -> list[bytes]:
    """What pygls, which this repeats, hands on."""
    stream, found, length = BoundedInput(io.BytesIO(data)), list[bytes](), 0
    while line := stream.readline():
        stated = re.fullmatch(rb"Content-Length: (\d+)\r\n", line)
        if stated and not length:
            length = int(stated[1])
        if length and not line.strip():
            found.append(stream.read(length))
            length = 0
    return found


def session(*parts: bytes | Message) -> tuple[int, list[Message], str]:
    """Return the exit code, the messages and the log of a server that gets each request after the last answer."""
    with subprocess.Popen(ROBBDD_LSP, stdin=PIPE, stdout=PIPE, stderr=PIPE) as server:
        assert server.stdin is not None
        assert server.stdout is not None
        assert server.stderr is not None
        found: list[Message] = []
        for part in parts:
            server.stdin.write(part if isinstance(part, bytes) else framed(part))
            server.stdin.flush()
            while isinstance(part, dict) and "id" in part and not any(is_answer(one, part["id"]) for one in found):
                length = int(server.stdout.readline().split()[1])
                while server.stdout.readline().strip():
                    pass
                found.append(json.loads(server.stdout.read(length)))
        server.stdin.close()
        log = server.stderr.read().decode()
        return server.wait(PATIENCE), found, log


def is_answer(message: Message, number: int) -> bool:
    return message.get("id") == number and "method" not in message


def answer(messages: list[Message], number: int) -> Message:
    (found,) = [message for message in messages if is_answer(message, number)]
    return found


@pytest.mark.parametrize(
    "broken",
    [
        b"Content-Length: 3\r\n\r\n{}}",
        b"Content-Length: many\r\n\r\n{}",
        b"Content-Length: -5\r\n\r\n{}",
        b"Content-Length: 0\r\n\r\n",
        b"\r\n\r\n",
        b"Content-Type: x\r\n\r\n{}",
        b"x" * (3 * LONGEST_HEADER),
        b'Content-Length: 100\r\n\r\n"' + b"x" * 98 + b'"',
    ],
)
def test_the_message_after_a_broken_one_is_read(monkeypatch: pytest.MonkeyPatch, broken: bytes) -> None:
    monkeypatch.setenv(MESSAGE_SIZE.variable, "50")
    assert contents(broken + b'Content-Length: 8\r\n\r\n{"id":1}')[-1] == b'{"id":1}'


def test_headers_may_be_written_as_other_clients_write_them() -> None:
    assert contents(b"content-length:2\nContent-Type: a\r\n\r\n{}") == [b"{}"]


def test_a_message_beyond_the_limit_is_never_read_into_memory() -> None:
    class Endless(io.BytesIO):
        largest = 0

        def read(self, size: int | None = -1, /) -> bytes:
            Endless.largest = max(Endless.largest, size or 0)
            return super().read(size)

    stream = BoundedInput(Endless(b"Content-Length: 99999999999999\r\n\r\nno more"))
    assert stream.readline() == b""
    assert Endless.largest <= 1 << 16


def test_a_request_after_shutdown_is_refused_and_exit_ends_well() -> None:
    late: Message = {"id": 3, "method": "workspace/symbol", "params": {"query": ""}}
    code, messages, log = session(INITIALIZE, INITIALIZED, SHUTDOWN, late, EXIT)
    assert answer(messages, 2) == {"jsonrpc": "2.0", "id": 2, "result": None}
    assert answer(messages, 3)["error"]["code"] == INVALID_REQUEST
    assert "Traceback" not in log
    assert code == 0


def test_exit_without_shutdown_is_an_error() -> None:
    assert session(INITIALIZE, INITIALIZED, EXIT)[0] == 1


def test_a_name_that_is_not_there_is_an_answer_without_a_traceback(tmp_path: Path) -> None:
    path = tmp_path / "m.bdd"
    path.write_text("\n\n", encoding="utf-8")
    document = {"uri": path_to_uri(path)}
    opened = {"textDocument": {**document, "languageId": "bdd", "version": 1, "text": "\n\n"}}
    place = {"textDocument": document, "position": {"line": 0, "character": 0}}
    code, messages, log = session(
        INITIALIZE,
        INITIALIZED,
        {"method": "textDocument/didOpen", "params": opened},
        {"id": 5, "method": "textDocument/rename", "params": {**place, "newName": "x"}},
        {"id": 6, "method": "textDocument/prepareRename", "params": place},
        {"id": 7, "method": "textDocument/definition", "params": place},
    )
    assert answer(messages, 5)["error"]["message"] == "there is no name here"
    assert "result" in answer(messages, 6) or "no name" in answer(messages, 6)["error"]["message"]
    assert not answer(messages, 7)["result"]
    assert "Traceback" not in log
    assert code == 1  # the client is gone without a word


def test_pipes_and_devices_in_the_folder_cost_neither_memory_nor_the_end(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.scene")
    (tmp_path / "zero.scene").symlink_to("/dev/zero")
    os.mkfifo(tmp_path / "robbdd.toml")
    path = tmp_path / "m.bdd"
    text = 'import "pipe.scene"\nimport "zero.scene"\nimport "a%00b.scene"\n'
    path.write_text(text, encoding="utf-8")
    uri = path_to_uri(path)
    opened = {"textDocument": {"uri": uri, "languageId": "bdd", "version": 1, "text": text.replace("%00", "\0")}}
    folders = [{"uri": path_to_uri(tmp_path), "name": "test"}]
    code, messages, log = session(
        {"id": 1, "method": "initialize", "params": {"capabilities": {}, "workspaceFolders": folders}},
        INITIALIZED,
        {"method": "textDocument/didOpen", "params": opened},
        {"id": 5, "method": "workspace/symbol", "params": {"query": ""}},
        {"id": 6, "method": "textDocument/documentLink", "params": {"textDocument": {"uri": uri}}},
        SHUTDOWN,
        EXIT,
    )
    assert "Traceback" not in log
    assert code == 0
    assert {message.get("id") for message in messages} >= {1, 2, 5, 6}


def test_exit_ends_the_process_while_its_work_hangs() -> None:
    hanging = (
        "import sys, threading\n"
        "from robbdd_tools.lsp import main, transport\n"
        "transport.end_soon.__defaults__ = (0.1,)\n"
        "threading.Thread(target=threading.Event().wait).start()\n"
        "sys.exit(main.main([]))\n"
    )
    data = b"".join(map(framed, (INITIALIZE, INITIALIZED, SHUTDOWN, EXIT)))
    done = subprocess.run(
        [sys.executable, "-c", hanging], input=data, capture_output=True, timeout=PATIENCE, check=False
    )
    assert done.returncode == 0
    assert b"work is still running" in done.stderr


def test_the_end_of_the_input_ends_the_process_while_a_task_refuses_to_end() -> None:
    stubborn = (
        "import asyncio, sys\n"
        "from robbdd_tools.lsp import main, transport\n"
        "from robbdd_tools.lsp.stored_verdicts import StoredVerdicts\n"
        "async def refuse(self):\n"
        "    while True:\n"
        "        try:\n"
        "            await asyncio.sleep(3600)\n"
        "        except asyncio.CancelledError:\n"
        "            pass\n"
        "StoredVerdicts.load = refuse\n"
        "transport.end_soon.__defaults__ = (0.1,)\n"
        "sys.exit(main.main([]))\n"
    )
    data = b"".join(map(framed, (INITIALIZE, INITIALIZED)))
    done = subprocess.run(
        [sys.executable, "-c", stubborn], input=data, capture_output=True, timeout=PATIENCE, check=False
    )
    assert done.returncode == 1
    assert b"work is still running" in done.stderr


def test_exit_ends_the_process_at_once_while_the_client_keeps_its_end_open() -> None:
    # The client does not answer a request of the server, so the server reads on after ``exit``.
    asking = {"id": 1, "method": "initialize", "params": {"capabilities": {"workspace": {"configuration": True}}}}
    data = b"".join(map(framed, (asking, INITIALIZED, SHUTDOWN, EXIT)))
    command = [sys.executable, "-m", "robbdd_tools.lsp.main"]
    with subprocess.Popen(command, stdin=PIPE, stdout=PIPE, stderr=PIPE) as server:
        assert server.stdin is not None
        assert server.stderr is not None
        server.stdin.write(data)
        server.stdin.flush()
        log = server.stderr.read()
        assert server.wait(PATIENCE) == 0
        assert b"work is still running" not in log


@pytest.mark.skipif(not CAN_INTERRUPT, reason="a read can be interrupted where there is 'poll'")
def test_a_closed_connection_ends_the_read_in_another_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    receiving, sending = os.pipe()
    with os.fdopen(receiving, encoding="utf-8") as stream:
        monkeypatch.setattr(sys, "stdin", stream)
        streams = StdioConnection()
        os.write(sending, b"\n")
        with ThreadPoolExecutor(1) as thread:
            assert thread.submit(streams.input.readline).result(PATIENCE) == b"\r\n"
            waiting = thread.submit(streams.input.readline)
            streams.close()
            assert waiting.result(PATIENCE) == b""
            assert thread.submit(streams.input.readline).result(PATIENCE) == b""
        os.close(sending)
