"""Plan a run: which scenarios of which models it executes, with which seeds, and how often. No other module plans."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.gherkin.select import Selected, SelectionError, Wanted
from robbdd_tools.monitor.without_physics import KINEMATIC
from robbdd_tools.run.prepare import DEFAULT_SEED, RunRequest, prepare_all, specs_of
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.workbench.judged_text import judged_texts
from robbdd_tools.workbench.points import with_points
from robbdd_tools.workbench.scene_choice import NOTHING_TO_PLACE, SceneChoiceError, in_instances, uses_instances
from robbdd_tools.workbench.substitution import refuse_unknown, substitute

if TYPE_CHECKING:
    from robbdd_tools.catalog.executable import SceneInstance
    from robbdd_tools.gherkin.covering import Cover
    from robbdd_tools.gherkin.feature import Numbered
    from robbdd_tools.graph.acceptance_model import AcceptanceModel, Execution, Iri, Variant
    from robbdd_tools.protocol.specs import Manifest, ScenarioSpec
    from robbdd_tools.workbench.choice import Choice
    from robbdd_tools.workbench.folder import Keeping
    from robbdd_tools.workbench.judged_text import JudgedTexts
    from robbdd_tools.workbench.model import Model, ModelFile
    from robbdd_tools.workbench.points import Points
    from robbdd_tools.workbench.run import Run
    from robbdd_tools.workbench.time_estimate import TimeEstimate

NO_SCENARIO_FITS = "no scenario fits the selection"
MODELS_CHANGED = "the model no longer has these scenarios"


class NothingSelected(SelectionError):
    """The selection is valid, but it contains no scenario."""


@dataclass(frozen=True, slots=True)
class Selection:
    """A user's selection. An empty selection selects everything.

    - ``names``: variants or executions, by local name, CURIE or IRI.
    - ``where``: a condition on the values of a scenario.
    - ``first``, ``sample`` and ``pairwise``: at most one of them reduces the scenarios that satisfy ``where``.
    - ``choices``: lists of scenarios. A scenario must be in each list.
    - ``only``: a condition that a scenario must satisfy, too.
    - ``seed``: the seed of the sample and, unless the run has its own, of the run.
    - ``default_seed``: the seed if neither the user nor an execution of a model gives one.
    - ``substitutions``: maps implementations of behaviours (local name, CURIE or IRI) to the catalog behaviours to
      execute instead.
    - ``default_substitutions``: like ``substitutions``, but implementations that the models lack are ignored.
    - ``instances``: scene instances. A scenario without an execution runs in the one that instantiates its scene.
    - ``world``: the simulator, such as ``kinematic``; empty for physics.
    - ``default_instances``: like ``instances``, but scenarios whose scene has none are placed as without.
    - ``points``: values of variables that replace those of the models.
    """

    names: Sequence[str] = ()
    where: str | None = None
    first: int | None = None
    sample: int | None = None
    pairwise: int | None = None
    seed: int | None = None
    choices: Sequence[Choice] = ()
    is_wanted: Callable[[ScenarioSpec], bool] | None = None
    default_seed: int = DEFAULT_SEED
    substitutions: Mapping[str, str] = field(default_factory=dict[str, str])
    default_substitutions: Mapping[str, str] = field(default_factory=dict[str, str])
    instances: Sequence[SceneInstance] = ()
    default_instances: Sequence[SceneInstance] = ()
    world: str = ""
    points: Points | None = None

    def wanted(self) -> Wanted:
        """Return the part of the selection that concerns the values of scenarios."""
        seed = self.default_seed if self.seed is None else self.seed
        return Wanted(self.where, self.first, self.sample, self.pairwise, seed)

    def admits_spec(self, spec: ScenarioSpec) -> bool:
        """Return whether a specified execution satisfies ``choices`` and ``is_wanted``."""
        is_chosen = all(choice.admits_spec(spec) for choice in self.choices)
        return is_chosen and (self.is_wanted is None or self.is_wanted(spec))


@dataclass(frozen=True, slots=True)
class Coverage:
    """Coverage of a covering array: a variant's CURIE, the numbers of scenarios, of covered and of all combinations."""

    variant: str
    scenarios: int
    covered: int
    possible: int

    def __str__(self) -> str:
        scenarios = f"{self.scenarios} scenario{'' if self.scenarios == 1 else 's'}"
        return f"{self.variant}: {scenarios} with {self.covered} of {self.possible} combinations"


