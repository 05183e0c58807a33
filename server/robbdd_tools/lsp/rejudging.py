"""Re-judge stored traces after each edit, in a process of its own, and show the verdicts until the next run."""

from __future__ import annotations

import asyncio
import logging
import pickle
from asyncio.subprocess import Process
from collections.abc import Mapping, Sequence
from contextlib import suppress
from itertools import count
from typing import TYPE_CHECKING

from robbdd_tools.base.interpreter import start_worker
from robbdd_tools.base.limits import VALIDATION_SECONDS
from robbdd_tools.lsp.analysis_thread import Urgency
from robbdd_tools.lsp.framing import LENGTH, Edited, Execution, Rejudged, frame
from robbdd_tools.lsp.work_done import WorkDone

if TYPE_CHECKING:
    from robbdd_tools.features.run_verdicts import RejudgedExecution
    from robbdd_tools.lsp.server import RobbddServer
    from robbdd_tools.names.project import Snapshot

PAUSE = 0.03
"""Keystrokes within this time (s) are combined."""
FIRST_PAUSE = 1.0
"""For a document that has results but was not edited, the process starts after this many seconds."""
SHOWN_ABOVE = 100
"""The client shows progress if there are more executions than this."""
# Not "-m": the messages' classes must have the same module name in both processes.
_WORKER = "from robbdd_tools.lsp.rejudge_worker import main; main()"
_LOG = logging.getLogger(__name__)


