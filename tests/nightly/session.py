"""An editor's session with a real ``robbdd-lsp``: documents that are edited at random, requests of every kind."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from random import Random
from typing import Any

from tests.bench.client import CAPABILITIES, Client, Message
from tests.bench.models import long_story, model

from edits import PIECES, Edit
from kit import EXAMPLES, SCENE

KINDS = ("replace", "replace", "replace", "delete", "duplicate", "half", "undo")
LENGTHS = (0, 0, 0, 1, 1, 2, 5, 20, 100, 400)
INTERNAL_ERROR = -32603
OWN_ERROR = re.compile(r"internal error|Exception in thread|ERROR (robbdd_tools|asyncio)\b|Fatal Python error")
"""What the server's log has where something failed that must not; pygls logs refused requests, too."""
OF_RUNS = "clause-"
"""Prefixes of diagnostic codes from runs: a check has none of them."""
AT_POSITION = (
    "completion",
    "hover",
    "definition",
    "declaration",
    "typeDefinition",
    "implementation",
    "references",
    "documentHighlight",
    "prepareRename",
    "rename",
    "linkedEditingRange",
    "prepareCallHierarchy",
    "onTypeFormatting",
)
OF_RANGE = ("inlayHint", "codeAction", "rangeFormatting", "semanticTokens/range")
OF_DOCUMENT = (
    "documentSymbol",
    "foldingRange",
    "codeLens",
    "documentLink",
    "semanticTokens/full",
    "semanticTokens/full/delta",
    "selectionRange",
    "formatting",
)
OF_WORKSPACE = ("workspace/symbol", "robbdd/tests", "robbdd/testResults", "robbdd/templates", "robbdd/versions")
OF_URI = ("robbdd/preview", "robbdd/graph", "robbdd/scene", "robbdd/runs", "robbdd/tests")


class Fault(AssertionError):
    """Something that must not happen."""


