"""How the server is started."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import socket
import subprocess
import sys
from collections.abc import AsyncIterator
from contextlib import closing, suppress
from functools import partial
from itertools import count
from pathlib import Path
from typing import Any

import pytest

from robbdd_tools import __version__
from robbdd_tools.base.limits import HEADER_SECONDS
from robbdd_tools.lsp import tcp
from robbdd_tools.lsp.main import address, main

INVALID_PARAMS = -32602


@pytest.mark.parametrize(
    ("text", "place"),
    [("2087", ("127.0.0.1", 2087)), ("localhost:80", ("localhost", 80)), ("[::1]:9", ("::1", 9))],
)
def test_an_address_is_a_port_on_loopback_or_what_it_says(text: str, place: tuple[str, int]) -> None:
    assert address(text) == place


@pytest.mark.parametrize("text", ["", "host", "host:", "host:x", "1:70000", "-1"])
def test_no_address_ends_with_a_sentence(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["--tcp", text])
    assert ended.value.code == 2
    assert "PORT" in capsys.readouterr().err


def test_a_log_that_cannot_be_written_ends_with_a_sentence(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["--log-file", str(tmp_path / "missing" / "log")])
    assert ended.value.code == 2
    assert capsys.readouterr().err.endswith("log: No such file or directory\n")


def test_an_address_in_use_ends_with_a_sentence() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        command = [sys.executable, "-m", "robbdd_tools.lsp.main", "--tcp", port]
        ended = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert ended.returncode == 2
    assert ended.stderr.endswith(f"no client can connect to 127.0.0.1:{port}: Address already in use\n")


def test_the_version_is_reported(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["--version"])
    assert capsys.readouterr().out == f"robbdd-lsp {__version__}\n"


async def connected(port: int) -> tuple[asyncio.StreamReader, asyncio.StreamWriter]:
    """Connect as soon as the server listens."""
    while True:
        try:
            return await asyncio.open_connection("127.0.0.1", port)
        except ConnectionRefusedError:
            await asyncio.sleep(0.02)


class Wire:
    """A client that sends given messages."""

    def __init__(
        self,
        reader: asyncio.StreamReader,
        writer: asyncio.StreamWriter,
        server: asyncio.subprocess.Process,
        log: Path,
    ) -> None:
        self._reader, self._writer, self.server, self._log = reader, writer, server, log

    def send(self, data: bytes) -> None:
        self._writer.write(data)

    def send_message(self, method: str) -> None:
        body = json.dumps({"jsonrpc": "2.0", "method": method})
        self.send(f"Content-Length: {len(body)}\r\n\r\n{body}".encode())

    async def ended(self) -> tuple[int, str]:
        """Return the server's exit code and its log when it ends by itself."""
        async with asyncio.timeout(60):
            code = await self.server.wait()
        return code, self._log.read_text("utf-8")

    async def answer(self, method: str, params: object) -> dict[str, Any]:
        body = json.dumps({"jsonrpc": "2.0", "id": 1, "method": method, "params": params})
        self._writer.write(f"Content-Length: {len(body)}\r\n\r\n{body}".encode())
        header = await self._reader.readuntil(b"\r\n\r\n")
        length = int(header.split(b"Content-Length: ")[1].split(b"\r\n")[0])
        return json.loads(await self._reader.readexactly(length))


@pytest.fixture
async def wire(tmp_path: Path) -> AsyncIterator[Wire]:
    """A client of a server at a TCP address."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    log = tmp_path / "log"
    with log.open("wb") as stderr:
        server = await asyncio.create_subprocess_exec(
            *(sys.executable, "-m", "robbdd_tools.lsp.main", "--tcp", str(port)),
            env={**os.environ, HEADER_SECONDS.variable: "1"},
            stderr=stderr,
        )
    try:
        async with asyncio.timeout(60):
            reader, writer = await connected(port)
            yield Wire(reader, writer, server, log)
            writer.close()
    finally:
        with suppress(ProcessLookupError):
            server.kill()
        await server.wait()


async def test_a_client_is_served_over_tcp(wire: Wire) -> None:
    answer = await wire.answer("initialize", {"capabilities": {}})
    assert answer["result"]["serverInfo"]["name"] == "robbdd-lsp"


async def test_messages_and_headers_are_bounded_over_tcp(wire: Wire) -> None:
    wire.send(b"Content-Length: 70000000\r\n\r\n" + b" " * 70_000_000)
    wire.send(b"x" * 1_000_000 + b"\r\n")
    assert "result" in await wire.answer("initialize", {"capabilities": {}})
    ended = asyncio.create_task(wire.ended())
    while not ended.done():
        wire.send(b"slow\n")
        await asyncio.wait([ended], timeout=0.1)
    code, log = await ended
    assert code == 1
    assert "skipped a message of 70000000 bytes" in log
    assert "closed the connection: a header took longer than 1 s" in log
    assert "Traceback" not in log


def test_only_the_time_of_a_header_is_limited_over_tcp(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tcp, "monotonic", partial(next, count(0, HEADER_SECONDS.default + 1)))
    ours, theirs = socket.socketpair()
    with theirs, closing(tcp.TcpConnection(ours)) as connection:
        for content in (b"{}", b"[]"):
            theirs.sendall(b"Content-Length: 2\r\n\r\n" + content[:1])
            assert connection.input.readline() == b"Content-Length: 2\r\n"
            assert connection.input.readline() == b"\r\n"
            theirs.sendall(content[1:])
            assert connection.input.read(2) == content
        theirs.sendall(b"Content-Length: 2\r\n")
        assert connection.input.readline() == b"Content-Length: 2\r\n"
        theirs.sendall(b"\r\n[]")
        assert connection.input.readline() == b""


async def test_exit_ends_the_session_while_the_client_stays_connected(wire: Wire) -> None:
    await wire.answer("initialize", {"capabilities": {}})
    await wire.answer("shutdown", None)
    wire.send_message("exit")
    assert await wire.ended() == (0, "")


async def test_ctrl_c_ends_the_session_while_the_client_stays_connected(wire: Wire) -> None:
    await wire.answer("initialize", {"capabilities": {}})
    wire.server.send_signal(signal.SIGINT)
    assert await wire.ended() == (1, "")


SLEEPING = """import asyncio, signal, threading, time
from robbdd_tools.lsp.transport import end_after_loop

def interrupt():
    time.sleep(0.5)  # The loop waits by then. A signal that another thread gets does not wake it.
    signal.pthread_kill(threading.get_ident(), signal.SIGINT)

async def main():
    threading.Thread(target=interrupt).start()
    await end_after_loop(lambda: 7)

try:
    asyncio.run(main())
except KeyboardInterrupt:
    print("ended")
"""


@pytest.mark.skipif(sys.platform == "win32", reason="there, signals wake the loop")
def test_ctrl_c_is_noticed_by_a_loop_that_waits_for_nothing_else() -> None:
    done = subprocess.run([sys.executable, "-c", SLEEPING], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout, done.stderr) == (0, "ended\n", "")


async def test_a_session_that_begins_with_nonsense_is_told_so_and_may_begin_again(wire: Wire) -> None:
    unreadable: tuple[object, ...] = (
        None,
        [],
        {},
        {"capabilities": 5},
        {"capabilities": {}, "workspaceFolders": "all"},
    )
    for params in unreadable:
        error = (await wire.answer("initialize", params))["error"]
        assert (error["code"], error["message"]) == (
            INVALID_PARAMS,
            "the parameters of initialize do not match the protocol",
        )
    assert "result" in await wire.answer("initialize", {"capabilities": {}})
