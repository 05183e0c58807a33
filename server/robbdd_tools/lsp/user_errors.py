"""Show errors in users' code.

In open models, they are shown with the other diagnostics, and in all other files with the findings about unopened
files.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from lsprotocol import types

from robbdd_tools.base.files import load_text, path_to_uri, uri_to_path
from robbdd_tools.features.user_errors import CODE, UserError, errors_in, user_errors
from robbdd_tools.lsp.convert import SOURCE, document_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from robbdd_tools.features.run_verdicts import JudgedScenario
    from robbdd_tools.lsp.convert import Converter
    from robbdd_tools.lsp.server import RobbddServer
    from robbdd_tools.monitor.fault import Frame
    from robbdd_tools.names.project import Snapshot

CODE_EDITED = "robbdd/codeEdited"
"""Notification of a client: the user edits the Python file ``uri`` and has not saved it yet."""
END_OF_LINE = 10_000
"""A column beyond the end of any line. Clients move it to the end of the line."""


class UserErrors:
    """The errors in files that are not open as models. The files are Python files, and models that a run has used."""

    def __init__(self, server: RobbddServer) -> None:
        self._server = server
        self._elsewhere: Mapping[str, list[types.Diagnostic]] = {}

    def elsewhere(self) -> Mapping[str, list[types.Diagnostic]]:
        """The errors of each file that is not open."""
        return {uri: found for uri, found in self._elsewhere.items() if not self._server.is_open(uri)}

    async def refresh(self) -> None:
        """Collect the errors again. This is done after a run and after a file has changed."""
        scenarios = [scenario for scenario in self._server.results if scenario.faults]
        if not (scenarios or self._elsewhere):
            return
        models = sorted({scenario.model for scenario in scenarios})
        convert = self._server.convert
        found = await self._server.in_background(lambda snapshot: _everywhere(snapshot, convert, scenarios), *models)
        if found != self._elsewhere:
            self._elsewhere = found
            self._server.survey.publish_soon()

    async def code_changed(self) -> None:
        """Show the errors again after code has changed.

        Only errors in code that has not changed since its execution remain.
        """
        if any(scenario.faults for scenario in self._server.results):
            await self.refresh()
            self._server.show_results(self._server.opened())

    async def code_edited(self, uri: str) -> None:
        """Drop the errors in a file whose text has changed since its execution."""
        found = False
        for scenario in self._server.results:
            kept = tuple(fault for fault in scenario.faults if fault.place is None or _uri(fault.place.file) != uri)
            if len(kept) < len(scenario.faults):
                scenario.faults, found = kept, True
        if found:
            await self.refresh()
            self._server.show_results(self._server.opened())


def register_user_errors(server: RobbddServer) -> None:
    """Add the notification to a server."""

    @server.feature(CODE_EDITED)
    async def edited(ls: RobbddServer, params: Any) -> None:
        await ls.user_errors.code_edited(_uri(str(params.uri)))


def model_errors(
    snapshot: Snapshot, convert: Converter, uri: str, scenarios: Iterable[JudgedScenario]
) -> list[types.Diagnostic]:
    """Return the errors of users' code at their places in a model."""
    return _in_model(snapshot, convert, uri, user_errors(snapshot, scenarios))


def _everywhere(
    snapshot: Snapshot, convert: Converter, scenarios: Sequence[JudgedScenario]
) -> dict[str, list[types.Diagnostic]]:
    errors = user_errors(snapshot, scenarios)
    models = dict.fromkeys(scenario.model for error in errors for scenario in error.scenarios)
    files = dict.fromkeys(
        file.document.uri for model in models if snapshot.file(model) for file in snapshot.closure(model)
    )
    found = {uri: _in_model(snapshot, convert, uri, errors) for uri in files}
    for error in errors:
        place = error.fault.place
        if place is not None and place.own:
            found.setdefault(_uri(place.file), []).append(_in_code(convert, error))
    return {uri: diagnostics for uri, diagnostics in found.items() if diagnostics}


def _in_model(snapshot: Snapshot, convert: Converter, uri: str, errors: Sequence[UserError]) -> list[types.Diagnostic]:
    document = document_of(snapshot, uri)
    return [
        _diagnostic(convert, convert.range(document, span), message, _related(error))
        for span, error, message in errors_in(snapshot, uri, errors)
    ]


def _in_code(convert: Converter, error: UserError) -> types.Diagnostic:
    place = error.fault.place
    assert place is not None
    count = len(error.scenarios)
    spoilt = "1 scenario" if count == 1 else f"{count} scenarios"
    return _diagnostic(convert, _line(place), f"{error.fault.summary} (in the last run, {spoilt})", _calls(error))


def _diagnostic(
    convert: Converter, range: types.Range, message: str, related: list[types.DiagnosticRelatedInformation]
) -> types.Diagnostic:
    return types.Diagnostic(
        range=range,
        message=message,
        severity=types.DiagnosticSeverity.Error,
        code=CODE,
        source=SOURCE,
        related_information=related or None,
        code_description=convert.code_description(CODE),
    )


def _related(error: UserError) -> list[types.DiagnosticRelatedInformation]:
    place = error.fault.place
    if place is None:
        return []
    location = types.Location(uri=_uri(place.file), range=_line(place))
    return [types.DiagnosticRelatedInformation(location=location, message=error.fault.summary)]


def _calls(error: UserError) -> list[types.DiagnosticRelatedInformation]:
    """Return the other frames of the traceback that are in the user's files."""
    calls = [frame for frame in error.fault.frames if frame.own and frame != error.fault.place]
    return [
        types.DiagnosticRelatedInformation(
            location=types.Location(uri=_uri(frame.file), range=_line(frame)),
            message=f"called in {frame.function}",
        )
        for frame in reversed(calls)
    ]


def _line(frame: Frame) -> types.Range:
    """Return the range of a call's line, without its indentation."""
    try:
        text = load_text(Path(frame.file)).split("\n")[frame.line - 1]
    except (OSError, ValueError, IndexError):
        text = ""
    start = types.Position(line=frame.line - 1, character=len(text) - len(text.lstrip()))
    return types.Range(start=start, end=types.Position(line=frame.line - 1, character=END_OF_LINE))


def _uri(file: str) -> str:
    """Return a file's canonical URI."""
    path = uri_to_path(file) if file.startswith("file:") else Path(file)
    return str(file) if path is None else path_to_uri(path)