class Document:
    """A text that the client holds, with the texts before it."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.uri = path.as_uri()
        self.original = path.read_text(encoding="utf-8")
        self.history = [self.original]
        self.version = 1

    @property
    def text(self) -> str:
        """The text now."""
        return self.history[-1]

    def position(self, offset: int) -> dict[str, int]:
        """Return the position of an offset, in code points."""
        before = self.text[:offset].replace("\r\n", " \n").replace("\r", "\n")
        return {"line": before.count("\n"), "character": len(before) - before.rfind("\n") - 1}


class Session:
    """Documents of a copied project in a folder, open in a server; ``log`` receives its error output."""

    def __init__(self, folder: Path, log: Path, random: Random) -> None:
        self._random = random
        self._folder = folder
        self._log = log
        self.asked: Counter[str] = Counter()
        self.edits = 0
        copy_project(folder)
        self.documents = [Document(folder / name) for name in ("main.bdd", "lab.scene", "long.bdd", "stories.bdd")]
        self.documents += [Document(folder / "pickplace" / name) for name in ("pickplace.bdd", "pickplace.bddx")]
        self._errors = log.open("wb")
        self.client = Client(SERVER, errors=self._errors)
        capabilities = {**CAPABILITIES, "general": {"positionEncodings": ["utf-32"]}}
        self.client.initialize(folder, capabilities)
        for document in self.documents:
            self.client.open(document.uri, document.text)

    def close(self) -> None:
        """End the server as an editor does."""
        self.client.close()
        self._errors.close()

    def kill(self) -> None:
        """End the server at once."""
        self.client.kill()
        self._errors.close()

    def edit(self, document: Document) -> None:
        """Change a document as a user would."""
        random = self._random
        text = random.choice(PIECES)
        if random.random() < 0.3:
            source = random.choice(self.documents).text
            start = random.randrange(len(source) + 1)
            text = source[start : start + random.randrange(60)]
        Edit(0, random.choice(KINDS), random.random(), random.choice(LENGTHS), text).apply(document.history)
        del document.history[:-20]
        self._changed(document)

    def restore(self, document: Document) -> None:
        """Go back to the text with which a document was opened."""
        if document.text != document.original:
            document.history = [document.original]
            self._changed(document)

    def reopen(self, document: Document) -> None:
        """Close a document and open it again."""
        self.client.notify("textDocument/didClose", {"textDocument": {"uri": document.uri}})
        document.version += 1
        self.client.open(document.uri, document.text, document.version)

    def touch(self) -> None:
        """Change a file that is not open, and report it."""
        path = self._folder / "unopened.scene"
        path.write_text(SCENE + f"// {self._random.random()}\n", encoding="utf-8")
        changes = {"changes": [{"uri": path.as_uri(), "type": 2}]}
        self.client.notify("workspace/didChangeWatchedFiles", changes)

    def request(self, document: Document) -> int:
        """Send a request about a document; returns its identifier."""
        method, parameters = self._question(document)
        self.asked[method] += 1
        return self.client.ask(method, parameters)

    def run(self, cancelled: bool) -> int:
        """Start a run of the example, and cancel it immediately if ``cancelled``; return its identifier."""
        document = self.documents[-2]
        self.asked["run"] += 1
        run = self._command("robbdd.run", {"uri": document.uri})
        if cancelled:
            self.client.wait(lambda message: message.get("method") == "robbdd/runMessage")
            self._answered(self._command("robbdd.cancel", {}))
        return run

    def answered(self, numbers: Sequence[int]) -> None:
        """Wait for the answers to requests; raises ``Fault`` for an error of the server's own."""
        for number in numbers:
            self._answered(number)
        self.client.forget()

    def check_log(self) -> None:
        """Raise ``Fault`` if the server has reported an internal error."""
        said = self._log.read_text(encoding="utf-8", errors="replace")
        found = OWN_ERROR.search(said)
        if found:
            raise Fault(f"the server reports an error of its own:\n{said[found.start() :][:4000]}")

    def compare_with_check(self) -> None:
        """Compare the published diagnostics of the open documents with a fresh check of the same texts.

        Raises ``Fault`` if they still differ when the server has become silent.
        """
        expected = self._checked()
        for document in self.documents:
            # Requests diagnostics again, even without a change since the last ones were dropped.
            document.version += 1
            self._send(document)
        wanted = {document.uri: expected.get(document.uri, []) for document in self.documents}

        def published() -> dict[str, list[list[Any]]]:
            # Diagnostics of unopened files are published, too, after each validation.
            return {uri: found for uri, found in self._published().items() if uri in wanted}

        try:
            self.client.wait(lambda _: published() == wanted)
        except TimeoutError as error:
            raise Fault(_differences(published(), wanted)) from error
        self.client.forget()

    def save(self, folder: Path) -> None:
        """Write the present texts into a folder with a copy of the project."""
        copy_project(folder)
        for document in self.documents:
            place = folder / document.path.relative_to(self._folder)
            place.write_text(document.text, encoding="utf-8", newline="")

    def _checked(self) -> dict[str, list[list[Any]]]:
        folder = self._folder.with_name("cold")
        shutil.rmtree(folder, ignore_errors=True)
        self.save(folder)
        command = [sys.executable, "-m", "robbdd_tools.cli", "check", "--json", "."]
        told = subprocess.run(command, cwd=folder, capture_output=True, text=True, encoding="utf-8", check=False)
        if told.returncode not in (0, 1):
            raise Fault(f"robbdd check ends with {told.returncode}: {told.stderr}")
        found: dict[str, list[list[Any]]] = {}
        # Some messages name the folder in which a file is missing.
        for line in told.stdout.replace(str(folder), str(self._folder)).splitlines():
            entry = json.loads(line)
            start = entry["range"]["start"]
            place = [start["line"] - 1, start["column"] - 1, entry["code"], entry["message"]]
            found.setdefault((self._folder / entry["file"]).as_uri(), []).append(place)
        return {uri: sorted(entries) for uri, entries in found.items()}

    def _published(self) -> dict[str, list[list[Any]]]:
        found: dict[str, list[list[Any]]] = {}
        for _, message in self.client.heard():
            if message.get("method") == "textDocument/publishDiagnostics":
                found[message["params"]["uri"]] = sorted(_shown(message["params"]["diagnostics"]))
        return found

    def _changed(self, document: Document) -> None:
        document.version += 1
        self.edits += 1
        self._send(document)

    def _send(self, document: Document) -> None:
        changed = {"uri": document.uri, "version": document.version}
        whole = [{"text": document.text}]
        self.client.notify("textDocument/didChange", {"textDocument": changed, "contentChanges": whole})

    def _command(self, name: str, argument: dict[str, Any]) -> int:
        return self.client.ask("workspace/executeCommand", {"command": name, "arguments": [argument]})

    def _answered(self, number: int) -> Message:
        answer = self.client.answer(number)[1]
        if answer.get("error", {}).get("code") == INTERNAL_ERROR:
            raise Fault(f"a request is answered by an error of the server's own: {answer['error']}")
        return answer

    def _question(self, document: Document) -> tuple[str, dict[str, Any]]:
        random = self._random
        start, end = sorted(random.randrange(len(document.text) + 1) for _ in range(2))
        position = document.position(start)
        place = {"start": position, "end": document.position(end)}
        told = {"textDocument": {"uri": document.uri}}
        kind = random.randrange(5)
        if kind == 0:
            method = random.choice(OF_WORKSPACE)
            return method, {"query": random.choice(("", "pick", "é"))} if method == "workspace/symbol" else {}
        if kind == 1:
            return random.choice(OF_URI), {"uri": document.uri}
        options = {"tabSize": 4, "insertSpaces": True}
        if kind == 2:
            more = {"positions": [position], "options": options, "previousResultId": "1"}
            return f"textDocument/{random.choice(OF_DOCUMENT)}", {**told, **more}
        if kind == 3:
            nothing: list[object] = []
            more = {"range": place, "context": {"diagnostics": nothing}, "options": options}
            return f"textDocument/{random.choice(OF_RANGE)}", {**told, **more}
        more = {"position": position, "context": {"includeDeclaration": True, "triggerKind": 1}, "newName": "other"}
        typed = {"ch": random.choice("\n}|"), "options": options}
        return f"textDocument/{random.choice(AT_POSITION)}", {**told, **more, **typed}


