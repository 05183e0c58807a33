"""What a run from the editor is to do, told by the argument of its command and the text at that moment."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from lsprotocol import types

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.features.diagnostics import all_diagnostics
from robbdd_tools.features.run_verdicts import Digests, digests_of
from robbdd_tools.gherkin.feature_files import FeaturePlan
from robbdd_tools.gherkin.select import Selected, SelectionError, Wanted
from robbdd_tools.names.clause_places import clauses_in
from robbdd_tools.names.variant_places import variants_of
from robbdd_tools.run.prepare import DEFAULT_SEED, RunRequest

if TYPE_CHECKING:
    from robbdd_tools.gherkin.feature import Numbered
    from robbdd_tools.graph.acceptance_model import AcceptanceModel, Execution, Variant
    from robbdd_tools.graph.write.built import BuiltGraph
    from robbdd_tools.lsp.convert import Converter
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.protocol.specs import ScenarioSpec

Scenario = tuple[str, int]
"""The IRI of a variant and the number of one of its scenarios."""
Executed = tuple[str, int, str]
"""A scenario with the IRI of the execution that it was run by, empty where it was run as it is."""


class ModelError(Exception):
    """The model cannot be run as it is; the message says why, for the user."""


class NothingFailed(ModelError):
    """There is nothing to run again, which is no fault of the model."""


@dataclass(frozen=True, slots=True)
class RunOptions:
    """What a client asks for, everything but ``uri`` at will.

    ``scenario`` is the name or IRI of a variant, ``variation`` the number of one of its scenarios; ``only`` lists
    what is wanted, each entry a ``variant`` (its IRI) and, if not all of them, the numbers of its scenarios as
    ``variations`` and the IRI of one ``execution`` of it; ``failed`` takes those that did not hold the last time;
    ``record`` takes a picture of each violation. ``token`` is what the run is called in its messages.
    """

    uri: str
    scenario: str | None = None
    variation: int | None = None
    only: Sequence[Mapping[str, Any]] | None = None
    token: str | None = None
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
        if not all(isinstance(entry, Mapping) and "variant" in entry for entry in known.get("only") or ()):
            raise ModelError("the command's argument has no usable 'only'")
        return cls(**known)

    @property
    def is_whole(self) -> bool:
        """Whether all scenarios of the variants are run, so that older results of them mean nothing any more."""
        numbers = {self.variation, self.where, self.first, self.sample}
        parts = (entry.get("variations") for entry in self.only or ())
        return not self.failed and numbers == {None} and all(part is None for part in parts)

    def choice(self) -> Choice | None:
        """Return what ``only`` names, ``None`` without it."""
        return None if self.only is None else Choice.of(self.only)


@dataclass(frozen=True, slots=True)
class Choice:
    """What is wanted, by variant: executions (``None``: any) with numbers of scenarios (``None``: all)."""

    entries: Mapping[str, Sequence[tuple[str | None, frozenset[int] | None]]]

    @classmethod
    def of(cls, only: Iterable[Mapping[str, Any]]) -> Choice:
        """Read the entries of ``only``."""
        entries: dict[str, list[tuple[str | None, frozenset[int] | None]]] = {}
        for entry in only:
            numbers = None if entry.get("variations") is None else frozenset(entry["variations"])
            entries.setdefault(str(entry["variant"]), []).append((entry.get("execution"), numbers))
        return cls(entries)

    def wants(self, variant: str, number: int) -> bool:
        """Tell whether a scenario is wanted, by whatever execution."""
        return any(numbers is None or number in numbers for _, numbers in self.entries.get(variant, ()))

    def wants_by(self, variant: str, number: int, execution: str) -> bool:
        """Tell whether a scenario is wanted by an execution."""
        entries = self.entries.get(variant, ())
        return any(by in (None, execution) and (numbers is None or number in numbers) for by, numbers in entries)

    def executions(self, model: AcceptanceModel) -> tuple[Execution, ...]:
        """Return the wanted executions of a model."""
        return tuple(
            one for one in model.executions if any(by in (None, one.iri) for by, _ in self.entries.get(one.variant, ()))
        )

    def names_executions(self, variant: str) -> bool:
        """Tell whether a variant is wanted only as executions say."""
        return all(by is not None for by, _ in self.entries.get(variant, ()))


_TYPES = {
    **dict.fromkeys(("uri", "scenario", "where", "token"), str),
    **dict.fromkeys(("variation", "first", "sample", "seed"), int),
    **dict.fromkeys(("failed", "record"), bool),
    "only": list,
}


@dataclass(frozen=True, slots=True)
class RunPlan:
    """What to run, and the text that it is about: digests, and the places of clauses, variants and rows.

    ``digest`` is that of the graph.
    """

    request: RunRequest
    uris: tuple[str, ...]
    digests: Digests
    places: Mapping[str, types.Location]
    rows: Mapping[Scenario, types.Location]
    digest: str


def plan_run(snapshot: Snapshot, convert: Converter, options: RunOptions, failed: Collection[Executed]) -> RunPlan:
    """Return the plan of a run; ``failed`` are the scenarios that did not hold. Raises ``ModelError``."""
    from robbdd_tools.graph.write.digest import graph_digest, joint_digest

    built = _sound_graph(snapshot, options.uri)
    model = _plan(built, snapshot).model
    every = [variant for story in model.stories for variant in story.variants]
    choice = options.choice()
    chosen = [
        variant
        for variant in every
        if _is_named(variant, options.scenario) and (choice is None or variant.iri in choice.entries)
    ]
    executions = model.executions if choice is None else choice.executions(model)
    if choice is not None:
        executed = {execution.variant for execution in executions}
        chosen = [one for one in chosen if one.iri in executed or not choice.names_executions(one.iri)]
    if not chosen and choice is not None:
        raise ModelError("the model does not have these scenarios any more")
    if not chosen:
        raise ModelError(f"there is no scenario '{options.scenario}'")
    wanted = Wanted(options.where, options.first, options.sample, None, options.seed)
    try:
        selected = Selected(model, chosen, wanted)
    except SelectionError as error:
        raise ModelError(str(error)) from None

    some_failed = {(variant, number) for variant, number, _ in failed}

    def is_wanted(variant: Variant, number: int) -> bool:
        return (
            options.variation in (None, number)
            and (choice is None or choice.wants(variant.iri, number))
            and (not options.failed or (variant.iri, number) in some_failed)
        )

    def is_wanted_so(spec: ScenarioSpec) -> bool:
        if spec.execution is None:
            return True
        executed = (spec.variant, spec.variation, spec.execution.iri)
        known = {executed, (*executed[:2], "")}
        return (choice is None or choice.wants_by(*executed)) and (not options.failed or not known.isdisjoint(failed))

    def scenarios(variant: Variant) -> Iterable[Numbered]:
        return (numbered for numbered in selected.scenarios(variant) if is_wanted(variant, numbered[0]))

    if all(next(iter(scenarios(variant)), None) is None for variant in chosen):
        raise NothingFailed("no scenario failed") if options.failed else ModelError("no scenario fits the selection")
    variants = {variant.iri for variant in chosen}
    request = RunRequest(model, options.uri, options.seed, variants, scenarios, executions, None, is_wanted_so)
    uris, places, rows = places_of(snapshot, convert, options.uri)
    digest = joint_digest([graph_digest(built)])
    return RunPlan(request, uris, digests_of(snapshot, options.uri), places, rows, digest)


def feature_plan(snapshot: Snapshot, uri: str) -> FeaturePlan:
    """Return what to write of a file without errors; raises ``ModelError``."""
    return _plan(_sound_graph(snapshot, uri), snapshot)


def _sound_graph(snapshot: Snapshot, uri: str) -> BuiltGraph:
    from robbdd_tools.graph.write.build import build_graph

    errors = [found for found in all_diagnostics(snapshot, uri) if found.severity is Severity.ERROR]
    if errors:
        raise ModelError(f"the model has errors, the first: {errors[0].message}")
    return build_graph(snapshot, uri)


def _plan(built: BuiltGraph, snapshot: Snapshot) -> FeaturePlan:
    from robbdd_tools.gherkin.feature_files import clause_origins, whole_plan
    from robbdd_tools.graph.places import placed_model

    model = placed_model(built, snapshot)
    if not any(story.variants for story in model.stories):
        raise ModelError("the model has no scenario to run")
    return whole_plan(model, clause_origins(built, snapshot, model))


def _is_named(variant: Variant, name: str | None) -> bool:
    return name is None or variant.iri == name or variant.iri.endswith((f"/{name}", f"#{name}"))


def places_of(
    snapshot: Snapshot, convert: Converter, uri: str
) -> tuple[tuple[str, ...], dict[str, types.Location], dict[Scenario, types.Location]]:
    """Return a file and what it imports, where clauses and variants stand in them, and where rows of tables do."""
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
    return tuple(files), places, rows
