"""Several real agent processes: the same results for any number, and no fault ends the run."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from time import monotonic

import pytest

from kit import make_fifo
from robbdd_tools.protocol.manifest_file import read_manifest
from robbdd_tools.protocol.messages import (
    ClauseJudged,
    ClauseStarted,
    LogLine,
    Output,
    RunFinished,
    RunMessage,
    RunStarted,
    ScenarioFinished,
    ScenarioStarted,
)
from robbdd_tools.protocol.specs import Manifest
from robbdd_tools.run.results import RunResults
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.run.scheduler import CANCELLED, STOPPED, Scheduler, ignore_event
from world.worlds import CUBE, SCENE, Steps, write_run

pytestmark = [pytest.mark.physics, pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")]
HOLDS = ("given", f'"{CUBE}" is located at "env:bench_ws" before event "t:end"')
VIOLATED = ("given", f'"{CUBE}" is located at "env:bin1_ws" before event "t:end"')
USER_STEPS = """
import os, signal, time
from behave import given

@given("a hang")
def hang(context):
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGTERM, signal.SIGINT})
    os.close(os.open(os.environ["ROBBDD_TEST_FIFO"], os.O_WRONLY))
    while True:
        time.sleep(60)

@given("an exit")
def leave(context):
    os._exit(7)

@given("an error")
def fail(context):
    raise RuntimeError("broken")
