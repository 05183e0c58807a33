"""Fixtures as text: several files, a cursor, and the diagnostics expected where they stand.

``//- name.bdd`` begins a file; ``$0`` is the cursor; a comment line of carets under a line expects a diagnostic on
the text above the carets: ``//   ^^^^ code`` with, optionally, words that its message must contain.
"""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Generator
from contextlib import contextmanager, redirect_stdout, suppress
from dataclasses import dataclass
from importlib import import_module
from io import StringIO
from pathlib import Path
from typing import Any

import pytest

from robbdd_tools.base.diagnostic import Diagnostic
from robbdd_tools.base.document import Document, Span
from robbdd_tools.cli import main
from robbdd_tools.names.project import Project, Snapshot
from robbdd_tools.protocol.manifest_file import written_manifest
from robbdd_tools.protocol.specs import Manifest
from robbdd_tools.syntax.parse import LANGUAGES

FOLDER = "file:///fixture/"
ROOT = Path(__file__).parent.parent
EXAMPLES = ROOT / "examples"
DOCS = ROOT / "docs"
MODELS = sorted(path for path in EXAMPLES.rglob("*") if path.suffix[1:] in LANGUAGES)
"""The models of all examples, of every file kind."""

SCENE = """ns env = 'https://example.org/env/'
obj set (ns=env) parts { object bolt, object nut }
similar obj set (ns=env) washers { base name: washer  count: 3 }
obj set (ns=env) furniture { object bench, object tray }
ws set (ns=env) places { workspace bench_ws, workspace tray_ws }
agn set (ns=env) arms { agent panda, agent ur10 }
comp (ns=env) tray_comp of ws <places.tray_ws> { obj <furniture.tray> }
comp (ns=env) bench_comp of ws <places.bench_ws> { obj <furniture.bench> ws comp <tray_comp> }
scene (ns=env) bench_scene { obj set <parts> ws comp <bench_comp> ws comp <tray_comp> agn set <arms> }
"""
"""A small sound scene for models that need one: import it as ``lab.scene``."""

EVENTS = """import "lab.scene"
ns t = 'https://example.org/t/'
Task (ns=t) task
Event (ns=t) start
Event (ns=t) pick-start
Event (ns=t) place-end
Event (ns=t) end
"""

TEMPLATE = """Scenario Template (ns=t) fetch {
    duration: from <start> until <end>
    task: <task>
    var part
    var robot
    var goal
    Given:
        on-bench: holds(<part> is located at <goal>, before <pick-start>)
    When:
        Behaviour (ns=t) carry {
            duration: from <pick-start> until <place-end>
            <robot> picks <part> and places at <goal>
        }
    Then:
        in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)
}
"""

STORY = """User Story (ns=t) fetching {
    As A "operator" I Want "parts fetched" So That "work goes on"
    Scenarios:
        Scenario bench-to-tray {
            template: <fetch>
            scene: <bench_scene>
            variation:
                var <fetch.part>: obj set <parts>
                var <fetch.robot>: { <arms.panda> }
                var <fetch.goal>: { <places.bench_ws>, <places.tray_ws> }
        }
}
"""

MODEL = EVENTS + TEMPLATE + STORY
"""A small sound model over ``SCENE``."""

_ENDLESS = """import time

from behave import when


@when('"{agent}" picks "env:ball0" and places it at "{workspace}"')
def wait(context, agent, workspace):
    while True:
        time.sleep(1)
"""
_MARKER = re.compile(r"^(\s*//\s*)(\^+)\s+(\S+)\s*(.*)$")


@dataclass(frozen=True)
class Expected:
    """A diagnostic that a fixture expects."""

    uri: str
    span: Span
    code: str
    words: str


@dataclass(frozen=True)
class Fixture:
    """The project of a fixture, its first file, its cursor (-1 without) and its expectations."""

    project: Project
    uri: str
    cursor: int
    expected: tuple[Expected, ...]

    @property
    def snapshot(self) -> Snapshot:
        return self.project.snapshot()


