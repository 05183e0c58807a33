"""A server in a separate process, with a client over standard input and output."""

from __future__ import annotations

from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any

import pytest
import pytest_lsp
from pytest_lsp import ClientServerConfig, LanguageClient, client_capabilities

from fork_kit import ROBBDD_LSP
from fork_server.converter import FACTORY, shared_converter
from lsp.recorded_projects import Window
from lsp_kit import Editor, begin_session


@pytest.fixture(autouse=True)
def quick_start(forked_processes: None) -> None:
    """Start ``fork_kit.ROBBDD_LSP`` and agents as forks."""


@pytest.fixture(autouse=True)
def one_converter(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let all clients of this process use one converter."""
    monkeypatch.setattr(FACTORY, shared_converter)


@pytest.fixture
def run_messages() -> list[Any]:
    """The notifications of runs, in order."""
    return []


@pytest.fixture
def asked() -> list[str]:
    """The methods that the server has asked of the client."""
    return []


# pytest-lsp leaves the types of its decorator open.
@pytest_lsp.fixture(  # pyright: ignore[reportUnknownMemberType]
    config=ClientServerConfig(server_command=[*ROBBDD_LSP, "--stdio"]),
)
async def client(
    asked: list[str],
    request: pytest.FixtureRequest,
    lsp_client: LanguageClient,
    tmp_path: Path,
    run_messages: list[Any],
) -> AsyncIterator[None]:
    def keep(notification: Any) -> None:
        run_messages.append(notification)

    lsp_client.feature("robbdd/runMessage")(keep)
    await begin_session(
        lsp_client, tmp_path, client_capabilities(getattr(request, "param", "visual-studio-code")), asked
    )
    yield
    await lsp_client.shutdown_session()


@pytest.fixture
def editor(client: LanguageClient, tmp_path: Path) -> Editor:
    return Editor(client, tmp_path)


@pytest.fixture
async def window() -> Any:
    """A function that opens folders in a window of their own."""
    opened: list[LanguageClient] = []

    async def start(*folders: Path) -> Window:
        found = await Window().start(folders)
        opened.append(found.client)
        return found

    yield start
    for client in opened:
        await client.shutdown_session()
