"""Answers of the server to the extension's requests about one project, for the extension's tests.

The project is the pick-and-place example and the scene of another one, executed without physics. What differs between
machines and runs (folders, times, hosts) has fixed values, and long arrays are left as they are.
"""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path
from typing import Any, cast

from lsprotocol import types

from kit import EXAMPLES, ROOT
from lsp.recorded_projects import Window
from lsp_kit import Editor, plain
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.cli import main

FOLDER = ROOT / "client-vscode" / "test" / "recorded"
"""The recorded answers, one file each."""
HOME = "file:///recorded"
VARIANT = "https://example.org/robbdd/criteria/part-to-bin"
FIXED = frozenset({"wall", "began", "ended", "seconds", "host", "jobs"})
"""Fields that differ between runs."""
BEGAN = "2026-01-01T00:00:00+00:00"


async def recorded_answers(folder: Path) -> dict[str, Any]:
    """Return the answers by the names of their files; ``folder`` is empty."""
    shutil.copytree(EXAMPLES / "pickplace", folder / "bench")
    shutil.copytree(EXAMPLES / "ownrobot", folder / "cell")
    (folder / "bench" / "robbdd.toml").touch()
    model = folder / "bench" / "pickplace.bdd"
    for seed in ("1", "2"):
        main(["run", str(model), "--first", "2", "--seed", seed, "--world", "kinematic"])
    window = await Window().start([folder])
    uri, scene = path_to_uri(model), path_to_uri(folder / "cell" / "cell.scenex")

    async def asked(method: str, **parameters: Any) -> Any:
        return plain(await window.client.protocol.send_request_async(f"robbdd/{method}", parameters))

    async def command(name: str, **parameters: Any) -> Any:
        asked = types.ExecuteCommandParams(command=name, arguments=[parameters])
        return plain(await window.client.workspace_execute_command_async(asked))

    text = model.read_text(encoding="utf-8")
    for file in (model, folder / "cell" / "cell.scenex"):
        Editor(window.client, folder, str(file.relative_to(folder))).open()
    clause = {"line": text[: text.index("at-goal:")].count("\n"), "character": 15}
    try:
        answers = {
            "tests": await asked("tests"),
            "tests-of-file": await asked("tests", uri=uri),
            "tests-of-variant": await asked("tests", uri=uri, variant=VARIANT),
            "testresults": await asked("testResults"),
            "runs": await asked("runs", uri=uri),
            "trace": await asked("trace", uri=uri),
            "graph": await asked("graph", uri=uri),
            "preview": await asked("preview", uri=uri),
            "scene": await asked("scene", uri=scene),
            # The list grows with the examples.
            "templates": (await asked("templates"))[:1],
            "compare": await asked("compare", uri=uri, before=1, after=2),
            "history": await asked("history", uri=uri, position=clause),
            "estimate": await command("robbdd.estimate", uri=uri, first=2),
            "runanswer": await command("robbdd.run", uri=uri, where="robot=nobody"),
        }
    finally:
        await window.client.shutdown_session()
    return {name: _fixed(answer, path_to_uri(folder), str(folder)) for name, answer in answers.items()}


def _fixed(value: Any, uri: str, path: str, name: str = "") -> Any:
    match value:
        case dict():
            fields = cast("dict[str, Any]", value)
            return {key: _fixed(one, uri, path, key) for key, one in fields.items()}
        case list():
            return [_fixed(one, uri, path) for one in cast("list[Any]", value)]
        case str() if name == "words":
            return re.sub(r", about .*", ", about 1 s", value)
        case str():
            return BEGAN if name in FIXED else re.sub(rf"{re.escape(uri)}|{re.escape(path)}", HOME, value)
        case bool() | None:
            return value
        case _:
            return 1 if name in FIXED else round(value, 6)


def written(answer: Any) -> str:
    """Return an answer as text."""
    return json.dumps(answer, indent=1, ensure_ascii=False) + "\n"