def fixture(text: str) -> Fixture:
    """Create a project from a fixture's text; without ``//-``, the text is one ``main.bdd``, next to ``lab.scene``."""
    parts = re.split(r"^//- (\S+)\n", text, flags=re.MULTILINE)
    files = dict(zip(parts[1::2], parts[2::2], strict=True)) if len(parts) > 1 else {"main.bdd": text}
    files.setdefault("lab.scene", SCENE)
    project = Project()
    cursor = -1
    expected: list[Expected] = []
    for name, content in files.items():
        if "$0" in content:
            cursor = content.index("$0")
            content = content.replace("$0", "")
        uri = FOLDER + name
        expected += _expectations(uri, content)
        project.open(uri, 1, content)
    return Fixture(project, FOLDER + next(iter(files)), cursor, tuple(expected))


def _expectations(uri: str, text: str) -> list[Expected]:
    document = Document(uri, 0, text)
    found: list[Expected] = []
    marked = 0
    for line in range(len(document.line_starts)):
        match = _MARKER.match(document.line_text(line))
        if match is None:
            marked = line
            continue
        start = document.line_starts[marked] + match.start(2)
        found.append(Expected(uri, Span(start, start + len(match[2])), match[3], match[4]))
    return found


def assert_diagnostics(found: list[Diagnostic], case: Fixture) -> None:
    """Check that exactly the expected diagnostics were found, each at its place with its words."""
    shown = sorted((entry.uri, entry.span, entry.code) for entry in found)
    assert shown == sorted((entry.uri, entry.span, entry.code) for entry in case.expected), found
    for expected in case.expected:
        messages = [entry.message for entry in found if (entry.span, entry.code) == (expected.span, expected.code)]
        assert any(expected.words in message for message in messages), messages


def corpus(*endings: str) -> list[Path]:
    """Return the foreign models named by ``ROBBDD_CORPUS``; skip the test if it is not set."""
    folder = os.environ.get("ROBBDD_CORPUS")
    if not folder:
        pytest.skip("ROBBDD_CORPUS is not set: no foreign models to read")
    return sorted(path for path in Path(folder, "current").rglob("*") if path.suffix in endings)


def command_names() -> set[str]:
    """Return the names of the commands that ``robbdd --help`` lists."""
    with redirect_stdout(StringIO()) as shown, suppress(SystemExit):
        main(["--help"])
    return set(re.findall(r"^    (\w+)", shown.getvalue(), re.MULTILINE))


def make_endless(model: Path) -> None:
    """Let the ball of a copy of the pick-and-place example be on its way for ever, by a step of a user's own.

    A run judges the cube and lasts until it is cancelled.
    """
    steps = model.parent / "steps"
    steps.mkdir()
    (steps / f"{model.stem}_steps.py").write_text(_ENDLESS, encoding="utf-8")


def schema_errors(name: str, document: object) -> list[str]:
    """Return a document's violations of one of the documented JSON Schemas."""
    # jsonschema is untyped.
    validator: Any = import_module("jsonschema").Draft202012Validator
    schema = json.loads((DOCS / "schemas" / name).read_text(encoding="utf-8"))
    as_sent = json.loads(json.dumps(document))
    return [error.message for error in validator(schema).iter_errors(as_sent)]


def make_fifo(path: Path) -> None:
    """Create a named pipe in a folder; skip the test on systems without them."""
    if sys.platform == "win32":
        pytest.skip("Windows has no named pipes in folders")
    os.mkfifo(path)


@contextmanager
def small_disk(folder: Path, kib: int) -> Generator[None]:
    """Mount a file system of a fixed size on an empty folder; skips the test where that is not allowed."""
    command = ["mount", "-t", "tmpfs", "-o", f"size={kib}k", "tmpfs", str(folder)]
    if sys.platform != "linux" or subprocess.run(command, capture_output=True, check=False).returncode:
        pytest.skip("a small file system can be mounted by root on Linux only")
    try:
        yield
    finally:
        subprocess.run(["umount", str(folder)], check=True)


def fill_disk(path: Path) -> None:
    """Write a file until its file system is full."""
    with path.open("wb", buffering=0) as file, suppress(OSError):
        while True:
            file.write(b"x" * 512)


def default_signals() -> None:
    """Let the signals that ask a process to end do so, for ``preexec_fn``.

    A process that is started by ``nohup`` or in the background of a script ignores some of them, and passes that on.
    """
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)


def write_manifest(folder: Path, manifest: Manifest) -> None:
    """Write a whole manifest into a run folder."""
    for _ in written_manifest(folder, manifest, manifest.scenarios):
        pass
