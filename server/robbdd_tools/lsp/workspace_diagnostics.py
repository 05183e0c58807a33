"""Findings in the unopened model files of the workspace. They are computed in the background.

A separate process with low priority validates one file after another; files that import each other are validated
together. It validates all files when the client has started, and later those that are affected by changes on disk or in
an editor.
"""

from __future__ import annotations

import asyncio
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from hashlib import blake2b
from itertools import count
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.features.import_graph import ImportGraph, imported_on_disk
from robbdd_tools.features.workspace_files import model_files
from robbdd_tools.lsp.shapes import ShapeValidator

if TYPE_CHECKING:
    from lsprotocol import types

    from robbdd_tools.lsp.framing import Answer
    from robbdd_tools.lsp.server import RobbddServer

PAUSE = 1.0
"""Files are validated after this many seconds without a change."""
GATHERING = 0.25
"""Findings are gathered for this many seconds, then published."""
AT_ONCE = 2
"""This many files are requested ahead, so that the process is never idle."""


@dataclass(frozen=True, slots=True)
class Findings:
    """The diagnostics of one file. Equal diagnostics at the same places have the same ``id``."""

    diagnostics: tuple[types.Diagnostic, ...]
    id: str

    @classmethod
    def of(cls, diagnostics: Iterable[types.Diagnostic]) -> Findings:
        """Return the diagnostics together with their ``id``."""
        found = tuple(diagnostics)
        text = repr(found).encode("utf-8", "surrogatepass")
        return cls(found, blake2b(text, digest_size=12).hexdigest())