@dataclass(frozen=True)
class Plan:
    """A selection of scenarios from some models.

    ``name`` is the common name of the models in reports. ``path`` is their file or folder; ``None`` for a text without
    a file. If there are several files and folders, ``models`` contains them.
    """

    name: str
    path: Path | None
    files: tuple[ModelFile, ...]
    selection: Selection
    requests: tuple[RunRequest, ...]
    covers: tuple[Coverage, ...]
    models: tuple[Path, ...] = ()

    @classmethod
    def of(cls, model: Model, selection: Selection) -> Plan:
        """Return the plan of a model.

        Raises ``ModelErrors``, ``NothingToRun``, ``SelectionError`` and ``SceneChoiceError``.
        """
        plan = cls.of_files(str(model.path), model.path, model.runnable, selection)
        return replace(plan, models=tuple(model.paths) if len(model.paths) > 1 else ())

    @classmethod
    def of_files(cls, name: str, path: Path | None, files: tuple[ModelFile, ...], selection: Selection) -> Plan:
        """Return the plan of sound models with scenarios; raises ``SelectionError`` and ``SceneChoiceError``."""
        planner = _Planner(files, selection)
        return cls(name, path, files, selection, tuple(planner.requests()), tuple(planner.covers))

    @cached_property
    def digest(self) -> str:
        """The common digest of the graphs of all models."""
        from robbdd_tools.graph.write.digest import joint_digest

        return joint_digest(file.digest for file in self.files)

    @cached_property
    def texts(self) -> JudgedTexts:
        """The texts of the models. They are read at the first access."""
        listed = (entry for choice in self.selection.choices for entry in choice.every())
        files = ((file.name, file.snapshot, file.uri) for file in self.files)
        return judged_texts(files, some_repetitions=any(entry.repetitions is not None for entry in listed))

    @cached_property
    def scenarios(self) -> tuple[ScenarioSpec, ...]:
        """The scenarios in the order of execution, with the names, values and seeds of a run without options."""
        with tempfile.TemporaryDirectory(prefix="robbdd-") as folder:
            return self.prepare(Path(folder)).scenarios

    def __len__(self) -> int:
        """Return the number of executions."""
        return len(self.scenarios)

    def run(
        self,
        *,
        seed: int | None = None,
        repeat: int | None = None,
        jobs: int | None = None,
        timeout: float | None = None,
        stop_on_failure: bool = False,
        keeping: Keeping | None = None,
    ) -> Run:
        """Return a run of the plan, to be used as a context manager. Raises ``OSError`` and ``NothingSelected``.

        - ``seed`` and ``repeat``: replace those of the model.
        - ``jobs``: the number of agent processes; by default, the number of cores.
        - ``timeout``: the limit of wall time for one scenario in s; 0 for no limit.
        - ``keeping``: where the run is stored; by default, in the store of the model's project.
        """
        from robbdd_tools.workbench.folder import Keeping, new_folder
        from robbdd_tools.workbench.run import Run

        place = new_folder(self.path or Path(), keeping or Keeping())
        policy = Policy.of(jobs=jobs, timeout=timeout, stop_on_failure=stop_on_failure)
        return Run.begin(self, place.place, policy, seed=seed, repeat=repeat, on_close=place.remove)

    def prepare(
        self, folder: Path, *, seed: int | None = None, repeat: int | None = None, traces: bool = False
    ) -> Manifest:
        """Write everything that agents need into ``folder``. Raises ``OSError`` and ``NothingSelected``.

        ``seed`` replaces the seeds of the selection and of executions. ``repeat`` replaces their number of repetitions.
        If ``traces`` is true, the run keeps its traces.
        """
        chosen = self.selection.seed if seed is None else seed
        requests = self._requests_with(chosen, repeat)
        own = self.selection.default_seed if chosen is None else chosen
        manifest = prepare_all(requests, self.name, own, folder, traces)
        if not manifest.scenarios:
            raise NothingSelected(NO_SCENARIO_FITS)
        return manifest

    def specs(self, *, repeat: int | None = None) -> Iterator[ScenarioSpec]:
        """Yield the scenarios as ``prepare`` does, without writing files. They name no feature."""
        return specs_of(self._requests_with(self.selection.seed, repeat))

    def estimate(self, *, repeat: int | None = None, jobs: int | None = None) -> TimeEstimate:
        """Estimate the duration of a run from stored executions of the same variants. Raises ``DatabaseProblem``.

        The executions are those in the store of the model's project. ``repeat`` and ``jobs`` are those of ``run``.
        """
        from robbdd_tools.run.store import store_beside
        from robbdd_tools.workbench.time_estimate import estimate

        return estimate(
            self.specs(repeat=repeat), store_beside(self.path or Path()).database, Policy.of(jobs=jobs).jobs
        )

    def _requests_with(self, seed: int | None, repeat: int | None) -> list[RunRequest]:
        return [_with(request, seed, repeat) for request in self.requests]


def _with(request: RunRequest, seed: int | None, repeat: int | None) -> RunRequest:
    """Return a request with another seed and number of repetitions. The seed also replaces the seeds of executions."""
    if seed is not None:
        executions = tuple(replace(execution, seed=None) for execution in request.chosen_executions())
        request = replace(request, seed=seed, executions=executions)
    return replace(request, repeat=repeat)


