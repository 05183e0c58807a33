"""Executes a prepared run folder in view of the user."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.processes import end_requests
from robbdd_tools.commands.progress import Display
from robbdd_tools.run.protocol import RunStarted
from robbdd_tools.run.recording import OtherSimulator, why
from robbdd_tools.run.results import RunResults
from robbdd_tools.run.scheduler import Scheduler

if TYPE_CHECKING:
    from pathlib import Path

    from robbdd_tools.run.protocol import Manifest, RunMessage
    from robbdd_tools.run.recording import Recording
    from robbdd_tools.run.scheduler import Policy


@dataclass(slots=True)
class Executed:
    """What came of a run: its results, the simulator's name and version, what ended it early.

    ``signal`` is the number of the signal that did, ``problem`` why the run could not go on.
    """

    results: RunResults
    simulator: str = ""
    signal: int = 0
    problem: str = ""


def execute(folder: Path, manifest: Manifest, policy: Policy, indices: Sequence[int] | None = None) -> Executed:
    """Run a prepared folder, or some scenarios of it, without keeping anything; signals end it in good order.

    Raises ``OSError``.
    """
    executed = Executed(RunResults(manifest))
    with Display(executed.results, None if indices is None else len(indices)) as display:
        reason = _follow(Scheduler(folder, manifest, policy, display.watch, indices), executed, display)
        if not executed.results.complete:
            executed.results.close(reason)
            display.broken(reason)
        display.summary(executed.results)
    return executed


def record(
    folder: Path,
    manifest: Manifest,
    policy: Policy,
    recording: Recording,
    results: RunResults,
    indices: Sequence[int] | None = None,
) -> Executed:
    """Run a prepared folder, or some scenarios of it, keeping each finished execution before it is shown.

    ``results`` are those of a run that goes on, with what is finished of it. Raises ``OSError``.
    """
    executed = Executed(results)
    with Display(results) as display:

        def watch(message: RunMessage) -> None:
            if recording.take(message):
                display.watch(message)

        scheduler = Scheduler(folder, manifest, policy, watch, indices)
        try:
            reason = _follow(scheduler, executed, display, recording.is_news)
        except OtherSimulator as error:
            executed.problem = reason = str(error)
        except OSError as error:
            executed.problem = reason = why(error)
        try:
            executed.results = recording.end(reason, interrupted=bool(executed.signal))
        except OSError as error:
            executed.problem = executed.problem or why(error)
            executed.results.close(executed.problem)
        if not executed.results.complete:
            display.broken(executed.results.ending)
        display.summary(executed.results)
    return executed


def _follow(
    scheduler: Scheduler, executed: Executed, display: Display, is_news: Callable[[RunMessage], bool] = lambda _: True
) -> str:
    """Execute and show what is news; returns why scenarios were left open, nothing where none was."""

    def cancel(number: int) -> None:
        executed.signal = number
        scheduler.cancel()

    # Nothing that is being done is broken off.
    with end_requests(cancel):
        for message in scheduler.messages():
            if isinstance(message, RunStarted):
                executed.simulator = message.simulator
            if is_news(message):
                executed.results.apply(message)
                display.show(message)
    return "the run was interrupted" if executed.signal else scheduler.ending