class Rejudging:
    """The verdicts of stored traces on edited clauses. They are shown, and never stored.

    An edit of a model, or of a file that it imports, replaces the work on the previous one. Requests of the client do
    not wait for any of it.
    """

    def __init__(self, server: RobbddServer) -> None:
        self._server = server
        self.executions: dict[str, dict[Execution, RejudgedExecution]] = {}
        """The executions that edits concern, for each model."""
        self._revisions = count(1)
        self._asked: dict[str, Edited] = {}
        """The latest unanswered request about each model."""
        self._newest: dict[str, int] = {}
        """The revision of the latest request about each model."""
        self._repeated = 0
        """The revision that was requested again because the process died while judging it."""
        self._process: Process | None = None
        self._starting = asyncio.Lock()
        self._waiting: asyncio.Task[None] | None = None
        self._edited: dict[str, None] = {}
        self._progress: WorkDone | None = None
        self._watch: asyncio.TimerHandle | None = None
        self._stopped = False

    def edited(self, uri: str, *, opened: bool = False) -> None:
        """Schedule the re-judging of a document's models. ``opened`` is true if the document was opened, not edited."""
        if self._stopped or not any(True for _ in self._server.results):
            return
        self._edited[uri] = None
        if opened and self._waiting is not None:
            return
        if self._waiting is not None:
            self._waiting.cancel()
        self._waiting = self._server.spawn(self._order_soon(FIRST_PAUSE if opened else PAUSE))

    def results_changed(self) -> None:
        """Re-judge the models of all open documents, because a run has ended or runs were read."""
        for uri in self._server.opened():
            self.edited(uri, opened=True)

    def settings_changed(self) -> None:
        """Remove re-judged verdicts where the setting ``robbdd.rejudge`` is now off, and re-judge where it is on."""
        for model in [uri for uri in self.executions if not self._server.settings.rejudges(uri)]:
            self._asked.pop(model, None)
            self._replace(model, {})
        if not self._asked:
            self._end_progress()
        self.results_changed()

    def stop(self) -> None:
        """Judge nothing more."""
        self._stopped = True
        if self._waiting is not None:
            self._waiting.cancel()
        self._end_process()

    def _end_process(self) -> None:
        if self._watch is not None:
            self._watch.cancel()
        if self._process is not None and self._process.returncode is None:
            with suppress(ProcessLookupError):
                self._process.kill()

    async def _order_soon(self, pause: float) -> None:
        await asyncio.sleep(pause)
        self._waiting = None
        revision = next(self._revisions)
        edited, self._edited = self._edited, {}
        executions = self._shown_executions()

        def affected(snapshot: Snapshot) -> tuple[list[str], dict[str, tuple[int, str]]]:
            reached = {uri: None for one in edited for uri in (one, *snapshot.importers(one))}
            return [uri for uri in reached if uri in executions], self._server.project.texts()

        models, texts = await self._server.analyse(affected, Urgency.LATER)
        found = [await asyncio.to_thread(self._order, revision, model, texts, executions[model]) for model in models]
        # Stores are looked up in threads: the request about a later edit may be ready first.
        orders = [order for order in found if revision > self._newest.get(order.uri, 0)]
        self._newest |= {order.uri: revision for order in orders}
        self._asked |= {order.uri: order for order in orders}
        if orders:
            await self._send(orders)

    def _shown_executions(self) -> dict[str, dict[int, list[int]]]:
        """Return the numbers of all shown executions that are stored, by their model and their run."""
        found: dict[str, dict[int, list[int]]] = {}
        for scenario in self._server.results:
            if scenario.run and scenario.finished and self._server.settings.rejudges(scenario.model):
                found.setdefault(scenario.model, {}).setdefault(scenario.run, []).append(scenario.index)
        return found

    def _order(
        self, revision: int, model: str, texts: Mapping[str, tuple[int, str]], executions: dict[int, list[int]]
    ) -> Edited:
        store = self._server.stores.of(model)
        numbers = {run: tuple(indices) for run, indices in executions.items()}
        return Edited(revision, model, texts, str(store.folder), numbers, self._server.sources.texts())

    async def _send(self, orders: Sequence[Edited]) -> None:
        async with self._starting:
            if self._process is None and not self._stopped:
                self._process = await start_worker(_WORKER)
                self._server.spawn(self._receive(self._process))
        if self._process is None or self._stopped:
            self._end_process()
            return
        assert self._process.stdin is not None
        # What a dead process did not answer is requested again.
        with suppress(ConnectionError):
            self._process.stdin.write(frame(tuple(orders)))
            await self._process.stdin.drain()
        self._watch_it()

    async def _receive(self, process: Process) -> None:
        assert process.stdout is not None
        with suppress(asyncio.IncompleteReadError, ConnectionError):
            while True:
                (length,) = LENGTH.unpack(await process.stdout.readexactly(LENGTH.size))
                await self._take(pickle.loads(await process.stdout.readexactly(length)))
        await process.wait()
        self._process = None
        if self._asked and not self._stopped:
            await self._died(list(self._asked.values()))

    async def _died(self, unanswered: Sequence[Edited]) -> None:
        """Repeat the unanswered requests. If the process dies again, give up until the next edit."""
        _LOG.warning("the process that re-judges edits ended unexpectedly")
        newest = max(order.revision for order in unanswered)
        if newest > self._repeated:
            self._repeated = newest
            await self._send(unanswered)
            return
        for order in unanswered:
            self._replace(order.uri, {})
        self._asked.clear()
        self._end_progress()

    async def _take(self, rejudged: Rejudged) -> None:
        asked = self._asked.get(rejudged.uri)
        if asked is None or asked.revision != rejudged.revision:
            return
        self._watch_it()
        if rejudged.problem:
            _LOG.info("%s is not re-judged: %s", rejudged.uri, rejudged.problem)
        first = rejudged.done == len(rejudged.executions)
        self._replace(rejudged.uri, {**({} if first else self.executions.get(rejudged.uri, {})), **rejudged.executions})
        if rejudged.is_last:
            del self._asked[rejudged.uri]
        if rejudged.is_last and not self._asked:
            self._end_progress()
        elif rejudged.total > SHOWN_ABOVE:
            progress = self._progress or WorkDone(self._server, f"robbdd-rejudge-{rejudged.revision}")
            self._progress = progress
            await progress.begin("Re-judging stored traces")
            words = f"{rejudged.done:,} of {rejudged.total:,} executions"
            progress.report(words, rejudged.done, rejudged.total)

    def _replace(self, model: str, executions: dict[Execution, RejudgedExecution]) -> None:
        if executions != self.executions.get(model, {}):
            self.executions[model] = executions
            self._server.show_results(self._server.opened())

    def _end_progress(self) -> None:
        if self._watch is not None:
            self._watch.cancel()
        progress, self._progress = self._progress, None
        if progress is not None:
            progress.end("re-judged, not executed")

    def _watch_it(self) -> None:
        """Restart the time limit of the next answer."""
        if self._watch is not None:
            self._watch.cancel()
        self._watch = asyncio.get_running_loop().call_later(VALIDATION_SECONDS.value(), self._hangs)

    def _hangs(self) -> None:
        if self._asked:
            _LOG.error("re-judging took longer than %s seconds and was given up", VALIDATION_SECONDS.value())
            self._end_process()