SERVER = (sys.executable, "-m", "robbdd_tools.lsp.main", "--stdio")


def copy_project(folder: Path) -> None:
    """Make a folder with the models of a session: small and long ones, and an example that can be run."""
    folder.mkdir(parents=True)
    shutil.copytree(EXAMPLES / "pickplace", folder / "pickplace")
    texts = {"lab.scene": SCENE, "unopened.scene": SCENE, "main.bdd": model(60), "long.bdd": model(500)}
    texts["stories.bdd"] = long_story(120)
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")


def _shown(diagnostics: list[dict[str, Any]]) -> Iterator[list[Any]]:
    for entry in diagnostics:
        start = entry["range"]["start"]
        if not entry["code"].startswith(OF_RUNS):
            yield [start["line"], start["character"], entry["code"], entry["message"]]


def _differences(published: Mapping[str, list[list[Any]]], checked: Mapping[str, list[list[Any]]]) -> str:
    """Return what only one of the two says, file by file."""
    lines: list[str] = []
    for uri, wanted in checked.items():
        found = published.get(uri)
        if found is None:
            lines.append(f"{uri}: nothing is published")
            continue
        lines += [f"{uri}: published only: {entry}" for entry in found if entry not in wanted]
        lines += [f"{uri}: checked only: {entry}" for entry in wanted if entry not in found]
        if sorted(found) != sorted(wanted) and all(entry in wanted for entry in found):
            lines.append(f"{uri}: {len(found)} published, {len(wanted)} checked")
    return "\n".join(["published and checked diagnostics differ:", *lines])
