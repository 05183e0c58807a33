"""What a run from the editor is to do, told by the argument of its command and the text at that moment."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from lsprotocol import types

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.features.diagnostics import all_diagnostics
from robbdd_tools.features.results import Digests, digests_of
from robbdd_tools.gherkin.files import FeaturePlan
from robbdd_tools.gherkin.select import Selected, SelectionError, Wanted
from robbdd_tools.names.clauses import clauses_in
from robbdd_tools.names.variants import variants_of
from robbdd_tools.run.prepare import DEFAULT_SEED, RunRequest

if TYPE_CHECKING:
    from robbdd_tools.gherkin.feature import Numbered
    from robbdd_tools.graph.model import Variant
    from robbdd_tools.lsp.convert import Converter
    from robbdd_tools.names.project import Snapshot

Scenario = tuple[str, int]
"""The IRI of a variant and the number of one of its scenarios."""


class ModelError(Exception):
    """The model cannot be run as it is; the message says why, for the user."""


@dataclass(frozen=True, slots=True)
class RunOptions:
    """What a client asks for, everything but ``uri`` at will.

    ``scenario`` is the name or IRI of a variant, ``variation`` the number of one of its scenarios; ``failed`` takes
    those that did not hold the last time; ``record`` takes a picture of each violation.
    """

    uri: str
    scenario: str | None = None
    variation: int | None = None
    failed: bool = False
    record: bool = False
    where: str | None = None
    first: int | None = None
    sample: int | None = None
    seed: int = DEFAULT_SEED

    @classmethod
    def of(cls, argument: Mapping[str, Any]) -> RunOptions:
        """Read the argument of a command; raises ``ModelError`` for one that is not as documented."""
        known = {name: argument[name] for name in cls.__slots__ if argument.get(name) is not None}
        known.setdefault("scenario", argument.get("variant"))
        wrong = [name for name, value in known.items() if value is not None and not isinstance(value, _TYPES[name])]
        if wrong or "uri" not in known:
            raise ModelError(f"the command's argument has no usable '{(wrong or ['uri'])[0]}'")
        return cls(**known)

    @property
    def is_whole(self) -> bool:
        """Whether all scenarios of the variants are run, so that older results of them mean nothing any more."""
        return not self.failed and {self.variation, self.where, self.first, self.sample} == {None}


_TYPES = {
    **dict.fromkeys(("uri", "scenario", "where"), str),
    **dict.fromkeys(("variation", "first", "sample", "seed"), int),
    **dict.fromkeys(("failed", "record"), bool),
}


@dataclass(frozen=True, slots=True)
class RunPlan:
    """What to run, and the text that it is about: digests, and the places of clauses, variants and rows."""

    request: RunRequest
    uris: tuple[str, ...]
    digests: Digests
    places: Mapping[str, types.Location]
    rows: Mapping[Scenario, types.Location]


def plan_run(snapshot: Snapshot, convert: Converter, options: RunOptions, failed: Collection[Scenario]) -> RunPlan:
    """Return the plan of a run; ``failed`` are the scenarios that did not hold. Raises ``ModelError``."""
    model = feature_plan(snapshot, options.uri).model
    every = [variant for story in model.stories for variant in story.variants]
    chosen = [variant for variant in every if _is_named(variant, options.scenario)]
    if not chosen:
        raise ModelError(f"there is no scenario '{options.scenario}'")
    wanted = Wanted(options.where, options.first, options.sample, None, options.seed)
    try:
        selected = Selected(model, chosen, wanted)
    except SelectionError as error:
        raise ModelError(str(error)) from None

    def scenarios(variant: Variant) -> Iterable[Numbered]:
        return (
            numbered
            for numbered in selected.scenarios(variant)
            if options.variation in (None, numbered[0]) and (not options.failed or (variant.iri, numbered[0]) in failed)
        )

    if all(next(iter(scenarios(variant)), None) is None for variant in chosen):
        raise ModelError("no scenario failed" if options.failed else "no scenario fits the selection")
    variants = {variant.iri for variant in chosen}
    request = RunRequest(model, options.uri, options.seed, variants, scenarios)
    return RunPlan(request, *_text(snapshot, convert, options.uri))


def feature_plan(snapshot: Snapshot, uri: str) -> FeaturePlan:
    """Return what to write of a file without errors; raises ``ModelError``."""
    from robbdd_tools.gherkin.files import clause_origins, whole_plan
    from robbdd_tools.graph.build import build_graph
    from robbdd_tools.graph.places import placed_model

    errors = [found for found in all_diagnostics(snapshot, uri) if found.severity is Severity.ERROR]
    if errors:
        raise ModelError(f"the model has errors, the first: {errors[0].message}")
    built = build_graph(snapshot, uri)
    model = placed_model(built, snapshot)
    if not any(story.variants for story in model.stories):
        raise ModelError("the model has no scenario to run")
    return whole_plan(model, clause_origins(built, snapshot, model))


def _is_named(variant: Variant, name: str | None) -> bool:
    return name is None or variant.iri == name or variant.iri.endswith((f"/{name}", f"#{name}"))


def _text(
    snapshot: Snapshot, convert: Converter, uri: str
) -> tuple[tuple[str, ...], Digests, dict[str, types.Location], dict[Scenario, types.Location]]:
    places: dict[str, types.Location] = {}
    rows: dict[Scenario, types.Location] = {}
    files = [file.document.uri for file in snapshot.closure(uri)]
    for name in files:
        for clause in clauses_in(snapshot, name):
            places[clause.iri] = convert.location(snapshot, name, clause.span)
        for variant in variants_of(snapshot, name):
            places[variant.iri] = convert.location(snapshot, name, variant.definition.span)
            for number, row in enumerate(variant.rows, start=1):
                rows[variant.iri, number] = convert.location(snapshot, name, row)
    return tuple(files), digests_of(snapshot, uri), places, rows
