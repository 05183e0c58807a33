"""Commands of the server, and the quick fix that offers one of them.

The argument of every command is one object with the ``uri`` of a model. Commands that run a model also accept the
options of ``run_options.RunOptions``.
"""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from lsprotocol import types
from pygls.exceptions import JsonRpcInvalidParams

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import path_to_uri, read_text, uri_to_path
from robbdd_tools.base.source_texts import unsaved_source
from robbdd_tools.base.step_files import steps_file
from robbdd_tools.checks.no_evaluator import no_evaluator
from robbdd_tools.features.clause_results import clause_diagnostics
from robbdd_tools.lsp.convert import document_of
from robbdd_tools.lsp.document_models import feature_plan, reason
from robbdd_tools.lsp.server import RobbddServer

if TYPE_CHECKING:
    from robbdd_tools.names.project import Snapshot

RUN, RERUN, RECORD, CANCEL = "robbdd.run", "robbdd.rerunFailed", "robbdd.record", "robbdd.cancel"
ESTIMATE = "robbdd.estimate"
GHERKIN, STEPS = "robbdd.gherkin", "robbdd.steps"
_UNDEFINED = "clause-undefined"


def register_commands(server: RobbddServer) -> None:
    """Add the commands to a server."""
    _register_runs(server)
    _register_writing(server)


def _register_runs(server: RobbddServer) -> None:
    @server.command(RUN)
    async def run(ls: RobbddServer, target: Any = None) -> dict[str, Any]:
        return await _start(ls, _checked(RUN, target))

    @server.command(RERUN)
    async def rerun(ls: RobbddServer, target: Any = None) -> dict[str, Any]:
        return await _start(ls, _checked(RERUN, target), failed=True)

    @server.command(RECORD)
    async def record(ls: RobbddServer, target: Any = None) -> dict[str, Any]:
        return await _start(ls, _checked(RECORD, target), record=True)

    @server.command(ESTIMATE)
    async def estimate(ls: RobbddServer, target: Any = None) -> dict[str, Any]:
        from robbdd_tools.lsp.runs import estimate_run

        return await estimate_run(ls, _checked(ESTIMATE, target))

    @server.command(CANCEL)
    def cancel(ls: RobbddServer, _: dict[str, Any] | None = None) -> None:
        if ls.run is not None:
            ls.run.cancel()

    @server.feature(types.WINDOW_WORK_DONE_PROGRESS_CANCEL)
    def cancel_progress(ls: RobbddServer, params: types.WorkDoneProgressCancelParams) -> None:
        if ls.run is not None and ls.run.progress == params.token:
            ls.run.cancel()


async def _start(ls: RobbddServer, target: dict[str, Any], **options: bool) -> dict[str, Any]:
    # What executes scenarios is imported with the first run, so that the server starts sooner.
    from robbdd_tools.lsp.runs import start_run

    return await start_run(ls, target, **options)


def _checked(command: str, target: Any) -> dict[str, Any]:
    """Return the argument of a command as sent by the client.

    Raises ``JsonRpcInvalidParams`` unless it names a model.
    """
    match target:
        case {"uri": str()}:
            return target
        case _:
            raise JsonRpcInvalidParams(f"{command} takes an object with the 'uri' of a model")


def _register_writing(server: RobbddServer) -> None:
    @server.command(GHERKIN)
    async def gherkin(ls: RobbddServer, target: Any = None) -> dict[str, list[str]]:
        return {"files": await _write_gherkin(ls, _checked(GHERKIN, target)["uri"])}

    @server.command(STEPS)
    async def steps(ls: RobbddServer, target: Any = None) -> dict[str, list[str]]:
        return {"files": await _write_steps(ls, _checked(STEPS, target)["uri"])}


def step_fixes(ls: RobbddServer, snapshot: Snapshot, params: types.CodeActionParams) -> Iterator[types.CodeAction]:
    """Yield the quick fix for clauses that no step can judge. It is offered before a run and after it."""
    uri = params.text_document.uri
    file = snapshot.file(uri)
    span = ls.convert.span(document_of(snapshot, uri), params.range)
    found = [
        *(no_evaluator(snapshot, file) if file is not None else ()),
        *(
            one
            for one in clause_diagnostics(snapshot, uri, ls.findings_of(snapshot, uri), brief=ls.shows_pictures)
            if one.code == _UNDEFINED
        ),
    ]
    selected = [one for one in found if one.span.start <= span.end and span.start <= one.span.end]
    if selected:
        title = "Write a step skeleton"
        yield types.CodeAction(
            title=title,
            kind=types.CodeActionKind.QuickFix,
            diagnostics=[ls.convert.diagnostic(snapshot, one) for one in selected],
            command=types.Command(title=title, command=STEPS, arguments=[{"uri": uri}]),
            is_preferred=True,
        )


async def _write_gherkin(ls: RobbddServer, uri: str) -> list[str]:
    """Write the features of a model and their line maps to ``features/`` in its folder.

    Return the URIs of the features.
    """
    from robbdd_tools.gherkin.feature_files import write_features

    path = uri_to_path(uri)
    if path is None:
        ls.warn("save the model first: its features are written to its folder")
        return []
    try:
        plan = await ls.in_background(lambda snapshot: feature_plan(snapshot, uri))
        plan = replace(plan, expanded=ls.settings.expands(uri))
        written = await asyncio.to_thread(write_features, plan, path.parent / "features")
    except (RobbddError, OSError) as error:
        ls.warn(reason(error))
        return []
    return [path_to_uri(file) for file in written]


async def _write_steps(ls: RobbddServer, uri: str) -> list[str]:
    """Write functions for the clauses that the catalog cannot judge to a file in the model's folder. Return its URI."""
    from robbdd_tools.gherkin.skeleton import add_steps, free_patterns

    path = uri_to_path(uri)
    if path is None:
        ls.warn("save the model first: its steps are written to its folder")
        return []
    target = steps_file(path)
    try:
        plan = await ls.in_background(lambda snapshot: feature_plan(snapshot, uri))
        unsaved = unsaved_source(target)
        if unsaved is not None and unsaved != await asyncio.to_thread(read_text, target):
            ls.warn(f"{target} has unsaved changes: save it first")
            return []
        await asyncio.to_thread(add_steps, free_patterns(plan.model), target, path.name)
    except SyntaxError as error:
        ls.warn(f"{target}:{error.lineno or 1}: {error.msg}: fix the file first")
        return []
    except (RobbddError, OSError, UnicodeDecodeError) as error:
        ls.warn(f"{target}: {reason(error)}")
        return []
    return [path_to_uri(target)]