"""


def prepared(folder: Path, *scenarios: Sequence[tuple[str, str]], user: str = USER_STEPS) -> Manifest:
    write_run(folder, [Steps(tuple(steps), SCENE, seed) for seed, steps in enumerate(scenarios)])
    (folder / "features" / "steps" / "model_steps.py").write_text(user)
    return read_manifest(folder)


def run(
    folder: Path, manifest: Manifest, policy: Policy, watch: Callable[[RunMessage], None] = ignore_event
) -> tuple[RunResults, list[RunMessage], str]:
    results, scheduler = RunResults(manifest), Scheduler(folder, manifest, policy, watch)
    messages = list(scheduler.messages())
    for message in messages:
        results.apply(message)
    return results, messages, scheduler.ending


def verdicts(results: RunResults) -> list[str]:
    return [str(scenario.verdict) for scenario in results.scenarios]


def reasons(results: RunResults, index: int) -> set[str]:
    return {judged.reason for judged in results.scenarios[index].judged.values()}


def reasons_without_places(results: RunResults, index: int) -> set[str]:
    """Without the file and the line of a loop, which may be at any of its lines."""
    return {reason.partition(" (")[0] for reason in reasons(results, index)}


def test_messages_do_not_depend_on_the_number_of_jobs(tmp_path: Path) -> None:
    manifest = prepared(tmp_path / "run", *([HOLDS] if seed % 3 else [HOLDS, VIOLATED] for seed in range(7)))
    found: list[list[RunMessage]] = []
    for jobs in (1, 2, 3):
        results, messages, ending = run(tmp_path / "run", manifest, Policy(jobs))
        assert (results.complete, ending) == (True, "")
        timeless = (
            ScenarioFinished(m.index, m.simulated, 0, 0) if isinstance(m, ScenarioFinished) else m for m in messages
        )
        found.append(list(timeless))
    assert found[0] == found[1] == found[2]
    assert isinstance(found[0][0], RunStarted)
    assert found[0][-1] == RunFinished(True)


def test_a_killed_agent_costs_one_scenario_and_the_rest_goes_on(tmp_path: Path) -> None:
    manifest = prepared(tmp_path / "run", *[[HOLDS]] * 5)

    def kill(message: RunMessage) -> None:
        if message == ScenarioStarted(2):
            (pid,) = (pid for pid, index in scheduler.busy.items() if index == 2)
            os.kill(pid, signal.SIGKILL)

    scheduler = Scheduler(tmp_path / "run", manifest, Policy(2), kill)
    results = RunResults(manifest)
    for message in scheduler.messages():
        results.apply(message)
    assert verdicts(results) == ["holds", "holds", "unknown", "holds", "holds"]
    assert reasons(results, 2) == {"the agent process ended unexpectedly with signal SIGKILL (often: memory ran out)"}
    assert results.complete


def test_a_module_that_ends_the_process_costs_one_scenario(tmp_path: Path) -> None:
    manifest = prepared(tmp_path / "run", [HOLDS], [HOLDS, ("given", "an exit"), HOLDS], [HOLDS])
    results, _, _ = run(tmp_path / "run", manifest, Policy(1))
    assert verdicts(results) == ["holds", "unknown", "holds"]
    assert [judged.verdict for judged in results.scenarios[1].judged.values()] == ["holds", "unknown", "unknown"]
    steps = tmp_path / "run" / "features" / "steps" / "model_steps.py"
    assert reasons(results, 1) == {"", f"model_steps:leave failed: the process ended with code 7 ({steps}:14)"}


def test_a_step_that_raises_costs_no_other_step(tmp_path: Path) -> None:
    manifest = prepared(tmp_path / "run", [("given", "an error"), HOLDS], [HOLDS])
    results, _, _ = run(tmp_path / "run", manifest, Policy(1))
    assert verdicts(results) == ["unknown", "holds"]
    assert [judged.verdict for judged in results.scenarios[0].judged.values()] == ["unknown", "holds"]


def test_steps_that_cannot_be_loaded_are_said_once(tmp_path: Path) -> None:
    manifest = prepared(tmp_path / "run", [HOLDS], [HOLDS], [HOLDS], user="import no_such_module\n")
    results, _, ending = run(tmp_path / "run", manifest, Policy(2))
    assert not results.complete
    assert "No module named 'no_such_module'" in ending


def test_output_of_shared_code_is_shown_once_whichever_process_is_ahead(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    manifest = prepared(tmp_path / "run", [HOLDS], [HOLDS])
    first_may_speak = threading.Event()

    class FakeAgent:
        """The second process prints and fails while the first one still loads; then the first prints the same."""

        pid = 0

        def __init__(self, *arguments: object, **options: object) -> None:
            self.number = arguments[1]
            assert "log_limit" in options

        def execute(self, index: int) -> None: ...
        def terminate(self) -> None: ...
        def wait(self, seconds: float) -> None: ...
        def kill(self) -> None: ...
        def finish(self) -> None: ...

        def messages(self) -> Iterator[RunMessage]:
            if self.number == 1:
                first_may_speak.wait(60)
            yield Output(None, "loading")
            if self.number == 2:
                yield Output(None, "loaded")
                first_may_speak.set()
                return
            yield RunFinished(False)

    monkeypatch.setattr("robbdd_tools.run.scheduler.Agent", FakeAgent)
    _, messages, _ = run(tmp_path / "run", manifest, Policy(2))
    assert [message.text for message in messages if isinstance(message, Output)] == ["loading", "loaded"]


def test_features_that_cannot_be_read_are_said_once(tmp_path: Path) -> None:
    manifest = prepared(tmp_path / "run", [HOLDS], [HOLDS])
    (tmp_path / "run" / "features" / "fetching.feature").write_text("Scenario: of no feature\n")
    results, messages, _ = run(tmp_path / "run", manifest, Policy(2))
    assert verdicts(results) == ["unknown", "unknown"]
    (complaint,) = [message for message in messages if isinstance(message, LogLine)]
    assert complaint.text.startswith("behave cannot run the features:")


@pytest.fixture
def fifo(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    path = tmp_path / "fifo"
    make_fifo(path)
    monkeypatch.setenv("ROBBDD_TEST_FIFO", str(path))
    return path


def test_a_hang_is_timed_out_and_the_rest_goes_on(tmp_path: Path, fifo: Path) -> None:
    manifest = prepared(tmp_path / "run", [HOLDS], [HOLDS, ("given", "a hang")], [HOLDS])
    threading.Thread(target=fifo.read_bytes, daemon=True).start()
    results, messages, _ = run(tmp_path / "run", manifest, Policy(2, timeout=10.0))
    assert verdicts(results) == ["holds", "unknown", "holds"]
    begun = [message.line for message in messages if isinstance(message, ClauseStarted) and message.index == 1]
    assert begun == [clause.line for clause in manifest.scenarios[1].clauses], "each once, the user's step, too"
    assert reasons_without_places(results, 1) == {"", "model_steps:hang failed: timed out after 10 s"}
    assert results.complete


def test_a_run_is_cancelled_within_half_a_second_even_when_agents_hang(tmp_path: Path, fifo: Path) -> None:
    hang = [HOLDS, ("given", "a hang")]
    manifest = prepared(tmp_path / "run", [HOLDS], hang, hang, [HOLDS])
    results, first_is_done = RunResults(manifest), threading.Event()

    def watch(message: RunMessage) -> None:
        if isinstance(message, ScenarioFinished):
            first_is_done.set()

    scheduler = Scheduler(tmp_path / "run", manifest, Policy(2), watch)

    def follow() -> None:
        for message in scheduler.messages():
            results.apply(message)

    thread = threading.Thread(target=follow)
    thread.start()
    fifo.read_bytes()
    first_is_done.wait()
    pids = list(scheduler.busy)
    began = monotonic()
    scheduler.cancel()
    thread.join()
    assert monotonic() - began < 0.5
    assert scheduler.ending == CANCELLED
    assert not results.complete
    assert results.scenarios[0].verdict == "holds"
    for pid in pids:
        with pytest.raises(ProcessLookupError):
            os.kill(pid, 0)


@pytest.mark.parametrize("jobs", [1, 3])
def test_the_first_failure_ends_the_run_the_same_way_with_any_number_of_jobs(tmp_path: Path, jobs: int) -> None:
    manifest = prepared(tmp_path / "run", [HOLDS], [HOLDS, HOLDS, VIOLATED], [VIOLATED], [HOLDS], [VIOLATED])
    results, messages, ending = run(tmp_path / "run", manifest, Policy(jobs, stop_on_failure=True))
    assert ending == STOPPED
    assert not results.complete
    judged = [message.index for message in messages if isinstance(message, ClauseJudged)]
    assert judged == [0, 1, 1, 1]
    assert [scenario.finished is not None for scenario in results.scenarios] == [True, True, False, False, False]


def test_a_failure_at_the_end_leaves_nothing_out(tmp_path: Path) -> None:
    manifest = prepared(tmp_path / "run", [HOLDS], [VIOLATED])
    results, _, ending = run(tmp_path / "run", manifest, Policy(2, stop_on_failure=True))
    assert (results.complete, ending) == (True, "")
