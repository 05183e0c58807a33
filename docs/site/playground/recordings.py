"""Records executions of examples for the playground: ``python recordings.py FOLDER``, some seconds for each."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from robbdd_tools.run.json_documents import find_trace, trace_document
from robbdd_tools.run.store import RunStore

ROOT = Path(__file__).parents[3]
RECORDED: Mapping[str, tuple[str, ...]] = {
    "pickplace": ("--first", "1"),
    "deadlines": ("--scenario", "two-limits"),
    "drawer": ("--first", "1"),
}
"""The examples with a recording, and options that select what is executed; the first violated scenario is shown."""


def record(example: str, options: tuple[str, ...]) -> dict[str, Any]:
    """Execute an example, and return a recorded execution as the language server sends it, without places."""
    (model,) = (ROOT / "examples" / example).glob("*.bdd")
    with TemporaryDirectory() as folder:
        run = [sys.executable, "-m", "robbdd_tools", "run", model, *options, "--output", f"{folder}/run"]
        done = subprocess.run(run, capture_output=True, text=True)
        if done.returncode > 1:
            raise SystemExit(done.stdout + done.stderr)
        found = trace_document(*find_trace(RunStore(Path(folder)), f"{folder}/run", {}))
    clauses = [{**clause, "source": None, "stale": False} for clause in found["clauses"]]
    for clause in clauses:
        del clause["written"]
    return {**found, "folder": "", "source": None, "clauses": clauses}


def write(folder: Path) -> None:
    """Write the recordings and the list of their examples."""
    folder.mkdir(parents=True, exist_ok=True)
    for example, options in RECORDED.items():
        text = json.dumps(record(example, options), separators=(",", ":"))
        (folder / f"{example}.json").write_text(text, encoding="utf-8")
    (folder / "index.json").write_text(json.dumps(sorted(RECORDED)), encoding="utf-8")


if __name__ == "__main__":
    write(Path(sys.argv[1]))