class _Planner:
    """Selects scenarios from models in order. Each variant and execution is taken from the first model that has it."""

    def __init__(self, files: Sequence[ModelFile], selection: Selection) -> None:
        self._files = files
        self._selection = selection
        self._taken: set[Iri] = set()
        self.covers: list[Coverage] = []

    def requests(self) -> list[RunRequest]:
        """Return a request for each model with something selected.

        Raises ``SelectionError`` and ``SceneChoiceError``.
        """
        self._refuse_unknown_names()
        refuse_unknown((file.acceptance for file in self._files), self._selection.substitutions)
        found: list[RunRequest] = []
        problems: list[SelectionError] = []
        for file in self._files:
            try:
                request = self._request(file)
            except SelectionError as error:
                problems.append(error)
            else:
                found += [] if request is None else [request]
        if found and self._selection.instances and not any(map(uses_instances, found)):
            raise SceneChoiceError(NOTHING_TO_PLACE)
        if not found:
            raise problems[0] if problems else NothingSelected(MODELS_CHANGED)
        return found

    def _request(self, file: ModelFile) -> RunRequest | None:
        selection = self._selection
        model = with_points(file.acceptance, selection.points)
        model = substitute(model, {**selection.default_substitutions, **selection.substitutions})
        executions = tuple(one for one in self._executions(model) if one.iri not in self._taken)
        model = self._in_instances(model, executions)
        executed = {execution.variant for execution in executions}
        variants = [
            one
            for one in self._variants(model)
            if (one.iri in executed if model.executions else one.iri not in self._taken)
        ]
        self._taken.update(one.iri for one in (*variants, *executions))
        if not variants:
            return None
        selected = Selected(model, variants, selection.wanted())
        self.covers += coverage(model, selected.covers)

        def scenarios(variant: Variant) -> Iterable[Numbered]:
            for one in selected.scenarios(variant):
                if all(choice.admits(variant.iri, one[0]) for choice in selection.choices):
                    yield one

        if all(next(iter(scenarios(variant)), None) is None for variant in variants):
            raise NothingSelected(NO_SCENARIO_FITS)
        return RunRequest(
            model,
            file.name,
            selection.wanted().seed,
            frozenset(variant.iri for variant in variants),
            scenarios,
            executions,
            is_wanted=selection.admits_spec,
            completed=partial(replace, world=KINEMATIC) if selection.world == KINEMATIC else None,
        )

    def _in_instances(self, model: AcceptanceModel, executions: Sequence[Execution]) -> AcceptanceModel:
        instances = self._selection.instances
        own = {execution.variant for execution in executions if execution.scene is not None}
        plain = [one.iri for one in self._variants(model) if one.iri not in self._taken]
        needing = frozenset(iri for iri in plain if iri not in own)
        return in_instances(model, needing, instances or self._selection.default_instances, must_fit=bool(instances))

    def _executions(self, model: AcceptanceModel) -> Iterable[Execution]:
        for execution in model.executions:
            names = {*_names(model, execution.iri), *_names(model, execution.variant)}
            if self._names_any(names) and all(one.admits_execution(execution) for one in self._selection.choices):
                yield execution

    def _variants(self, model: AcceptanceModel) -> Iterable[Variant]:
        executed = {execution.variant for execution in self._executions(model)}
        for variant in (variant for story in model.stories for variant in story.variants):
            named = variant.iri in executed or (not model.executions and self._names_any(_names(model, variant.iri)))
            if named and all(choice.entries(variant.iri) for choice in self._selection.choices):
                yield variant

    def _names_any(self, names: set[str]) -> bool:
        return not self._selection.names or not names.isdisjoint(self._selection.names)

    def _refuse_unknown_names(self) -> None:
        local: set[str] = set()
        known: set[str] = set()
        for file in self._files:
            model = file.acceptance
            executed = {execution.variant for execution in model.executions}
            every = [variant.iri for story in model.stories for variant in story.variants]
            iris = [one for one in every if one in executed or not executed]
            for iri in (*iris, *(execution.iri for execution in model.executions)):
                known |= _names(model, iri)
                local.add(_local(model, iri))
        for name in self._selection.names:
            if name not in known:
                raise SelectionError(f"there is no scenario '{name}'; the model has {', '.join(sorted(local))}")


def coverage(model: AcceptanceModel, covers: Mapping[Iri, Cover]) -> Iterable[Coverage]:
    """Yield the coverage of each covering array of a selection."""
    for iri, cover in covers.items():
        yield Coverage(model.curie(iri), len(cover.indices), cover.covered, cover.possible)


def _names(model: AcceptanceModel, iri: Iri) -> set[str]:
    return {str(iri), model.curie(iri), _local(model, iri)}


def _local(model: AcceptanceModel, iri: Iri) -> str:
    return model.curie(iri).rsplit(":", 1)[-1]