class WorkspaceDiagnostics:
    """The findings in each unopened file that has been validated so far."""

    def __init__(self, server: RobbddServer) -> None:
        self._server = server
        self._validator = ShapeValidator(self._take, in_passing=True)
        self._changed: set[str] = set()
        self._everything = False
        self._orders = count(1)
        self._waiting: dict[str, int] = {}
        """Files to request, with the number of the last order for each."""
        self._asked: dict[str, int] = {}
        """Requested files, with the number of the last order at the time of the request."""
        self._order_number = 0
        self._cycles: Mapping[str, int] = {}
        self._found: dict[str, Mapping[str, Findings]] = {}
        self._reached: dict[str, frozenset[str]] = {}
        self._published: dict[str, str] = {}
        self._timer: asyncio.TimerHandle | None = None
        self._telling: asyncio.TimerHandle | None = None
        self._news = asyncio.Event()

    @property
    def is_settled(self) -> bool:
        """Whether all files have been validated in their current state."""
        return not (self._waiting or self._asked or self._timer or self._telling)

    def schedule(self, changed: Iterable[str] | None = None) -> None:
        """Schedule the validation of all files or, with ``changed``, of the files that depend on these."""
        self._changed.update(changed or ())
        self._everything |= changed is None
        if self._timer is not None:
            self._timer.cancel()
        self._timer = asyncio.get_running_loop().call_later(PAUSE, self._begin)

    def closed(self, uri: str) -> None:
        """Schedule the validation of a file that the editor has just closed."""
        self._published.pop(uri, None)
        self.schedule([uri])

    def stop(self) -> None:
        """End the process."""
        for timer in (self._timer, self._telling):
            if timer is not None:
                timer.cancel()
        self._validator.stop()

    async def wait_for_news(self) -> None:
        """Wait until there are further findings, or until all files are validated."""
        await self._news.wait()

    def findings(self) -> dict[str, Findings]:
        """Return the findings in each unopened file, merged from the validations of the files that import it."""
        parts: dict[str, list[Findings]] = {}
        for owner in sorted(self._found):
            if self._server.is_open(owner):
                continue
            parts.setdefault(owner, [])
            for uri, found in self._found[owner].items():
                if not self._server.is_open(uri):
                    parts.setdefault(uri, []).append(found)
        for uri, found in self._server.user_errors.elsewhere().items():
            parts.setdefault(uri, []).append(Findings.of(found))
        return {uri: _together(text) for uri, text in sorted(parts.items())}

    def _begin(self) -> None:
        self._timer = None
        self._server.spawn(self._order())

    async def _order(self) -> None:
        """Find the files to validate, and request their validation."""
        changed, self._changed = self._changed, set()
        everything, self._everything = self._everything, False
        roots = list(self._server.workspace.folders)
        spelling = self._server.project.spellings.of
        files = list(map(spelling, await asyncio.to_thread(model_files, roots)))
        for gone in self._found.keys() - set(files):
            del self._found[gone]
            self._reached.pop(gone, None)
        # New imports of a changed file have not been reached from it yet.
        imported = set(map(spelling, await asyncio.to_thread(imported_on_disk, changed)))
        self._cycles = await asyncio.to_thread(lambda: ImportGraph.of(files).cycles())
        self._order_number = next(self._orders)
        for uri in files:
            is_new = everything or uri not in self._found or uri in imported
            if is_new or not changed.isdisjoint(self._reached.get(uri, ())):
                self._waiting[uri] = self._order_number
        self._ask()
        self.publish_soon()

    def _ask(self) -> None:
        while len(self._asked) < AT_ONCE:
            # A file that changes during validation is requeued, as the answer may be about its old state. An answer
            # about a file is also about those that form a cycle of imports with it.
            requested = set(map(self._cycle, self._asked))
            uri = next((uri for uri in self._waiting if self._cycle(uri) not in requested), None)
            if uri is None:
                return
            del self._waiting[uri]
            if not self._server.is_open(uri):
                self._asked[uri] = self._order_number
                self._server.spawn(self._ask_for(uri))

    def _cycle(self, uri: str) -> object:
        """Return a key that is equal for files that import each other according to their import lines."""
        return self._cycles.get(uri, uri)

    async def _ask_for(self, uri: str) -> None:
        self._validator.request(await self._server.survey_request(uri))

    def _take(self, answer: Answer) -> None:
        self._server.spawn(self._keep(answer))

    async def _keep(self, answer: Answer) -> None:
        spelling = self._server.project.spellings.of
        together = tuple(map(spelling, answer.together))
        try:
            if not answer.error:
                outside = frozenset[str]().union(*answer.named.values())
                reached = frozenset(map(spelling, answer.reached)) | outside
                self._reached |= dict.fromkeys((answer.uri, *together), reached)
                self._server.sources.learn({spelling(uri): named for uri, named in answer.named.items()})
                found = await asyncio.to_thread(self._converted, answer)
                for uri in together:
                    self._found[uri] = {uri: found.pop(uri, NOTHING)}
                self._found[answer.uri] = {**self._found.get(answer.uri, {}), **found}
        finally:
            order = self._asked.pop(answer.uri, 0)
            for uri in together:
                if self._waiting.get(uri, order + 1) <= order:
                    del self._waiting[uri]
            self._ask()
            self.publish_soon()

    def _converted(self, answer: Answer) -> dict[str, Findings]:
        convert, documents = self._server.convert, answer.documents
        found: dict[str, list[types.Diagnostic]] = {}
        # Hints matter only while editing a file; elsewhere they would hide errors and warnings.
        for one in (one for one in answer.diagnostics if one.severity <= Severity.WARNING):
            found.setdefault(self._server.project.spellings.of(one.uri), []).append(convert.diagnostic(documents, one))
        return {uri: Findings.of(diagnostics) for uri, diagnostics in found.items()}

    def publish_soon(self) -> None:
        """Publish the findings soon."""
        if self._telling is None:
            self._telling = asyncio.get_running_loop().call_later(GATHERING, self._tell)

    def _tell(self) -> None:
        self._telling = None
        self._news.set()
        self._news = asyncio.Event()
        if not self._server.pulls:
            self._publish()

    def _publish(self) -> None:
        findings = self.findings()
        for uri, found in findings.items():
            if self._published.get(uri, NOTHING.id) != found.id:
                self._server.send(uri, None, list(found.diagnostics))
                self._published[uri] = found.id
        for uri in self._published.keys() - findings.keys():
            if self._published.pop(uri) != NOTHING.id and not self._server.is_open(uri):
                self._server.send(uri, None, [])


def _together(parts: list[Findings]) -> Findings:
    if len(parts) == 1:
        return parts[0]
    # The protocol's types are not hashable.
    return Findings.of({repr(one): one for part in parts for one in part.diagnostics}.values())


NOTHING = Findings.of(())
