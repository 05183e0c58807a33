"""The state of the server: the project and its analysis thread, published data, and work in progress."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Coroutine, Iterable, Sequence
from functools import partial
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pygls.lsp.server import LanguageServer

from robbdd_tools import __version__
from robbdd_tools.base.checkpoint import Abandoned
from robbdd_tools.base.files import uri_to_path
from robbdd_tools.base.printable import printable
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.features.project_findings import ProjectFindings
from robbdd_tools.features.result_diagnostics import result_diagnostics
from robbdd_tools.features.run_verdicts import Findings, Results
from robbdd_tools.lsp.analysis_thread import AnalysisThread, Urgency
from robbdd_tools.lsp.background import Background
from robbdd_tools.lsp.client_settings import Settings
from robbdd_tools.lsp.convert import Converter, document_of
from robbdd_tools.lsp.framing import Answer, Request
from robbdd_tools.lsp.importers import Importers
from robbdd_tools.lsp.latest_wins import LatestWins
from robbdd_tools.lsp.protocol import Protocol
from robbdd_tools.lsp.refresh import COLOURS, DIAGNOSTICS, GATHERING, HINTS, LENSES, SETTLING, Refreshes
from robbdd_tools.lsp.rejudging import Rejudging
from robbdd_tools.lsp.requests import Handler, Requests, log_background_error
from robbdd_tools.lsp.run_stores import Stores
from robbdd_tools.lsp.shape_findings import ShapeFindings
from robbdd_tools.lsp.shapes import ShapeValidator
from robbdd_tools.lsp.source_documents import SourceDocuments
from robbdd_tools.lsp.store_watching import StoreWatching
from robbdd_tools.lsp.stored_verdicts import StoredVerdicts
from robbdd_tools.lsp.user_errors import UserErrors, model_errors
from robbdd_tools.lsp.workspace_diagnostics import WorkspaceDiagnostics
from robbdd_tools.names.index import language_of
from robbdd_tools.names.project import Project, Snapshot
from robbdd_tools.workbench.judged_scenarios import project_of

if TYPE_CHECKING:
    from robbdd_tools.lsp.active_run import ActiveRun
    from robbdd_tools.lsp.transport import Connection

Result = TypeVar("Result")
_LOG = logging.getLogger(__name__)


class RobbddServer(LanguageServer):
    """The server of one client.

    All analysis is done in one thread in the order of messages. So the event loop stays free, and every answer takes
    all earlier edits into account.
    """

    def __init__(self) -> None:
        super().__init__(  # pyright: ignore[reportUnknownMemberType] -- pygls leaves further arguments untyped
            "robbdd-lsp", __version__, protocol_cls=Protocol
        )
        self.project = Project()
        self.convert = Converter()
        self.settings = Settings()
        self.trusted = True
        """Whether workspace code may be run; the client may set ``trusted`` to false at start."""
        self.results = Results()
        self._findings = ProjectFindings()
        """The displayed results of runs."""
        self.run: ActiveRun | None = None
        self.run_numbers = count(1)
        self.stores = Stores()
        self.stored_verdicts = StoredVerdicts(self)
        self.store_watching = StoreWatching(self)
        self.shows_pictures = False
        """Whether the client shows pictures in Markdown."""
        self.shows_replays = False
        """Whether the client has the command ``robbdd.showReplay``, also in Markdown links."""
        self.shows_history = False
        """Whether the client has the command ``robbdd.showHistory``, also in Markdown links."""
        self.debugs_scenarios = self.runs_studies = False
        """Whether the client has the command ``robbdd.debugScenario``, and the commands of ``lsp/study_lenses``."""
        self._connection: Connection | None = None
        self._shapes = ShapeFindings()
        self._analysis = AnalysisThread()
        self.requests = Requests()
        self._background = Background()
        self.validator = ShapeValidator(self._shapes_found)
        self._orders = count(1)
        self._opened: dict[str, None] = {}
        self.when_closed: list[Callable[[str], None]] = []
        """Called with the URI of each document that the client closes."""
        self.pulls = False
        """Whether the client pulls diagnostics. If not, the server publishes them; it never does both."""
        self.refreshes = Refreshes(self)
        self.importers = Importers(self)
        self.survey = WorkspaceDiagnostics(self)
        self.user_errors = UserErrors(self)
        self.sources = SourceDocuments(self)
        self.rejudging = Rejudging(self)
        self._tasks: set[asyncio.Task[None]] = set()
        self._publishing = LatestWins(self.spawn)
        self._changed: dict[str, None] = {}

    def feature(self, feature_name: str, options: Any | None = None) -> Callable[[Handler], Handler]:
        """Register the handler of a protocol method. Its errors are caught."""
        register = super().feature(feature_name, options)
        return lambda handler: register(self.requests.with_logged_errors(feature_name, handler))

    def command(self, command_name: str) -> Callable[[Handler], Handler]:
        """Register a command. Its errors are caught."""
        register = super().command(command_name)
        return lambda handler: register(self.requests.with_logged_errors(command_name, handler))

    def report_server_error(self, error: Exception, source: Any) -> None:
        """Log an error outside of requests. Handlers have already logged their own errors with context."""
        if not isinstance(error, JsonRpcException):
            _LOG.error("internal error (%s)", source, exc_info=error)

    async def analyse(self, work: Callable[[Snapshot], Result], urgency: Urgency = Urgency.URGENT) -> Result:
        """Execute ``work`` on the latest snapshot in the analysis thread."""
        return await self._analysis.do(lambda: work(self.project.snapshot()), urgency)

    async def _in_thread(self, work: Callable[[], Result]) -> Result:
        return await self._analysis.do(work)

    async def in_background(self, work: Callable[[Snapshot], Result], *unopened: str) -> Result:
        """Execute ``work`` on the latest texts in a separate thread, so that requests do not wait for it.

        The files that it needs must be named if they may not be open.
        """
        texts = await self._in_thread(self.project.texts)
        return await self._background.work(texts, work, *unopened)

    async def text_changed(self, uri: str, version: int, text: str) -> None:
        """Set the new text of an open document, and publish the effects on diagnostics."""
        is_new = uri not in self._opened
        self._opened.setdefault(uri)
        if is_new:
            self.importers.queue_search()
            self.spawn(self.stored_verdicts.look_beside(uri))
        self.requests.text_changed(uri)
        try:
            await self._analysis.do(lambda: self.project.open(uri, version, text), replacing=uri)
        except Abandoned:
            # A newer text arrived before this one was parsed.
            return
        await self.publish(uri)
        self.survey.schedule([uri])
        self.sources.follow_soon(uri)
        self.rejudging.edited(uri, opened=is_new)
        await self.user_errors.refresh()

    async def text_closed(self, uri: str) -> None:
        """Use the file on disk instead of the closed text, and remove the diagnostics of the file from the editor."""
        self._opened.pop(uri, None)
        self._publishing.end(uri)
        self.validator.forget(uri)
        self._shapes.forget(uri)
        for forget in self.when_closed:
            forget(uri)
        await self._in_thread(lambda: self.project.close(uri))
        if not self.pulls:
            self.send(uri, None, [])
        await self.publish(uri)
        self.survey.closed(uri)

    async def files_changed(self, uris: Sequence[str]) -> None:
        """Read changed files again, and publish the effects on open files."""

        def forget() -> None:
            for uri in uris:
                self.project.refresh(uri)

        await self._in_thread(forget)
        await self.importers.look_around()
        self.refreshes.want(COLOURS, HINTS, LENSES)
        for uri in uris:
            self.rejudging.edited(uri)
        await self.settings_changed(uris if all(language_of(uri) for uri in uris) else None)

    async def settings_changed(self, files: Sequence[str] | None = None) -> None:
        """Check all documents, or those that ``files`` affect, again after settings have changed."""
        self.survey.schedule(files)
        await self.user_errors.refresh()
        for uri in list(self._opened):
            await self.publish(uri)

    async def publish(self, changed: str) -> None:
        """Publish the fast diagnostics of a document and of the open files that import it.

        The slow diagnostics of these files are requested.
        """

        def affected(snapshot: Snapshot) -> list[str]:
            importers = snapshot.importers(changed)
            return [uri for uri in self._opened if uri == changed or uri in importers]

        uris = await self.analyse(affected)
        if any(uri != changed for uri in uris):
            self.refreshes.want(DIAGNOSTICS, COLOURS, HINTS, LENSES, after=SETTLING)
        # Some may have been closed in the meantime.
        for uri in filter(self.is_open, uris):
            # Findings about an older text are of little use now.
            self._publishing.begin(uri, partial(self._publish_and_order, uri))

    async def _publish_and_order(self, uri: str) -> None:
        if not self.pulls:
            await self._publish_one(uri)
        request, texts = await self.analyse(lambda snapshot: self._order(snapshot, uri), Urgency.LATER)
        self._shapes.request(uri, request.revision, texts)
        self.validator.request(request)

    def opened(self) -> list[str]:
        """Return the files that the client has open."""
        return list(self._opened)

    def is_open(self, uri: str) -> bool:
        """Return whether the client has a file open."""
        return uri in self._opened

    async def survey_request(self, uri: str) -> Request:
        """Return the request to validate an unopened file."""
        importers = tuple(sorted((await self.importers.graph(uri)).importers(uri)))
        texts = await self.analyse(lambda _: self.project.texts(), Urgency.LATER)
        shapes, sources = self.settings.shapes(uri), self.sources.texts()
        return Request(next(self._orders), uri, texts, shapes, surveyed=True, importers=importers, sources=sources)

    def _order(self, snapshot: Snapshot, uri: str) -> tuple[Request, dict[str, str]]:
        """Return a request to validate a file, and the texts to which the answer will refer."""
        texts = {name: snapshot.document(name).text for name in snapshot.reachability.walk(uri)}
        shapes, sources = self.settings.shapes(uri), self.sources.texts()
        return Request(next(self._orders), uri, self.project.texts(), shapes, sources=sources), texts

    def show_results(self, uris: Sequence[str]) -> None:
        """Show new results of clauses in some files soon. Frequent updates are combined."""
        if not self._changed:
            self.spawn(self._show_changed())
        self._changed |= dict.fromkeys(uris)

    async def _show_changed(self) -> None:
        await asyncio.sleep(GATHERING)
        await self.show_changed()

    async def show_changed(self) -> None:
        """Show the pending results."""
        changed, self._changed = self._changed, {}
        self._findings = ProjectFindings(self.results, self.rejudging.executions)
        self.refreshes.want(HINTS, LENSES)
        await self.show_diagnostics(changed)
        await self.user_errors.refresh()

    def findings_of(self, snapshot: Snapshot, uri: str) -> Findings:
        """Return the shown results that concern a file."""
        return self._findings.of_file(snapshot, uri, project_of(uri))

    async def show_diagnostics(self, uris: Iterable[str]) -> None:
        """Send the client the diagnostics of some files again, as far as the files are open."""
        if self.pulls:
            self.refreshes.want(DIAGNOSTICS)
            return
        for uri in uris:
            if self.is_open(uri):
                await self._publish_one(uri)

    def folders(self, uri: str | None = None) -> list[Path]:
        """Return the workspace folders, innermost first; with ``uri``, those that contain the file."""
        paths = [path for folder in self.workspace.folders if (path := uri_to_path(folder)) is not None]
        file = None if uri is None else uri_to_path(uri)
        if uri is not None:
            paths = [path for path in paths if file is not None and file.is_relative_to(path)]
        return sorted(paths, key=lambda path: -len(path.parts))

    def warn(self, message: str, kind: types.MessageType = types.MessageType.Error) -> None:
        """Show the user why something was not done."""
        # VS Code turns [words](command:…) in messages into links; the words may be a user's. The space has no width.
        shown = printable(message).replace("](", "]\u200b(")
        self.window_show_message(types.ShowMessageParams(type=kind, message=shown))

    def exit_code(self) -> int:
        """Return the process's exit code, see ``Protocol.exit_code``."""
        protocol: Any = self.protocol
        return protocol.exit_code

    def start_connection(self, connection: Connection) -> None:
        """Serve a client until it ends the session."""
        self._connection = connection
        self.start_io(connection.input, connection.output)

    def shutdown(self) -> None:
        """End the session. The connection is closed first, because pygls waits for the thread that reads from it."""
        if self._connection is not None:
            self._connection.close()
        super().shutdown()

    def stop(self) -> None:
        """Stop all threads and processes of the server."""
        if self.run is not None:
            self.run.cancel()
        self.validator.stop()
        self.survey.stop()
        self.rejudging.stop()
        self._background.stop()
        self.stores.close()
        self._analysis.stop()

    async def _publish_one(self, uri: str) -> None:
        version, diagnostics = await self.diagnostics(uri)
        # It may have been closed in the meantime.
        if self.is_open(uri):
            self.send(uri, version, diagnostics)

    async def diagnostics(self, uri: str) -> tuple[int, list[types.Diagnostic]]:
        """Return all current diagnostics of a file, and the version of the text to which they refer."""

        broken = [scenario for scenario in self.results if scenario.faults]

        def find(snapshot: Snapshot) -> tuple[int, list[types.Diagnostic]]:
            found = [*fast_diagnostics(snapshot, uri), *self._shapes.valid(snapshot, uri)]
            found += result_diagnostics(snapshot, uri, self.findings_of(snapshot, uri), brief=self.shows_pictures)
            document = document_of(snapshot, uri)
            shown = [self.convert.diagnostic(snapshot, entry) for entry in dict.fromkeys(found)]
            return document.version, [*shown, *model_errors(snapshot, self.convert, uri, broken)]

        return await self.analyse(find, Urgency.LATER)

    def _shapes_found(self, answer: Answer) -> None:
        """Handle an answer of the validation process."""
        if self._shapes.take(answer):
            self.spawn(self.show_diagnostics(list(self._opened)))

    def spawn(self, work: Coroutine[Any, Any, None]) -> asyncio.Task[None]:
        """Start a task that nobody awaits, and keep a reference to it until it ends."""
        task = asyncio.get_running_loop().create_task(work, name=work.__qualname__)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        task.add_done_callback(lambda done: log_background_error(done, f"the background work {done.get_name()}"))
        return task

    def send(self, uri: str, version: int | None, diagnostics: list[types.Diagnostic]) -> None:
        """Publish the diagnostics of a file."""
        self.text_document_publish_diagnostics(
            types.PublishDiagnosticsParams(uri=uri, version=version, diagnostics=diagnostics)
        )
