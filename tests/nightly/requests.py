"""Fuzzing of the language server: requests that no editor should send."""

from __future__ import annotations

import json
from pathlib import Path
from random import Random
from typing import Any, cast

from tests.bench.client import Client
from tests.nightly.fuzz import Files, Target
from tests.nightly.session import AT_POSITION, OF_DOCUMENT, OF_RANGE, OF_URI, OF_WORKSPACE, OWN_ERROR, SERVER

from kit import MODEL, SCENE

REQUESTS = 60
"""Requests of a case."""
INTERNAL_ERROR = -32603
ODD: tuple[Any, ...] = (
    None,
    True,
    -1,
    0,
    2**31,
    2**63,
    1.5,
    "",
    "x",
    "\x00",
    "🤖",
    "file:///",
    "file:///nowhere/main.bdd",
    "file:///dev/null",
    "file://host/share/main.bdd",
    "untitled:Untitled-1",
    "http://127.0.0.1:9/main.bdd",
    "file:///%00",
    "file:///%ff%fe.bdd",
    "/no/uri",
    [],
    [None],
    {},
    {"uri": None},
    {"line": -1, "character": -1},
    {"line": 2**31 - 1, "character": 2**31 - 1},
    {"start": {"line": 5, "character": 1}, "end": {"line": 1, "character": 0}},
)
METHODS = (
    *(f"textDocument/{name}" for name in (*AT_POSITION, *OF_RANGE, *OF_DOCUMENT)),
    *OF_WORKSPACE,
    *OF_URI,
    "completionItem/resolve",
    "callHierarchy/incomingCalls",
    "callHierarchy/outgoingCalls",
    "workspace/executeCommand",
    "workspace/willRenameFiles",
    "robbdd/trace",
    "robbdd/importResults",
    "robbdd/newProject",
    "robbdd/unknown",
    "textDocument/unknown",
    "shutdownNow",
)
NOTIFICATIONS = (
    "textDocument/didOpen",
    "textDocument/didChange",
    "textDocument/didClose",
    "textDocument/didSave",
    "workspace/didChangeWatchedFiles",
    "workspace/didChangeConfiguration",
    "workspace/didChangeWorkspaceFolders",
    "window/workDoneProgress/cancel",
    "$/cancelRequest",
    "$/setTrace",
    "robbdd/unknown",
)
URI = "MODEL"
"""Stands for the URI of the open model until the folder of a case is known."""


def _usual(random: Random) -> dict[str, Any]:
    """Return parameters with all fields that any method requires."""
    position = {"line": random.randrange(60), "character": random.randrange(80)}
    document = {"uri": URI, "languageId": "bdd", "version": random.randrange(5), "text": MODEL}
    item = {"name": "x", "kind": 5, "uri": URI, "range": {"start": position, "end": position}}
    return {
        "textDocument": document,
        "uri": URI,
        "position": position,
        "positions": [position],
        "range": {"start": position, "end": position},
        "context": {"includeDeclaration": True, "triggerKind": 1, "diagnostics": []},
        "options": {"tabSize": 4, "insertSpaces": True},
        "newName": "other",
        "ch": "\n",
        "query": "a",
        "previousResultId": "1",
        "label": "x",
        "data": {"kind": "event", "uri": URI, "path": "start"},
        "item": {**item, "selectionRange": item["range"]},
        "files": [{"oldUri": URI, "newUri": f"{URI}2"}],
        "contentChanges": [{"text": MODEL}],
        "changes": [{"uri": URI, "type": 2}],
        "settings": {"robbdd": {"shapes": ["*.ttl"]}},
        "event": {"added": [], "removed": []},
        "command": random.choice(("robbdd.gherkin", "robbdd.steps", "robbdd.cancel", "robbdd.unknown")),
        "arguments": [{"uri": URI}],
        "token": "x",
        "id": 1,
        "value": "off",
        "variant": "urn:x",
        "first": 1,
        "most": 5,
        "run": "latest",
        "index": 0,
        "scenario": None,
        "iri": "urn:x",
    }


def _spoil(random: Random, value: Any) -> Any:
    """Return parameters with one part replaced by something odd, or left out."""
    if isinstance(value, dict) and value and random.random() < 0.9:
        entries = cast("dict[str, Any]", value)
        name = random.choice(list(entries))
        if random.random() < 0.1:
            return {key: entry for key, entry in entries.items() if key != name}
        return {**entries, name: _spoil(random, entries[name])}
    if isinstance(value, list) and value and random.random() < 0.7:
        return [_spoil(random, value[0])]
    return random.choice(ODD)


def _odd_messages(random: Random) -> Files:
    messages: list[dict[str, Any]] = []
    for _ in range(REQUESTS):
        notifies = random.random() < 0.25
        method = random.choice(NOTIFICATIONS if notifies else METHODS)
        parameters: Any = _usual(random)
        for _ in range(random.randrange(4)):
            parameters = _spoil(random, parameters)
        messages.append({"method": method, "params": parameters, "notifies": notifies})
    return {"messages.json": json.dumps(messages, indent=1).encode()}


def _check_server(folder: Path) -> None:
    """Every request is answered, by a result or a refusal; afterwards the server works and ends as it should."""
    project = folder / "project"
    project.mkdir()
    for name, text in (("main.bdd", MODEL), ("lab.scene", SCENE)):
        (project / name).write_text(text, encoding="utf-8")
    uri = (project / "main.bdd").as_uri()
    messages = json.loads((folder / "messages.json").read_text(encoding="utf-8").replace(URI, uri))
    log = folder / "server.log"
    with log.open("wb") as errors, Client(SERVER, errors=errors) as client:
        client.initialize(project)
        client.open(uri, MODEL)
        for message in messages:
            _send(client, message)
        client.open((project / "after.bdd").as_uri(), MODEL)
        place = {"textDocument": {"uri": (project / "after.bdd").as_uri()}, "position": {"line": 3, "character": 15}}
        assert client.request("textDocument/hover", place), "the server answers nothing any more"
    said = log.read_text(encoding="utf-8", errors="replace")
    found = OWN_ERROR.search(said)
    assert found is None, said[found.start() :][:3000] if found else ""


def _send(client: Client, message: dict[str, Any]) -> None:
    method, parameters = message["method"], message["params"]
    if message["notifies"]:
        client.notify(method, parameters)
        return
    answer = client.answer(client.ask(method, parameters))[1]
    code = answer.get("error", {}).get("code")
    assert code != INTERNAL_ERROR, f"{method} {json.dumps(parameters)[:600]}: {answer['error']}"


REQUEST_TARGETS = (Target("requests", _odd_messages, _check_server),)
