"""Keeps the validation process busy with the newest revision and drops what comes late."""

from __future__ import annotations

import asyncio
import logging
import pickle
import sys
from asyncio.subprocess import PIPE, Process
from collections.abc import Callable
from contextlib import suppress

from robbdd_tools.lsp.worker import LENGTH, Answer, Request, frame

PAUSE = 0.25
"""Seconds without an edit before validation starts."""
# Not "-m": the messages' classes must have the same module name in both processes.
_WORKER = "from robbdd_tools.lsp.worker import main; main()"
_LOG = logging.getLogger(__name__)


class ShapeValidator:
    """Validates files in a worker process, one at a time, the newest request of each file only.

    ``deliver`` gets each answer whose request is still the newest of its file. The process is started with the
    first request and again when it died.
    """

    def __init__(self, deliver: Callable[[Answer], None]) -> None:
        self._deliver = deliver
        self._waiting: dict[str, Request] = {}
        self._newest: dict[str, int] = {}
        self._task: asyncio.Task[None] | None = None
        self._process: Process | None = None

    def request(self, request: Request) -> None:
        """Ask for a validation; an older request for the same file is forgotten."""
        self._waiting[request.uri] = request
        self._newest[request.uri] = request.revision
        if self._task is None or self._task.done():
            self._task = asyncio.get_running_loop().create_task(self._work())
            self._task.add_done_callback(_report)

    def forget(self, uri: str) -> None:
        """Drop requests and late answers for a closed file."""
        self._waiting.pop(uri, None)
        self._newest.pop(uri, None)

    def stop(self) -> None:
        """End the process."""
        if self._task is not None:
            self._task.cancel()
        if self._process is not None and self._process.returncode is None:
            with suppress(ProcessLookupError):
                self._process.kill()

    async def _work(self) -> None:
        while self._waiting:
            await asyncio.sleep(PAUSE)
            if not self._waiting:
                return
            request = self._waiting.pop(next(iter(self._waiting)))
            answer = await self._ask(request)
            if answer is None or self._newest.get(request.uri) != request.revision:
                continue
            if answer.error:
                _LOG.error("validation of %s failed: %s", answer.uri, answer.error)
            else:
                self._deliver(answer)

    async def _ask(self, request: Request) -> Answer | None:
        process = await self._running()
        assert process.stdin is not None
        assert process.stdout is not None
        try:
            process.stdin.write(frame(request))
            await process.stdin.drain()
            (length,) = LENGTH.unpack(await process.stdout.readexactly(LENGTH.size))
            return pickle.loads(await process.stdout.readexactly(length))
        except (asyncio.IncompleteReadError, ConnectionError):
            _LOG.error("the validation process ended unexpectedly; it is started again with the next change")
            self._process = None
            return None

    async def _running(self) -> Process:
        if self._process is None or self._process.returncode is not None:
            self._process = await asyncio.create_subprocess_exec(sys.executable, "-c", _WORKER, stdin=PIPE, stdout=PIPE)
        return self._process


def _report(task: asyncio.Task[None]) -> None:
    if not task.cancelled() and task.exception() is not None:
        _LOG.error("validation stopped", exc_info=task.exception())
