"""What a report of an issue says about the server's environment."""

from __future__ import annotations

import platform
from importlib import metadata

from kit import schema_errors
from lsp_kit import CLIENTS, Editor, plain
from robbdd_tools.lsp.versions import VERSIONS, _installed  # pyright: ignore[reportPrivateUsage] -- no such package


@CLIENTS
async def test_the_server_names_its_interpreter_and_its_simulator(editor: Editor) -> None:
    answer = plain(await editor.client.protocol.send_request_async(VERSIONS, {}))
    assert schema_errors("versions.schema.json", answer) == []
    assert answer["python"] == f"CPython {platform.python_version()}"
    assert answer["mujoco"] == metadata.version("mujoco")


def test_a_package_that_is_not_installed_has_no_version() -> None:
    assert _installed("no-such-package-of-robbdd") is None
