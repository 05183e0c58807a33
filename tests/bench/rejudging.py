"""Latency from the last key of an edit to the verdicts of stored traces, against executing the scenarios."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from tests.bench.client import Client, Message
from tests.bench.editor import COMMAND, Session, Times

from kit import EXAMPLES

REPETITIONS = 25
"""Of four scenarios, so that 100 traces are judged."""
EDITS = 20
GOAL = "at-goal: holds(<thing> is located at <goal>, "
EVENTS = ("after <evt-pick-end>", "before <evt-pick-end>")
"""Times at which no object is at its goal."""
STATED = "after <evt-place-end>"


def rows() -> Iterator[tuple[str, str]]:
    """Yield a name and a figure for each measurement."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "pickplace"
        shutil.copytree(EXAMPLES / "pickplace", folder)
        path = folder / "pickplace.bdd"
        began = time.monotonic()
        command = [sys.executable, "-m", "robbdd_tools.cli", "run", str(path), "--repeat", str(REPETITIONS)]
        subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
        executed = time.monotonic() - began
        with Client(COMMAND) as client:
            client.initialize(folder)
            session = Session(client, folder, path.read_text(encoding="utf-8"))
            session.uri = path.as_uri()
            client.open(session.uri, session.text)
            first = _edited(session, STATED, EVENTS[0])
            places = (EVENTS[number % 2] for number in range(EDITS + 1))
            waited = [_edited(session, old, new) for old, new in _pairs(places)]
    times = Times(waited, [])
    ratio = executed / sorted(waited)[len(waited) // 2]
    compared = f"{1000 * first:.0f} ms for an edit right after opening; executing them takes {ratio:.0f} times as long"
    yield f"last key to the verdicts of {4 * REPETITIONS} stored traces", f"{times}; {compared}"


def _pairs(texts: Iterator[str]) -> Iterator[tuple[str, str]]:
    old = next(texts)
    for new in texts:
        yield old, new
        old = new


def _edited(session: Session, old: str, new: str) -> float:
    """Replace the time of a clause, and return the seconds until the verdicts of all traces are published."""
    session.client.forget()
    offset = session.text.index(GOAL + old) + len(GOAL)
    place = {"start": session.position(offset), "end": session.position(offset + len(old))}
    session.text = session.text[:offset] + new + session.text[offset + len(old) :]
    session.version += 1
    document = {"uri": session.uri, "version": session.version}
    began = time.monotonic()
    session.client.notify(
        "textDocument/didChange", {"textDocument": document, "contentChanges": [{"range": place, "text": new}]}
    )
    version, total = session.version, f"0 of {4 * REPETITIONS} hold"

    def is_judged(message: Message) -> bool:
        if message.get("method") != "textDocument/publishDiagnostics" or message["params"].get("version") != version:
            return False
        found = message["params"]["diagnostics"]
        return any(one.get("code") == "clause-rejudged" and total in one["message"] for one in found)

    return session.client.wait(is_judged)[0] - began
