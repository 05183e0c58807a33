"""How fast the physics goes, and how long a user waits for the first verdict."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from kit import EXAMPLES
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.graph.build import build_graph
from robbdd_tools.graph.read import read_model
from robbdd_tools.names.project import Project
from robbdd_tools.run.prepare import RunRequest, prepare
from robbdd_tools.run.protocol import ScenarioFinished
from robbdd_tools.run.scheduler import Policy, Scheduler

MODEL = EXAMPLES / "pickplace" / "pickplace.bdd"


def rows() -> Iterator[tuple[str, str]]:
    """Yield a name and a figure for each measurement."""
    finished = list(_finished())
    simulated = sum(message.simulated for message in finished)
    wall = sum(message.wall for message in finished)
    stepping = sum(message.stepping for message in finished)
    yield "simulated seconds per wall second, one core", f"{simulated / wall:.1f}"
    yield "share of a scenario's wall time inside mj_step", f"{100 * stepping / wall:.0f} %"
    yield "from `robbdd run` to the first scenario's verdicts", f"{_first_verdict():.1f} s"
    yield "processor time of `robbdd --version` beyond the interpreter's", f"{_version():.2f} s"


def _finished() -> Iterator[ScenarioFinished]:
    uri = path_to_uri(MODEL)
    project = Project()
    project.load(uri)
    model = read_model(build_graph(project.snapshot(), uri).graph)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        manifest = prepare(RunRequest(model, MODEL.name), folder)
        for message in Scheduler(folder, manifest, Policy(jobs=1)).messages():
            if isinstance(message, ScenarioFinished):
                yield message


def _first_verdict() -> float:
    start = time.perf_counter()
    command = [sys.executable, "-m", "robbdd_tools.cli", "run", str(MODEL), "--no-store"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, encoding="utf-8") as process:
        assert process.stdout is not None
        process.stdout.readline()
        waited = time.perf_counter() - start
        process.stdout.read()
    return waited


def _version() -> float:
    script = """
import json, resource, subprocess, sys
def used(arguments):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([sys.executable, *arguments], stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
print(json.dumps(used(["-m", "robbdd_tools.cli", "--version"]) - used(["-c", "pass"])))
"""
    return float(json.loads(subprocess.run([sys.executable, "-c", script], capture_output=True, check=True).stdout))
