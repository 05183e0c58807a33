"""Plan a run from the editor, and record the text that the run judges."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
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
    from robbdd_tools.lsp.run_options import RunDefaults, RunOptions
    from robbdd_tools.names.project import Snapshot


@dataclass(frozen=True, slots=True)
class RunText:
    """The text that a run judges: the places and digests of its declarations.

    - ``variants`` and ``executions``: the IRIs of all variants and executions in the model.
    - ``seed``: the seed that the user gave, or ``None``. If failures are executed again, this is the seed of the run in
      which they failed.
    - ``notes``: messages to show when the run starts.
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
    """A planned run: the scenarios to execute and the text that they judge.

    ``repeat`` is the number of repetitions; ``None`` takes the number that the model states.
    """

    plan: Plan
    repeat: int | None
    text: RunText


def plan_run(
    snapshot: Snapshot,
    convert: Converter,
    options: RunOptions,
    results: Iterable[JudgedScenario],
    defaults: RunDefaults | None = None,
) -> PlannedRun:
    """Plan a run. Raises ``ModelErrors``, ``NothingToRun``, ``NothingFailed`` and the errors of ``select``.

    ``results`` are the results of earlier runs. ``defaults`` are those in the client's settings.
    """
    uri = options.uri
    file = runnable_model(snapshot, uri)
    model = file.acceptance
    selection, repeat = select(options, model, results, defaults)
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
