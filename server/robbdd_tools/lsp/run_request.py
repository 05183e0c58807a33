"""Plan a run from the editor, and record the text that it judges."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING

from robbdd_tools.base.files import uri_to_path
from robbdd_tools.features.run_verdicts import Digests
from robbdd_tools.lsp.document_models import runnable_model
from robbdd_tools.lsp.locations import Places, places_of
from robbdd_tools.lsp.run_options import NO_SCENARIO_FAILED, select
from robbdd_tools.workbench.plan import NothingSelected, Plan
from robbdd_tools.workbench.rerun import NothingFailed

if TYPE_CHECKING:
    from robbdd_tools.features.run_verdicts import JudgedScenario
    from robbdd_tools.lsp.convert import Converter
    from robbdd_tools.lsp.run_options import RunOptions
    from robbdd_tools.names.project import Snapshot


@dataclass(frozen=True, slots=True)
class RunText:
    """The planned text of a run: the places and digests of its declarations.

    ``variants`` and ``executions`` are the IRIs of all in the model. ``seed`` is the seed that the user gave for this
    run or, when failures are executed again, for theirs; ``None`` without one. ``notes`` are shown when it starts.
    """

    uri: str
    places: Places
    digests: Digests
    variants: frozenset[str]
    executions: frozenset[str]
    seed: int | None
    notes: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class PlannedRun:
    """Scenarios to execute, number of repetitions (``repeat``; ``None``: that of the model), and the text to use."""

    plan: Plan
    repeat: int | None
    text: RunText


def plan_run(
    snapshot: Snapshot,
    convert: Converter,
    options: RunOptions,
    results: Iterable[JudgedScenario],
    substitutions: Mapping[str, str] = MappingProxyType({}),
) -> PlannedRun:
    """Plan a run; ``results`` are those of earlier runs, ``substitutions`` those of the client's settings.

    Raises ``ModelErrors``, ``NothingToRun``, ``NothingFailed`` and ``SelectionError``.
    """
    uri = options.uri
    file = runnable_model(snapshot, uri)
    model = file.acceptance
    selection, repeat = select(options, model, results, substitutions)
    try:
        plan = Plan.of_files(uri, uri_to_path(uri), (file,), selection)
    except NothingSelected:
        if options.failed:
            raise NothingFailed(NO_SCENARIO_FAILED) from None
        raise
    text = RunText(
        uri,
        places_of(snapshot, convert, uri),
        plan.texts.texts[0].digests,
        frozenset(str(variant.iri) for story in model.stories for variant in story.variants),
        frozenset(str(execution.iri) for execution in model.executions),
        selection.seed,
        tuple(map(str, plan.covers)),
    )
    return PlannedRun(plan, repeat, text)
