"""Latency of ``robbdd-lsp`` for an editor, as a separate process, over standard input and output.

Latency is wall time; the server's processor time is measured as well, because other work on the machine does not affect
it.
"""

from __future__ import annotations

import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from tests.bench.client import Client, Message
from tests.bench.models import long_story, model

from kit import EXAMPLES, SCENE

COMMAND = (sys.executable, "-m", "robbdd_tools.lsp.main", "--stdio")
REFRESH = "workspace/inlayHint/refresh"
STARTS = 5
QUESTIONS = 60
PEER = {
    "start": "the peer took 3.0 s",
    "opening, 1027 lines": "the peer took 632 ms",
    "opening, 10003 lines": "the peer took 3937 ms for 5000 lines",
    "keystroke to diagnostics, 1027 lines": "the peer took 456 ms for 70 lines, 400 of them to wait for more changes",
    "keystroke to diagnostics, 10003 lines": "the peer took 4409 ms for 5000 lines",
}
"""Recorded figures of the server of secoro-dsl-nvim, on a machine of the same kind (2 cores at 2.5 GHz), not in this
run: what it needs comes from no package registry. Files of the same length are not the same files."""
ON_EVERY_STROKE = (
    *("textDocument/semanticTokens/full/delta", "textDocument/inlayHint", "robbdd/verdicts", "textDocument/codeLens"),
    *("textDocument/documentSymbol", "textDocument/foldingRange", "textDocument/documentHighlight"),
)
"""Requests of VS Code and our extension after each change of a text: hints of visible lines, verdicts of all lines."""
VISIBLE = 60
"""Lines that an editor shows."""
STAMPS = """import os, time
from pathlib import Path
from robbdd_tools.agent.execution import Execution
from robbdd_tools.agent.scenario_run import ScenarioRun
advance, report = Execution.advance_until, ScenarioRun._report
def stamped(self, satisfied):
    trace = advance(self, satisfied)
    Execution.stamp = time.monotonic()
    return trace
def take_verdict(self, line, verdict):
    if Execution.stamp:
        with Path({path!r}).open("a") as file:
            file.write(f"{{self._index}} {{line}} {{Execution.stamp}}\\n")
    Execution.stamp = 0.0
    return report(self, line, verdict)
Execution.stamp, Execution.advance_until, ScenarioRun._report = 0.0, stamped, take_verdict
"""
"""A user's step file that records when the simulation has progressed as far as a clause needs."""


@dataclass(slots=True)
class Times:
    """Seconds until an editor has its answers, and processor time of the server for each, where that is known."""

    waited: list[float]
    spent: list[float]

    def __str__(self) -> str:
        """Return percentiles in milliseconds."""
        hundredths = statistics.quantiles(self.waited, n=100, method="inclusive")
        p50, p95, p99 = (1000 * hundredths[index] for index in (49, 94, 98))
        spent = f", of which the server computes {1000 * statistics.median(self.spent):.1f} ms" if self.spent else ""
        return f"p50 {p50:.1f}{spent}; p95 {p95:.1f}, p99 {p99:.1f} ms"


