"""Executes a prepared run folder in view of the user."""

from __future__ import annotations

import signal
import threading
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

from robbdd_tools.commands.progress import Display
from robbdd_tools.run.protocol import RunStarted
from robbdd_tools.run.results import RunResults
from robbdd_tools.run.scheduler import Scheduler

if TYPE_CHECKING:
    from pathlib import Path
    from types import FrameType

    from robbdd_tools.run.protocol import Manifest
    from robbdd_tools.run.scheduler import Policy


def execute(
    folder: Path, manifest: Manifest, policy: Policy, indices: Sequence[int] | None = None
) -> tuple[RunResults, str, bool]:
    """Run a prepared folder, or some scenarios of it; Ctrl-C ends it and keeps what is finished.

    Returns the results, the simulator's name and version, and whether the run was interrupted. Raises ``OSError``.
    """
    results, simulator = RunResults(manifest), ""
    with Display(results, None if indices is None else len(indices)) as display:
        scheduler = Scheduler(folder, manifest, policy, display.watch, indices)
        with _ctrl_c_cancels(scheduler) as interrupted:
            for message in scheduler.messages():
                results.apply(message)
                display.show(message)
                if isinstance(message, RunStarted):
                    simulator = message.simulator
        if not results.complete:
            reason = "the run was interrupted" if interrupted.is_set() else scheduler.ending
            results.close(reason)
            display.broken(reason)
        display.summary()
    return results, simulator, interrupted.is_set()


@contextmanager
def _ctrl_c_cancels(scheduler: Scheduler) -> Generator[threading.Event]:
    """Let Ctrl-C cancel a run instead of breaking off whatever is being done; yields whether it was pressed."""
    pressed = threading.Event()

    def cancel(_signal: int, _frame: FrameType | None) -> None:
        pressed.set()
        scheduler.cancel()

    before = signal.signal(signal.SIGINT, cancel)
    try:
        yield pressed
    finally:
        signal.signal(signal.SIGINT, before)
