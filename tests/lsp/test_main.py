"""How the server is started."""

from __future__ import annotations

import asyncio
import json
import socket
import subprocess
import sys
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any

import pytest

from robbdd_tools import __version__
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

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._reader, self._writer = reader, writer

    async def answer(self, method: str, params: object) -> dict[str, Any]:
        body = json.dumps({"jsonrpc": "2.0", "id": 1, "method": method, "params": params})
        self._writer.write(f"Content-Length: {len(body)}\r\n\r\n{body}".encode())
        header = await self._reader.readuntil(b"\r\n\r\n")
        length = int(header.split(b"Content-Length: ")[1].split(b"\r\n")[0])
        return json.loads(await self._reader.readexactly(length))


@pytest.fixture
async def wire() -> AsyncIterator[Wire]:
    """A client of a server at a TCP address."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    server = await asyncio.create_subprocess_exec(sys.executable, "-m", "robbdd_tools.lsp.main", "--tcp", str(port))
    try:
        async with asyncio.timeout(60):
            reader, writer = await connected(port)
            yield Wire(reader, writer)
            writer.close()
    finally:
        server.kill()
        await server.wait()


async def test_a_client_is_served_over_tcp(wire: Wire) -> None:
    answer = await wire.answer("initialize", {"capabilities": {}})
    assert answer["result"]["serverInfo"]["name"] == "robbdd-lsp"


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
