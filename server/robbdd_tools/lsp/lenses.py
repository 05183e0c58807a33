"""Code lenses and source actions that run scenarios and executions, at their declarations."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from lsprotocol import types

from robbdd_tools.features.clause_results import PassRate, appearance, execution_rate, pass_rate
from robbdd_tools.features.executions import executions_of
from robbdd_tools.features.scenarios import number_of_scenarios
from robbdd_tools.features.studies import is_study
from robbdd_tools.lsp.commands import GHERKIN, RECORD, RERUN, RUN
from robbdd_tools.lsp.convert import document_of
from robbdd_tools.lsp.result_hover import REPLAY
from robbdd_tools.lsp.server import RobbddServer
from robbdd_tools.lsp.study_lenses import study_lenses
from robbdd_tools.names.variant_places import variants_of

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.features.run_verdicts import Findings
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot

DEBUG = "robbdd.debugScenario"
"""Command of clients that announce ``debugging``: it begins to debug an execution, with breakpoints on clauses."""


@dataclass(frozen=True, slots=True)
class _Runnable:
    """A scenario variant, or an execution of one, that can be run.

    ``choice`` are the options of the command that runs it, ``debugged`` those of the command that debugs it. ``number``
    is the number of its scenarios, if known. ``variant`` is the IRI of the variant; ``None`` for an execution.
    """

    definition: Definition
    title: str
    choice: dict[str, Any]
    debugged: dict[str, Any]
    number: int | None
    rate: PassRate | None
    variant: str | None = None

    def command(self, title: str, command: str) -> types.Command:
        target = {"uri": self.definition.uri, **self.choice}
        return types.Command(title=title, command=command, arguments=[target])

    def touches(self, span: Span) -> bool:
        extent = self.definition.extent
        return extent.start <= span.end and span.start <= extent.end


def register_lenses(server: RobbddServer) -> None:
    """Add the code lenses to a server."""

    @server.feature(types.TEXT_DOCUMENT_CODE_LENS)
    async def code_lens(ls: RobbddServer, params: types.CodeLensParams) -> list[types.CodeLens]:
        uri = params.text_document.uri
        if is_study(uri):
            return await ls.analyse(lambda snapshot: study_lenses(ls, snapshot, uri))
        recorded = await asyncio.to_thread(ls.stores.replayable, uri) if ls.shows_replays else frozenset[str]()

        def find(snapshot: Snapshot) -> list[types.CodeLens]:
            document = document_of(snapshot, uri)
            found: list[types.CodeLens] = []
            for one in _runnable(snapshot, uri, ls.findings_of(snapshot, uri)):
                place = ls.convert.range(document, one.definition.span)
                commands = _lenses(one, recorded=one.variant in recorded, debugs=ls.debugs_scenarios)
                found += [types.CodeLens(place, command) for command in commands]
                if one.rate is not None:
                    # A lens without a command is plain text.
                    words = types.Command(title=one.rate.label, command="")
                    found.append(types.CodeLens(place, words, data=appearance(one.rate)))
            return found

        return await ls.analyse(find)


def source_actions(snapshot: Snapshot, uri: str, span: Span, findings: Findings) -> Iterator[types.CodeAction]:
    """Return the actions on the scenarios in a part of a file, and on the whole file."""
    every = list(_runnable(snapshot, uri, findings))
    commands = [one.command(one.title, RUN) for one in every if one.touches(span)]
    if any(one.variant is not None for one in every):
        commands.append(_gherkin(uri))
    for command in commands:
        yield types.CodeAction(title=command.title, kind=types.CodeActionKind.Source, command=command)


def _runnable(snapshot: Snapshot, uri: str, findings: Findings) -> Iterator[_Runnable]:
    for one in variants_of(snapshot, uri):
        title = f"Run scenario {one.definition.symbol.name}"
        rate = pass_rate(snapshot, one, findings)
        debugged = {"scenario": one.iri, "variant": one.iri}
        yield _Runnable(one.definition, title, {"scenario": one.iri}, debugged, number_of_scenarios(one), rate, one.iri)
    for one in executions_of(snapshot, uri):
        title = f"Run execution {one.definition.symbol.name}"
        choice = {"only": [{"variant": one.variant.iri, "execution": one.iri}]}
        debugged = {"scenario": one.iri, "variant": one.variant.iri}
        rate = execution_rate(snapshot, one, findings)
        yield _Runnable(one.definition, title, choice, debugged, number_of_scenarios(one.variant), rate)


def _lenses(one: _Runnable, *, recorded: bool, debugs: bool) -> Iterator[types.Command]:
    rate = one.rate
    yield one.command("Run", RUN)
    if debugs:
        target = {"uri": one.definition.uri, **one.debugged, "count": one.number}
        yield types.Command(title="Debug", command=DEBUG, arguments=[target])
    if rate is not None and rate.passed < rate.run:
        yield one.command(f"Rerun {rate.run - rate.passed} failed", RERUN)
    yield one.command("Record", RECORD)
    if recorded:
        target = {"uri": one.definition.uri, "variant": one.variant}
        yield types.Command(title="Replay", command=REPLAY, arguments=[target])
    if one.variant is not None:
        yield _gherkin(one.definition.uri)
    if one.number is not None:
        yield types.Command(title=f"{one.number:,} scenario{'' if one.number == 1 else 's'}", command="")


def _gherkin(uri: str) -> types.Command:
    return types.Command(title="Generate Gherkin", command=GHERKIN, arguments=[{"uri": uri}])
