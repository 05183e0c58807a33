"""Speed of the physics, and a user's waiting time for the first verdict."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from copy import copy
from itertools import pairwise
from pathlib import Path
from typing import Any

from kit import EXAMPLES, default_signals
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.graph.read.acceptance import read_model
from robbdd_tools.graph.write.build import build_graph
from robbdd_tools.names.project import Project
from robbdd_tools.protocol.messages import RunMessage, RunStarted, ScenarioFinished
from robbdd_tools.run.prepare import RunRequest, prepare
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.run.scheduler import Scheduler
from robbdd_tools.world.engine import SUBSTEPS, TICK, mujoco
from world.worlds import BALL, CUBE, OTHER_WS, PANDA, execution, pick_place

MODEL = EXAMPLES / "pickplace" / "pickplace.bdd"
SEEDS = 8
"""Executions that are compared with the engine alone."""
INTERRUPTIONS = 5
"""Runs that are cancelled in their middle."""


def rows() -> Iterator[tuple[str, str]]:
    """Yield a name and a figure for each measurement."""
    messages = list(_messages())
    finished = [message for _, message in messages if isinstance(message, ScenarioFinished)]
    started = next(at for at, message in messages if isinstance(message, RunStarted))
    simulated = sum(message.simulated for message in finished)
    wall = sum(message.wall for message in finished)
    stepping = sum(message.stepping for message in finished)
    yield "simulated seconds per wall second, one core", f"{simulated / wall:.1f}"
    yield "share of a scenario's wall time inside mj_step", f"{100 * stepping / wall:.0f} %"
    whole, bare = _steps()
    yield "physics steps per second of whole executions", f"{whole:.0f}, {100 * whole / bare:.0f} % of a bare loop"
    yield "start-up of an agent process", f"{started:.1f} s"
    yield "memory of an agent process, at most", f"{_memory():.0f} MB"
    yield "from `robbdd run` to the first scenario's verdicts", f"{_first_verdict():.1f} s"
    yield f"from Ctrl-C to the end of `robbdd run`, longest of {INTERRUPTIONS}", f"{_cancelled():.2f} s"
    yield "processor time of `robbdd --version` beyond the interpreter's", f"{_version():.2f} s"


def _messages() -> Iterator[tuple[float, RunMessage]]:
    """Yield the messages of a run of the example with the seconds since its agent was started."""
    uri = path_to_uri(MODEL)
    project = Project()
    project.load(uri)
    model = read_model(build_graph(project.snapshot(), uri).graph)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        manifest = prepare(RunRequest(model, MODEL.name), folder)
        began = time.perf_counter()
        for message in Scheduler(folder, manifest, Policy(jobs=1)).messages():
            yield time.perf_counter() - began, message


def _steps() -> tuple[float, float]:
    """Physics steps per second: of executions as a whole, set-up included, and of the engine alone.

    The engine alone starts from the same settled worlds and gets the same controls, so that it computes the same.
    """
    spent, stepping, ticks = 0.0, 0.0, 0
    for seed in range(SEEDS):
        calls = [pick_place((CUBE, BALL)[seed % 2], OTHER_WS)]
        began = time.perf_counter()
        run = execution(calls, seed=seed)
        run.advance_until(lambda _: False)
        spent += time.perf_counter() - began
        again = execution(calls, seed=seed)
        data = again.simulation.data
        start, controls = copy(data), [(data.act.copy(), data.ctrl.copy())]

        def note(data: Any = data, controls: list[tuple[Any, Any]] = controls) -> None:
            controls.append((data.act.copy(), data.ctrl.copy()))

        again.simulation.watchers.append(note)
        again.advance_until(lambda _: False)
        servos = again.simulation.robots[PANDA].motors
        for (before, _), (after, control) in pairwise(controls):
            control[servos] = (after - before) / TICK
        began = time.perf_counter()
        for _, control in controls[1:]:
            start.ctrl[:] = control
            mujoco.mj_step(again.simulation.model, start, nstep=SUBSTEPS)
        stepping += time.perf_counter() - began
        ticks += run.simulation.ticks
        assert abs(start.qpos - data.qpos).max() < 1e-6, "the bare loop computed something else"
    return SUBSTEPS * ticks / spent, SUBSTEPS * ticks / stepping


def _memory() -> float:
    """Return the resident memory (MB) of the largest process that a run of the example starts."""
    script = """
import resource, sys
sys.path[:0] = sys.argv[1:]
from tests.bench.running import _messages
list(_messages())
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024)
"""
    places = [str(Path(__file__).parents[2]), str(Path(__file__).parents[1])]
    return float(subprocess.run([sys.executable, "-c", script, *places], capture_output=True, check=True).stdout)


def _first_verdict() -> float:
    start = time.perf_counter()
    with _run_of_the_example() as process:
        assert process.stdout is not None
        process.stdout.readline()
        waited = time.perf_counter() - start
        process.stdout.read()
    return waited


def _cancelled() -> float:
    """Return the longest time (s) that runs take to end when interrupted after their first line."""
    longest = 0.0
    for _ in range(INTERRUPTIONS):
        with _run_of_the_example("--repeat", "100", "--jobs", "2", "--every-clause") as process:
            assert process.stdout is not None
            process.stdout.readline()
            began = time.perf_counter()
            process.send_signal(signal.SIGINT)
            process.stdout.read()
            assert process.wait() == 130, "the run has not been cancelled"
        longest = max(longest, time.perf_counter() - began)
    return longest


def _run_of_the_example(*options: str) -> subprocess.Popen[str]:
    command = [sys.executable, "-m", "robbdd_tools.cli", "run", str(MODEL), "--no-store", *options]
    return subprocess.Popen(command, stdout=subprocess.PIPE, encoding="utf-8", preexec_fn=default_signals)


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
