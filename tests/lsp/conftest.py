"""A server in a process of its own, with a client over standard input and output."""

from __future__ import annotations

import shutil
import sys
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any

import pytest
import pytest_lsp
from lsprotocol import types
from pytest_lsp import ClientServerConfig, LanguageClient, client_capabilities

from kit import EXAMPLES
from lsp_kit import Editor
from robbdd_tools.base.files import path_to_uri


@pytest.fixture
def run_messages() -> list[Any]:
    """The notifications of runs, in order."""
    return []


# pytest-lsp leaves the types of its decorator open.
@pytest_lsp.fixture(  # pyright: ignore[reportUnknownMemberType]
    config=ClientServerConfig(server_command=[sys.executable, "-m", "robbdd_tools.lsp.main", "--stdio"]),
)
async def client(
    request: pytest.FixtureRequest, lsp_client: LanguageClient, tmp_path: Path, run_messages: list[Any]
) -> AsyncIterator[None]:
    def ignore(*_: object) -> None:
        return None

    def keep(notification: Any) -> None:
        run_messages.append(notification)

    lsp_client.feature(types.WORKSPACE_INLAY_HINT_REFRESH)(ignore)
    lsp_client.feature(types.WORKSPACE_CODE_LENS_REFRESH)(ignore)
    lsp_client.feature(types.CLIENT_REGISTER_CAPABILITY)(ignore)
    lsp_client.feature("robbdd/runMessage")(keep)
    shutil.copytree(EXAMPLES / "pickplace", tmp_path / "pickplace")
    parameters = types.InitializeParams(
        capabilities=client_capabilities(getattr(request, "param", "visual-studio-code")),
        workspace_folders=[types.WorkspaceFolder(uri=path_to_uri(tmp_path), name="test")],
    )
    await lsp_client.initialize_session(parameters)
    yield
    await lsp_client.shutdown_session()


@pytest.fixture
def editor(client: LanguageClient, tmp_path: Path) -> Editor:
    return Editor(client, tmp_path)