class Session:
    """A server with one long document open in it."""

    def __init__(self, client: Client, folder: Path, text: str) -> None:
        self.client = client
        self.folder = folder
        self.uri = (folder / "bench.bdd").as_uri()
        self.text = text
        self.version = 1
        self.document = {"textDocument": {"uri": self.uri}}
        self._coloured = ""

    def opened(self) -> float:
        """Open the document; returns the seconds until its diagnostics are there."""
        began = time.monotonic()
        self.client.open(self.uri, self.text)
        return self.client.wait(self._published)[0] - began

    def typed(self, letter: str, offset: int, asking: bool = False) -> float:
        """Type a letter; returns the seconds until its diagnostics are there, and what VS Code is ``asking`` for."""
        self.client.forget()
        place = self.position(offset)
        self.text = self.text[:offset] + letter + self.text[offset:]
        self.version += 1
        began = time.monotonic()
        document = {**self.document["textDocument"], "version": self.version}
        changes = [{"range": {"start": place, "end": place}, "text": letter}]
        self.client.notify("textDocument/didChange", {"textDocument": document, "contentChanges": changes})
        shown = {"line": max(0, place["line"] - VISIBLE // 2), "character": 0}
        visible = {"start": shown, "end": {"line": shown["line"] + VISIBLE, "character": 0}}
        more = {"previousResultId": self._coloured, "range": visible, "position": place, "uri": self.uri}
        methods = ON_EVERY_STROKE if asking else ()
        asked = [self.client.ask(method, {**self.document, **more}) for method in methods]
        answers = [self.client.answer(number) for number in asked]
        if answers:
            self._coloured = str(answers[0][1]["result"]["resultId"])
        return max(came for came, _ in [self.client.wait(self._published), *answers]) - began

    def asked(self, method: str, parameters: dict[str, Any]) -> float:
        """Ask a question that has an answer; returns the seconds until it is there."""
        began = time.monotonic()
        came, answer = self.client.answer(self.client.ask(method, parameters))
        assert answer["result"], f"{method} answers nothing"
        return came - began

    def colour(self) -> None:
        """Request the colours of the whole document, so that only changes are sent afterwards."""
        tokens = self.client.request("textDocument/semanticTokens/full", self.document)
        self._coloured = str(tokens["resultId"])

    def position(self, offset: int) -> dict[str, int]:
        """Return the place of an offset (all texts here are ASCII)."""
        return {"line": self.text.count("\n", 0, offset), "character": offset - self.text.rfind("\n", 0, offset) - 1}

    def at(self, text: str, behind: str = "") -> dict[str, Any]:
        """Return the parameters of a question about the last place between two texts."""
        offset = self.text.rindex(text + behind) + len(text)
        return {**self.document, "position": self.position(offset)}

    def measured(self, works: Sequence[Callable[[], float]]) -> Times:
        """Execute actions in turn, each of which returns its latency in seconds."""
        times = Times([], [])
        for work in works:
            before = self.client.processor_time()
            times.waited.append(work())
            after = self.client.processor_time()
            if before is not None and after is not None:
                times.spent.append(after - before)
        return times

    def settle(self) -> None:
        """Wait until the server has nothing left to do."""
        self.client.forget()
        before, after = -1.0, self.client.processor_time()
        while after is not None and after - before > 0.001:
            time.sleep(0.2)
            before, after = after, self.client.processor_time()

    def _published(self, message: Message) -> bool:
        return (
            message.get("method") == "textDocument/publishDiagnostics"
            and message["params"]["uri"] == self.uri
            and message["params"].get("version") == self.version
        )


def rows() -> Iterator[tuple[str, str]]:
    """Yield a name and a figure for each measurement."""
    yield _starts()
    for lines in (1000, 10_000):
        text = model(lines)
        yield from _one_file(text, f"{text.count(chr(10))} lines", " ( more: holds(<part> is located at", _then)
    text = long_story(10_000)
    typed = " var <fetch1.goal1>: { <places.bench_ws>"
    yield from _one_file(text, "one story of 10000 lines", typed, _variation)
    yield from _status()


def with_peer(name: str, figure: str) -> tuple[str, str]:
    """Return a row with the peer's figure, if any."""
    return name, f"{figure}; {PEER[name]}" if name in PEER else figure


def _then(text: str) -> int:
    return text.index("Then:", len(text) // 2) + len("Then:")


def _variation(text: str) -> int:
    return text.index("variation:", len(text) // 2) + len("variation:")


def _starts() -> tuple[str, str]:
    """Measure a server that is started with the example."""
    path = EXAMPLES / "pickplace" / "pickplace.bdd"
    text = path.read_text(encoding="utf-8")
    seconds: list[float] = []
    spent: list[float] = []
    for _ in range(STARTS):
        with Client(COMMAND) as client:
            session = Session(client, path.parent, text)
            client.initialize(path.parent)
            began = time.monotonic()
            seconds.append(began - client.started + session.opened())
            spent.append(client.processor_time() or 0.0)
    own, computing = statistics.median(seconds), statistics.median(spent)
    libraries = statistics.median(_import_time("pygls.lsp.server") for _ in range(STARTS))
    note = f"{computing:.2f} s of which the server computes, {computing / libraries:.1f} × as long as importing pygls"
    return "start to first diagnostics", f"{own:.2f} s, {note}; {PEER['start']}"


def _import_time(module: str) -> float:
    """Return the processor time (s) of an interpreter that imports a module."""
    script = f"import time, {module}; print(time.process_time())"
    return float(subprocess.run([sys.executable, "-c", script], capture_output=True, check=True, text=True).stdout)


def _one_file(text: str, name: str, typed: str, place: Callable[[str], int]) -> Iterator[tuple[str, str]]:
    """Measure a long file with edits in the middle; ``place`` finds where."""
    with tempfile.TemporaryDirectory() as folder, Client(COMMAND) as client:
        (Path(folder) / "lab.scene").write_text(SCENE, encoding="utf-8")
        client.initialize(Path(folder))
        session = Session(client, Path(folder), text)
        before, opened = client.processor_time() or 0.0, session.opened()
        spent = 1000 * ((client.processor_time() or 0.0) - before)
        yield with_peer(f"opening, {name}", f"{1000 * opened:.0f} ms, of which the server computes {spent:.0f} ms")
        session.settle()
        top = {"start": {"line": 0, "character": 0}, "end": {"line": 60, "character": 0}}
        questions: dict[str, dict[str, Any]] = {
            "completion": session.at("template: <", "fetch"),
            "hover": session.at("template: <fet"),
            "definition": session.at("template: <fet"),
            "semanticTokens/range": {**session.document, "range": top},
            "semanticTokens/full": session.document,
        }
        for method, parameters in questions.items():
            work = partial(session.asked, f"textDocument/{method}", parameters)
            yield f"{method}, {name}", str(session.measured([work] * QUESTIONS))
        start = place(session.text)
        strokes = [partial(session.typed, letter, start + number) for number, letter in enumerate(typed)]
        yield with_peer(f"keystroke to diagnostics, {name}", _beside(session.measured(strokes), spent))
        session.colour()
        strokes = [partial(session.typed, letter, start + number, True) for number, letter in enumerate(typed)]
        yield f"keystroke to all that VS Code asks for, {name}", _beside(session.measured(strokes), spent)


def _beside(times: Times, opening: float) -> str:
    """Return times beside the processor time (ms) of opening the same file in the same run: machines differ."""
    ratio = f"; opening computes {opening / 1000 / statistics.median(times.spent):.0f} × as long" if times.spent else ""
    return f"{times}{ratio}"


def _judged(message: Message) -> tuple[int, int] | None:
    """Return the scenario and the line of the clause whose verdict a message contains."""
    if message.get("method") != "robbdd/runMessage":
        return None
    note: Message = message["params"]["message"]
    return (note["index"], note["line"]) if note["type"] == "ClauseJudged" else None


def _refresh_behind(clauses: Collection[tuple[int, int]]) -> Callable[[Message], bool]:
    """Return what recognises the refresh of hints that follows the verdicts of all clauses."""
    missing = set(clauses)

    def is_wanted(message: Message) -> bool:
        if (clause := _judged(message)) is not None:
            missing.discard(clause)
        return not missing and message.get("method") == REFRESH

    return is_wanted


def _status() -> Iterator[tuple[str, str]]:
    """Measure how soon a client receives the results of a clause's simulation."""
    with tempfile.TemporaryDirectory() as name:
        folder, stamps = Path(name) / "pickplace", Path(name) / "stamps"
        shutil.copytree(EXAMPLES / "pickplace", folder)
        (folder / "steps").mkdir()
        (folder / "steps" / "pickplace_steps.py").write_text(STAMPS.format(path=str(stamps)), encoding="utf-8")
        path = folder / "pickplace.bdd"
        with Client(COMMAND) as client:
            client.initialize(folder)
            client.open(path.as_uri(), path.read_text(encoding="utf-8"))
            client.wait(lambda message: message.get("method") == "textDocument/publishDiagnostics")
            client.request("workspace/executeCommand", {"command": "robbdd.run", "arguments": [{"uri": path.as_uri()}]})
            decided = {(int(index), int(line)): float(at) for index, line, at in map(str.split, stamps.open())}
            # The answer may arrive before the last refresh.
            client.wait(_refresh_behind(decided))
            heard = client.heard()
    note = {clause: came for came, message in heard if (clause := _judged(message)) is not None}
    refreshed = [came for came, message in heard if message.get("method") == REFRESH]
    messages = Times([note[clause] - at for clause, at in decided.items()], [])
    hints = Times([min(came for came in refreshed if came > note[clause]) - at for clause, at in decided.items()], [])
    yield f"event in simulation to the client's run message, {len(decided)} clauses", str(messages)
    yield f"event in simulation to the refresh of hints, {len(decided)} clauses", str(hints)
