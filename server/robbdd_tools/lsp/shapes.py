"""Run the validation process on the latest revision of each file, and drop outdated answers."""

from __future__ import annotations

import asyncio
import logging
import pickle
from asyncio.subprocess import Process
from collections.abc import Callable, Coroutine
from contextlib import suppress
from typing import Any

from robbdd_tools.base.interpreter import start_worker
from robbdd_tools.base.limits import VALIDATION_SECONDS
from robbdd_tools.lsp.framing import LENGTH, Answer, Begun, Forget, Request, frame
from robbdd_tools.lsp.requests import log_background_error

PAUSE = 0.02
"""Edits within this time (s), for example from several cursors, are combined."""
MAX_DEATHS = 2
"""If the process dies this many times on the same file, the file is skipped until it changes."""
# Not "-m": the messages' classes must have the same module name in both processes.
_WORKER = "from robbdd_tools.lsp.worker import main; main"
_LOG = logging.getLogger(__name__)


class ShapeValidator:
    """Validates files in a worker process.

    ``deliver`` is called with each answer about a file that is still requested, including errors. If ``in_passing`` is
    true, the process has low priority. A newer request is sent immediately. The process then abandons the older one,
    unless it has already abandoned too many. The process is started at the first request. If it dies, or hangs and is
    killed, it is restarted with its unanswered requests, except for the file that caused the failure.
    """

    def __init__(self, deliver: Callable[[Answer], None], in_passing: bool = False) -> None:
        self._in_passing = in_passing
        self._deliver = deliver
        self._unsent: dict[str, Request | Forget] = {}
        self._open: dict[str, Request] = {}
        self._process: Process | None = None
        self._working = ""
        self._watch: asyncio.TimerHandle | None = None
        self._deaths: dict[str, int] = {}
        self._stopped = False
        self._tasks: set[asyncio.Task[None]] = set()
        self._sending: asyncio.Task[None] | None = None

    @property
    def process_id(self) -> int | None:
        """The id of the validation process, if there is one."""
        return None if self._process is None else self._process.pid

    def request(self, request: Request) -> None:
        """Request a validation. It replaces an older request for the same file."""
        self._open[request.uri] = request
        self._send(request)

    def forget(self, uri: str) -> None:
        """Cancel the requests about a file, and drop the state of the file."""
        self._open.pop(uri, None)
        if self._process is not None:
            self._send(Forget(uri))
        else:
            self._unsent.pop(uri, None)

    def stop(self) -> None:
        """End the process."""
        self._stopped = True
        self._work_on("")
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
            # A dead process reads no more; its successor gets the unanswered requests.
            with suppress(ConnectionError):
                process.stdin.write(frame(tuple(messages.values())))
                await process.stdin.drain()

    async def _start(self) -> Process:
        code = f"{_WORKER}(in_passing={self._in_passing})"
        self._process = await start_worker(code)
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

    def _take(self, message: Begun | Answer) -> None:
        if isinstance(message, Begun):
            self._deaths.pop("", None)
            self._work_on(message.uri)
            return
        self._work_on("")
        self._deaths.pop(message.uri, None)
        asked = self._open.get(message.uri)
        if asked is None:
            return
        if asked.revision == message.revision:
            del self._open[message.uri]
        if message.error:
            _LOG.error("validation of %s failed: %s", message.uri, message.error)
        self._deliver(message)

    def _work_on(self, uri: str) -> None:
        """Record the worker's current file, and start the time limit. An empty ``uri`` means no file."""
        self._working = uri
        if self._watch is not None:
            self._watch.cancel()
        self._watch = asyncio.get_running_loop().call_later(VALIDATION_SECONDS.value(), self._hangs) if uri else None

    def _hangs(self) -> None:
        uri = self._working
        self._work_on("")
        self._give_up(uri, f"it took longer than {VALIDATION_SECONDS.value()} seconds")
        if self._process is not None:
            with suppress(ProcessLookupError):
                self._process.kill()

    def _died(self) -> None:
        self._process = None
        guilty = self._working
        self._work_on("")
        self._deaths[guilty] = self._deaths.get(guilty, 0) + 1
        _LOG.warning("the validation process ended unexpectedly and is started again")
        if self._deaths[guilty] >= MAX_DEATHS:
            # A process that dies before it begins any file would never answer.
            for uri in [guilty] if guilty else list(self._open):
                self._give_up(uri, "the validation process ended over it")
        for request in self._open.values():
            self._send(request)

    def _give_up(self, uri: str, problem: str) -> None:
        self._deaths.pop(uri, None)
        request = self._open.pop(uri, None)
        if request is not None:
            _LOG.error("validation of %s was given up: %s", uri, problem)
            self._deliver(Answer(request.revision, uri, (), problem))

    def _spawn(self, work: Coroutine[Any, Any, None]) -> asyncio.Task[None]:
        task = asyncio.get_running_loop().create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        task.add_done_callback(lambda done: log_background_error(done, "the validation of shapes"))
        return task
