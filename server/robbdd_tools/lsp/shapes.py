"""Keeps the validation process busy with the newest revision and drops what comes late."""

from __future__ import annotations

import asyncio
import logging
import pickle
import sys
from asyncio.subprocess import PIPE, Process
from collections.abc import Callable, Coroutine
from contextlib import suppress
from typing import Any

from robbdd_tools.lsp.requests import log_background_error
from robbdd_tools.lsp.worker import LENGTH, Answer, Forget, Request, frame

PAUSE = 0.02
"""Seconds in which edits that follow one another at once, as an editor sends them for several cursors, become one."""
MOST_DEATHS = 2
"""Deaths of the process, with no answer in between, after which what it was asked is given up."""
# Not "-m": the messages' classes must have the same module name in both processes.
_WORKER = "from robbdd_tools.lsp.worker import main; main"
_LOG = logging.getLogger(__name__)


class ShapeValidator:
    """Validates files in a worker process, the newest request of each file only.

    ``deliver`` gets each answer whose request is still the newest of its file, also one that tells of an error. With
    ``in_passing`` the process leaves the processor to all others. A newer request is sent at once, so
    that the process leaves the older one. The process is started with the first request; when it dies, it is started
    again with what it has not answered.
    """

    def __init__(self, deliver: Callable[[Answer], None], in_passing: bool = False) -> None:
        self._code = f"{_WORKER}(in_passing={in_passing})"
        self._deliver = deliver
        self._unsent: dict[str, Request | Forget] = {}
        self._open: dict[str, Request] = {}
        self._process: Process | None = None
        self._deaths = 0
        self._stopped = False
        self._tasks: set[asyncio.Task[None]] = set()
        self._sending: asyncio.Task[None] | None = None

    @property
    def process_id(self) -> int | None:
        """The process that validates, if there is one."""
        return None if self._process is None else self._process.pid

    def request(self, request: Request) -> None:
        """Ask for a validation; an older request for the same file is forgotten."""
        self._open[request.uri] = request
        self._send(request)

    def forget(self, uri: str) -> None:
        """Cancel what was asked about a file, and drop what is known of it."""
        self._open.pop(uri, None)
        if self._process is not None:
            self._send(Forget(uri))
        else:
            self._unsent.pop(uri, None)

    def stop(self) -> None:
        """End the process."""
        self._stopped = True
        for task in self._tasks:
            task.cancel()
        if self._process is not None and self._process.returncode is None:
            with suppress(ProcessLookupError):
                self._process.kill()

    def _send(self, message: Request | Forget) -> None:
        self._unsent[message.uri] = message
        if self._sending is None or self._sending.done():
            self._sending = self._spawn(self._send_all())

    async def _send_all(self) -> None:
        while self._unsent:
            await asyncio.sleep(PAUSE)
            process = self._process or await self._start()
            messages, self._unsent = self._unsent, {}
            assert process.stdin is not None
            # A process that is dead takes no more; what it owes is sent to its successor.
            with suppress(ConnectionError):
                for message in messages.values():
                    process.stdin.write(frame(message))
                await process.stdin.drain()

    async def _start(self) -> Process:
        self._process = await asyncio.create_subprocess_exec(sys.executable, "-c", self._code, stdin=PIPE, stdout=PIPE)
        self._spawn(self._receive(self._process))
        return self._process

    async def _receive(self, process: Process) -> None:
        assert process.stdout is not None
        with suppress(asyncio.IncompleteReadError, ConnectionError):
            while True:
                (length,) = LENGTH.unpack(await process.stdout.readexactly(LENGTH.size))
                self._take(pickle.loads(await process.stdout.readexactly(length)))
        await process.wait()
        if not self._stopped:
            self._died()

    def _take(self, answer: Answer) -> None:
        self._deaths = 0
        asked = self._open.get(answer.uri)
        if asked is None or asked.revision != answer.revision:
            return
        del self._open[answer.uri]
        if answer.error:
            _LOG.error("validation of %s failed: %s", answer.uri, answer.error)
        self._deliver(answer)

    def _died(self) -> None:
        self._process = None
        self._deaths += 1
        if self._deaths < MOST_DEATHS:
            _LOG.warning("the validation process ended unexpectedly and is started again")
            for request in self._open.values():
                self._send(request)
        elif self._open:
            _LOG.error("the validation process ended again; it is started with the next change")
            given_up = list(self._open.values())
            self._open.clear()
            self._deaths = 0
            for request in given_up:
                self._deliver(Answer(request.revision, request.uri, (), "the validation process ended"))

    def _spawn(self, work: Coroutine[Any, Any, None]) -> asyncio.Task[None]:
        task = asyncio.get_running_loop().create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        task.add_done_callback(lambda done: log_background_error(done, "the validation of shapes"))
        return task
