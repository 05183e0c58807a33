"""The only thread that uses the project. It does urgent work first, in the order of messages, then other work."""

from __future__ import annotations

import asyncio
import threading
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any, TypeVar

from robbdd_tools.base.checkpoint import Abandoned, watched

Result = TypeVar("Result")


class Urgency(IntEnum):
    """How soon work is done. Work with a smaller value interrupts work with a larger one."""

    URGENT = 0
    """Edits, and requests that the user waits for."""
    LATER = 1
    """Results that are shown without a request, such as diagnostics."""
    IDLE = 2
    """Preparations for later requests."""


@dataclass(eq=False)
class _Job:
    work: Callable[[], Any]
    urgency: Urgency
    replacing: str | None
    done: Future[Any] = field(default_factory=Future[Any])
    abandoned: bool = False


class AnalysisThread:
    """Executes the most urgent work first, and work of the same urgency in the order of arrival.

    At a checkpoint, more urgent work interrupts work, and work whose caller was cancelled ends. So a hover never waits
    for the diagnostics of a large file, and no result is wasted. An edit also ends at a checkpoint if the next item is
    an edit of the same text that replaces it.
    """

    def __init__(self) -> None:
        self._waiting: dict[Urgency, deque[_Job]] = {urgency: deque() for urgency in Urgency}
        self._running: list[_Job] = []
        self._changed = threading.Condition()
        self._stopped = False
        threading.Thread(target=self._work, name="analysis", daemon=True).start()

    async def do(
        self, work: Callable[[], Result], urgency: Urgency = Urgency.URGENT, replacing: str | None = None
    ) -> Result:
        """Execute ``work`` in the analysis thread and return its result.

        If the caller is cancelled, the work is skipped or ends at its next checkpoint. If newer work has the same key
        ``replacing``, it may be executed instead; then ``Abandoned`` is raised. If the thread is stopped in the
        meantime, the caller is cancelled.
        """
        job = _Job(work, urgency, replacing)
        with self._changed:
            self._waiting[urgency].append(job)
            self._changed.notify()
        try:
            return await asyncio.wrap_future(job.done)
        except asyncio.CancelledError:
            job.abandoned = True
            raise
        except Abandoned:
            if self._stopped:  # the session ends: nobody waits for the result
                raise asyncio.CancelledError from None
            raise
        finally:
            del job  # as in _run

    def stop(self) -> None:
        """Start no further work."""
        with self._changed:
            self._stopped = True
            for waiting in self._waiting.values():
                waiting.clear()
            self._changed.notify()

    def _work(self) -> None:
        with watched(self._look):
            while (job := self._next()) is not None:
                self._run(job)

    def _next(self) -> _Job | None:
        with self._changed:
            self._changed.wait_for(lambda: self._stopped or any(self._waiting.values()))
            return None if self._stopped else self._more_urgent_than(None)

    def _more_urgent_than(self, running: Urgency | None) -> _Job | None:
        for urgency, waiting in self._waiting.items():
            if running is not None and urgency >= running:
                return None
            if waiting:
                return waiting.popleft()
        return None

    def _run(self, job: _Job) -> None:
        if not job.done.set_running_or_notify_cancel():
            return
        self._running.append(job)
        try:
            job.done.set_result(job.work())
        # Any exception belongs to the caller: this thread must survive.
        except BaseException as error:
            job.done.set_exception(error)
        finally:
            self._running.pop()
            # An error refers to this frame: with the job in it, the error, its future and the snapshot of the work
            # would be a reference cycle.
            del job

    def _look(self) -> None:
        while (job := self._more_urgent_than(self._running[-1].urgency)) is not None:
            self._run(job)
        if self._stopped or self._is_over(self._running[-1]):
            raise Abandoned

    def _is_over(self, job: _Job) -> bool:
        # A request between two edits must see the first one.
        urgent = self._waiting[Urgency.URGENT]
        replaced = job.replacing is not None and bool(urgent) and urgent[0].replacing == job.replacing
        return job.abandoned or replaced
