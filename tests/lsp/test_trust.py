"""A workspace that is not trusted: edited and checked, never run."""

from __future__ import annotations

import re
import shutil
import sys
from pathlib import Path
from typing import Any, cast

import pytest
from lsprotocol import types
from pytest_lsp import client_capabilities, make_test_lsp_client

from kit import EXAMPLES
from lsp_kit import Editor
from robbdd_tools.base.files import path_to_uri

MINE = '"""Tells that it was imported."""\nfrom pathlib import Path\nPath(__file__).with_name("imported").touch()\n'
REFUSED = "nothing was run, because this workspace is not trusted"
WITHOUT_CODE = f"{REFUSED}: scenarios run the workspace's own steps, behaviours and models"
ATTACK = "raise SystemExit('imported')\n"


def _ignore(*_: object) -> None:
    return None


async def untrusted(folder: Path) -> Editor:
    """Open the example, with its own Python code, in a client that does not trust it."""
    shutil.copytree(EXAMPLES / "pickplace", folder / "pickplace")
    (folder / "pickplace" / "steps").mkdir()
    (folder / "pickplace" / "steps" / "pickplace_steps.py").write_text(MINE, encoding="utf-8")
    (folder / "pickplace" / "policies.py").write_text(MINE, encoding="utf-8")
    for name in ("sitecustomize.py", "robbdd_tools.py", "numpy.py"):
        (folder / "pickplace" / name).write_text(ATTACK, encoding="utf-8")
    client = make_test_lsp_client()
    client.feature(types.WORKSPACE_INLAY_HINT_REFRESH)(_ignore)
    client.feature(types.WORKSPACE_CODE_LENS_REFRESH)(_ignore)
    # The type of its further arguments is left open.
    await cast(Any, client).start_io(sys.executable, "-m", "robbdd_tools.lsp.main", "--stdio")
    await client.initialize_session(
        types.InitializeParams(
            capabilities=client_capabilities("visual-studio-code"),
            workspace_folders=[types.WorkspaceFolder(uri=path_to_uri(folder), name="test")],
            initialization_options={"trusted": False},
        )
    )
    return Editor(client, folder)


async def refusal(editor: Editor, command: str, uri: str) -> str:
    params = types.ExecuteCommandParams(command=f"robbdd.{command}", arguments=[{"uri": uri}])
    answer: Any = await editor.client.workspace_execute_command_async(params)
    problem = answer.pop("problem")
    assert not answer
    return problem


@pytest.mark.parametrize("command", ["run", "rerunFailed", "record"])
async def test_an_untrusted_workspace_is_checked_but_not_run(command: str, tmp_path: Path) -> None:
    editor = await untrusted(tmp_path)
    editor.open()
    await editor.diagnostics()
    editor.change("until <evt-end>", "until <evt-emd>")
    assert await editor.diagnostics("unknown-name", "unused-event")
    editor.change("until <evt-emd>", "until <evt-end>")
    await editor.diagnostics()

    steps = tmp_path / "pickplace" / "steps" / "pickplace_steps.py"
    problem = await refusal(editor, command, editor.uri)
    assert problem == f"{REFUSED}: {steps} contains user-defined steps: trust the workspace if you trust this code"
    assert editor.client.messages[0].message.endswith(problem)

    bddx = tmp_path / "pickplace" / "pickplace.bddx"
    problem = await refusal(editor, command, path_to_uri(bddx))
    line = bddx.read_text(encoding="utf-8").split("starts-outside")[0].count("\n") + 1
    policy = (
        rf"{re.escape(f'{bddx}:{line}')}:\d+: the policy \S+starts-outside judges with the Python code policies:apart"
    )
    assert re.search(policy, problem), problem

    steps.unlink()
    assert await refusal(editor, command, editor.uri) == WITHOUT_CODE
    assert await refusal(editor, command, path_to_uri(tmp_path / "nothing.bdd")) == WITHOUT_CODE
    assert not list(tmp_path.rglob("imported"))
    assert not list(tmp_path.rglob(".robbdd")), "nothing is written, either"
    await editor.client.shutdown_session()
