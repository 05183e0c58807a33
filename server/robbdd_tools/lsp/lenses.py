"""Code lenses and source actions that run scenarios and executions, at their declarations."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Any, NamedTuple

from lsprotocol import types

from robbdd_tools.base.checkpoint import checkpoint
from robbdd_tools.features.clause_results import appearance
from robbdd_tools.features.executions import executions_of
from robbdd_tools.features.pass_rates import PassRate, execution_rate, pass_rate
from robbdd_tools.features.scenarios import number_of_scenarios, scenario_numbers
from robbdd_tools.features.studies import is_study
from robbdd_tools.lsp.commands import GHERKIN, RECORD, RERUN, RUN
from robbdd_tools.lsp.convert import Converter, document_of
from robbdd_tools.lsp.json_text import JsonText, Passages, joined
from robbdd_tools.lsp.requirement_lenses import requirement_lenses
from robbdd_tools.lsp.result_hover import REPLAY
from robbdd_tools.lsp.server import RobbddServer
from robbdd_tools.lsp.study_lenses import study_lenses
from robbdd_tools.names.uses import clauses_of
from robbdd_tools.names.variant_places import VariantIris, variants_of

if TYPE_CHECKING:
    from robbdd_tools.base.document import Document, Span
    from robbdd_tools.features.executions import PlacedExecution
    from robbdd_tools.features.run_verdicts import Findings
    from robbdd_tools.names.analysis import PlacedDeclaration
    from robbdd_tools.names.project import Snapshot

DEBUG = "robbdd.debugScenario"
"""Command of clients that announce ``debugging``. It begins to debug an execution, with breakpoints on clauses."""


@dataclass(frozen=True, slots=True)
class _Runnable:
    """A scenario variant, or an execution of one, that can be run.

    ``choice`` has the options of the command that runs it; ``debugged``, the options of the command that debugs it.
    ``number`` is the number of its scenarios, if known. ``variant`` is the IRI of the variant; ``None`` for an
    execution.
    """

    uri: str
    choice: dict[str, Any]
    debugged: dict[str, Any]
    number: int | None
    rate: PassRate | None
    variant: str | None = None

    def command(self, title: str, command: str) -> types.Command:
        target = {"uri": self.uri, **self.choice}
        return types.Command(title=title, command=command, arguments=[target])


class _State(NamedTuple):
    """Data on which the lenses of a variant depend in addition to its text. A variant without an IRI has no lenses.

    A tuple, because thousands of them are made and compared after each keystroke.
    """

    iri: str | None
    number: int | None
    rate: PassRate | None
    recorded: bool


class LensWriter:
    """Writes the lenses of scenarios and executions as JSON text. The text of an unchanged declaration is kept.

    ``debugs`` is true if the client can debug scenarios, ``counts`` if it shows no inlay hints, so that the number of a
    variant's scenarios is shown here.
    """

    def __init__(self, serialise: Callable[[Any], str], *, debugs: bool, counts: bool) -> None:
        self._serialise = serialise
        self._passages = Passages(serialise)
        self._debugs, self._counts = debugs, counts

    def text(
        self, convert: Converter, snapshot: Snapshot, uri: str, findings: Findings, recorded: Set[str] = frozenset()
    ) -> JsonText:
        """Return the lenses of a file, in text order. ``recorded`` are the IRIs of variants with a recording."""
        file, document = snapshot.file(uri), document_of(snapshot, uri)
        if file is None:
            return JsonText("[]")
        texts: list[str] = []
        iris = VariantIris(snapshot, file)
        for placed, numbers in scenario_numbers(snapshot, file):
            checkpoint()
            own = iris.of(placed)
            was_run = any(iri in findings.variants for iri in own) if findings.variants else False
            counts = dict(zip(own, numbers, strict=True))
            rates = _rates(snapshot, uri, placed, findings, counts) if was_run else {}
            states = tuple(
                [_State(iri, number, rates.get(iri), iri in recorded) for iri, number in zip(own, numbers, strict=True)]
            )

            def make(
                alone: Document,
                offset: int,
                placed: PlacedDeclaration = placed,
                states: tuple[_State, ...] = states,
            ) -> list[types.CodeLens]:
                return list(self._of_variants(convert, alone, uri, (placed, offset), states))

            texts.append(
                self._passages.text(convert, document, (placed.offset, placed.declaration), make, (uri, states))
            )
        for one in executions_of(snapshot, uri):
            place = convert.range(document, one.definition.span)
            found = self._lenses(_of_execution(snapshot, one, findings), place, recorded=False)
            texts.append(joined(map(self._serialise, found)))
        texts.append(joined(map(self._serialise, requirement_lenses(convert, snapshot, uri, findings))))
        return JsonText(f"[{joined(texts)}]")

    def _of_variants(
        self,
        convert: Converter,
        alone: Document,
        uri: str,
        at: tuple[PlacedDeclaration, int],
        states: Sequence[_State],
    ) -> Iterator[types.CodeLens]:
        placed, offset = at
        for clauses, state in zip(clauses_of(placed.declaration), states, strict=True):
            if state.iri is not None:
                place = convert.range(alone, clauses.node.name.span.shifted(offset))
                one = _of_variant(uri, state.iri, state.number, state.rate)
                yield from self._lenses(one, place, recorded=state.recorded)

    def _lenses(self, one: _Runnable, place: types.Range, *, recorded: bool) -> Iterator[types.CodeLens]:
        for command in _commands(one, recorded=recorded, debugs=self._debugs):
            yield types.CodeLens(place, command)
        # An execution has no hint.
        if one.number is not None and (self._counts or one.variant is None):
            title = f"{one.number:,} scenario{'' if one.number == 1 else 's'}"
            yield types.CodeLens(place, types.Command(title=title, command=""))
        if one.rate is not None:
            # A lens without a command is plain text.
            yield types.CodeLens(place, types.Command(title=one.rate.label, command=""), data=appearance(one.rate))


def register_lenses(server: RobbddServer) -> None:
    """Add the code lenses to a server."""
    # pygls declares the base class of the protocol only.
    protocol: Any = server.protocol
    kinds = product((False, True), repeat=2)
    writers = {
        (debugs, counts): LensWriter(protocol.serialised, debugs=debugs, counts=counts) for debugs, counts in kinds
    }

    @server.feature(types.TEXT_DOCUMENT_CODE_LENS)
    async def code_lens(ls: RobbddServer, params: types.CodeLensParams) -> list[types.CodeLens] | JsonText:
        uri = params.text_document.uri
        if is_study(uri):
            return await ls.analyse(lambda snapshot: study_lenses(ls, snapshot, uri))
        recorded = await asyncio.to_thread(ls.stores.replayable, uri) if ls.shows_replays else frozenset[str]()
        writer = writers[ls.debugs_scenarios, not _shows_hints(ls)]
        return await ls.analyse(
            lambda snapshot: writer.text(ls.convert, snapshot, uri, ls.findings_of(snapshot, uri), recorded)
        )


def _shows_hints(ls: RobbddServer) -> bool:
    able = ls.client_capabilities.text_document
    return able is not None and able.inlay_hint is not None


def source_actions(snapshot: Snapshot, uri: str, span: Span, findings: Findings) -> Iterator[types.CodeAction]:
    """Return the actions on the scenarios in a part of a file, and on the whole file."""
    commands: list[types.Command] = []
    for one in variants_of(snapshot, uri, span):
        runnable = _of_variant(uri, one.iri, None, None)
        commands.append(runnable.command(f"Run scenario {one.definition.symbol.name}", RUN))
    for one in executions_of(snapshot, uri):
        if one.definition.extent.start <= span.end and span.start <= one.definition.extent.end:
            runnable = _of_execution(snapshot, one, findings)
            commands.append(runnable.command(f"Run execution {one.definition.symbol.name}", RUN))
    if next(variants_of(snapshot, uri), None) is not None:
        commands.append(_gherkin(uri))
    for command in commands:
        yield types.CodeAction(title=command.title, kind=types.CodeActionKind.Source, command=command)


def _rates(
    snapshot: Snapshot,
    uri: str,
    placed: PlacedDeclaration,
    findings: Findings,
    counts: Mapping[str | None, int | None],
) -> dict[str | None, PassRate]:
    """Return the pass rates of the variants of a story that were run, by their IRIs. ``counts`` are their scenarios."""
    around = variants_of(snapshot, uri, placed.span)
    inside = (one for one in around if one.site.placed is placed)
    found = ((one.iri, pass_rate(snapshot, one, findings, counts.get(one.iri))) for one in inside)
    return {iri: rate for iri, rate in found if rate is not None}


def _of_variant(uri: str, iri: str, number: int | None, rate: PassRate | None) -> _Runnable:
    return _Runnable(uri, {"scenario": iri}, {"scenario": iri, "variant": iri}, number, rate, iri)


def _of_execution(snapshot: Snapshot, one: PlacedExecution, findings: Findings) -> _Runnable:
    choice = {"only": [{"variant": one.variant.iri, "execution": one.iri}]}
    debugged = {"scenario": one.iri, "variant": one.variant.iri}
    number = number_of_scenarios(one.variant)
    rate = execution_rate(snapshot, one, findings, number)
    return _Runnable(one.definition.uri, choice, debugged, number, rate)


def _commands(one: _Runnable, *, recorded: bool, debugs: bool) -> Iterator[types.Command]:
    rate = one.rate
    yield one.command("Run", RUN)
    if debugs:
        target = {"uri": one.uri, **one.debugged, "count": one.number}
        yield types.Command(title="Debug", command=DEBUG, arguments=[target])
    if rate is not None and rate.passed < rate.run:
        yield one.command(f"Rerun {rate.run - rate.passed} failed", RERUN)
    yield one.command("Record", RECORD)
    if recorded:
        target = {"uri": one.uri, "variant": one.variant}
        yield types.Command(title="Replay", command=REPLAY, arguments=[target])
    if one.variant is not None:
        yield _gherkin(one.uri)


def _gherkin(uri: str) -> types.Command:
    return types.Command(title="Generate Gherkin", command=GHERKIN, arguments=[{"uri": uri}])
