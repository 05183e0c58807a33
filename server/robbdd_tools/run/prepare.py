"""Prepare a run folder: features, behave's hooks and steps, the manifest, the graph as JSON-LD."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from robbdd_tools.base.files import load_bytes, uri_to_path
from robbdd_tools.base.step_files import steps_file
from robbdd_tools.base.writing import replace_file
from robbdd_tools.catalog.robot_faults import RobotFault
from robbdd_tools.gherkin.feature import Numbered, ScenarioText, every_scenario, feature_pieces
from robbdd_tools.gherkin.feature_files import FeaturePlan, only, whole_plan, written_scenarios
from robbdd_tools.graph.acceptance_model import AcceptanceModel, Execution, Iri, Story, Variant
from robbdd_tools.protocol.manifest_file import written_manifest
from robbdd_tools.protocol.run_folder import OWN_STEPS
from robbdd_tools.protocol.specs import Manifest, ScenarioSpec
from robbdd_tools.run.related_scenarios import Relations
from robbdd_tools.run.scenario_specs import SpecWriter

DEFAULT_SEED = 1
FEATURES = "features"
MODEL_STEPS = "model_steps.py"
_ENVIRONMENT = '''"""Hooks that manage the simulated world during a behave run."""

from robbdd_tools.agent.hooks import after_all, after_scenario, after_step, before_all, before_scenario, before_step

__all__ = ["after_all", "after_scenario", "after_step", "before_all", "before_scenario", "before_step"]
'''
_STEPS = '''"""Steps for every sentence that the catalog knows."""

from robbdd_tools.agent.steps import register

register()
'''
_BEHAVE = f"""[behave]
paths = {FEATURES}
"""


@dataclass(frozen=True, slots=True)
class RunRequest:
    """The input of a run.

    - ``scenarios`` selects scenarios within a variant.
    - ``executions`` selects among the executions of the model; ``None`` selects all.
    - ``repeat`` is the number of repetitions of each scenario; ``None`` takes the number from the execution, or 1.
    - ``only`` filters the scenarios that the other fields select.
    - ``faults``: faults of the robots. If there are any, each scenario is executed once with each fault.
    - ``completed``: a function that is called with each execution, and returns it with additional clauses to measure.

    The remaining fields are the model, its name in reports, the seed, and the variants to run (``None`` for all). If
    the model has executions, they define the run: each one executes the scenarios of its variant, and may set its own
    seed.
    """

    model: AcceptanceModel
    name: str
    seed: int = DEFAULT_SEED
    variants: Collection[Iri] | None = None
    scenarios: Callable[[Variant], Iterable[Numbered]] = every_scenario
    executions: tuple[Execution, ...] | None = None
    repeat: int | None = None
    is_wanted: Callable[[ScenarioSpec], bool] | None = None
    faults: tuple[RobotFault, ...] = ()
    completed: Callable[[ScenarioSpec], ScenarioSpec] | None = None

    def wants(self, variant: Iri) -> bool:
        """Return whether a variant is to be run."""
        return self.variants is None or variant in self.variants

    def stories(self) -> tuple[Story, ...]:
        """Return the stories with a variant to run; each returned story has only those variants."""
        return _stories(self.model.stories, self.wants)

    def chosen_executions(self) -> tuple[Execution, ...]:
        """Return the selected executions whose variants are to be run."""
        chosen = self.model.executions if self.executions is None else self.executions
        return tuple(execution for execution in chosen if self.wants(execution.variant))


def prepare(request: RunRequest, folder: Path) -> Manifest:
    """Write everything that the agent needs into ``folder``, which is created if it is missing. Raises ``OSError``."""
    return prepare_all([request], request.name, request.seed, folder)


def prepare_all(requests: Sequence[RunRequest], name: str, seed: int, folder: Path, traces: bool = False) -> Manifest:
    """Write everything that the agent needs to run several models as one run. Raises ``OSError``.

    ``name`` is the name of that run in reports.
    """
    sources: dict[str, str] = {}
    for stale in (folder / FEATURES / "steps").glob(OWN_STEPS):
        stale.unlink()
    for number, request in enumerate(requests, start=1):
        steps = f"model_{number}_steps.py" if len(requests) > 1 else MODEL_STEPS
        sources |= copy_steps(request.name, folder, steps)
    head = Manifest(name, seed, (), traces, sources)
    return replace(head, scenarios=tuple(_written(list(_parts_of(requests)), head, folder)))


def specs_of(requests: Sequence[RunRequest]) -> Iterator[ScenarioSpec]:
    """Yield the scenarios as ``prepare_all`` specifies them, but without writing files. They name no feature."""
    return (spec for part in _parts_of(requests) for spec in part.unwritten_specs())


def _parts_of(requests: Sequence[RunRequest]) -> Iterator[_Part]:
    for number, request in enumerate(requests, start=1):
        below = FEATURES if len(requests) == 1 else f"{FEATURES}/{number}-{Path(request.name).stem}"
        plan = replace(whole_plan(request.model), stories=request.stories(), scenarios=request.scenarios)
        executions = request.chosen_executions()
        parts = _parts(plan, request.name, request.seed, executions, below, request.repeat, request.is_wanted)
        yield from (replace(part, faults=request.faults, completed=request.completed) for part in parts)


def copy_steps(model: str, folder: Path, name: str = MODEL_STEPS) -> dict[str, str]:
    """Copy the user-written steps of a model into ``folder``; do nothing if it has none. Raises ``OSError``.

    ``model`` is a path or a URI. The result maps the path of the copy in the folder to the path of the original.
    """
    path = uri_to_path(model) if model.startswith("file:") else Path(model)
    own = None if path is None else steps_file(path)
    if own is None or not os.path.lexists(own):
        return {}
    steps = folder / FEATURES / "steps"
    steps.mkdir(parents=True, exist_ok=True)
    replace_file(steps / name, load_bytes(own))
    return {f"{FEATURES}/steps/{name}": str(own.resolve())}


def lay_out(
    plan: FeaturePlan, name: str, seed: int, folder: Path, executions: tuple[Execution, ...] = ()
) -> Iterator[ScenarioSpec]:
    """Write features, hooks, steps and manifest into ``folder``, and yield each scenario.

    The folder is created if it is missing. ``name`` is the name of the model in reports. Each execution in
    ``executions`` gets its own folder of features, and none is repeated. Raises ``OSError`` and ``TemplateProblem``.
    """
    return _written(list(_parts(plan, name, seed, executions, FEATURES, 1)), Manifest(name, seed, ()), folder)


def _written(parts: Sequence[_Part], head: Manifest, folder: Path) -> Iterator[ScenarioSpec]:
    features = folder / FEATURES
    (features / "steps").mkdir(parents=True, exist_ok=True)
    replace_file(features / "environment.py", _ENVIRONMENT)
    replace_file(features / "steps" / "catalog_steps.py", _STEPS)
    specs = (spec for part in parts for spec in part.specs(folder))
    yield from written_manifest(folder, head, specs)


@dataclass(frozen=True, slots=True)
class _Part:
    """Scenarios that are executed in the same way, and the folder for their features in the run folder."""

    plan: FeaturePlan
    writer: SpecWriter
    folder: str
    repeat: int
    is_wanted: Callable[[ScenarioSpec], bool] | None
    faults: tuple[RobotFault, ...] = ()
    completed: Callable[[ScenarioSpec], ScenarioSpec] | None = None

    def specs(self, folder: Path) -> Iterator[ScenarioSpec]:
        """Write the features of this part into the run folder ``folder`` and yield the scenarios to execute."""
        for written in written_scenarios(self.plan, folder / self.folder):
            feature = f"{self.folder}/{written.file.name}"
            yield from self._chosen(feature, written.story, written.scenario)

    def unwritten_specs(self) -> Iterator[ScenarioSpec]:
        """Yield the scenarios to execute. No features are written, so the scenarios name none."""
        plan = self.plan
        for story in plan.stories:
            for piece in feature_pieces(plan.model, story, plan.scenarios, plan.sheet, expanded=plan.expanded):
                if piece.scenario is not None:
                    yield from self._chosen("", story, piece.scenario)

    def _chosen(self, feature: str, story: Story, scenario: ScenarioText) -> Iterator[ScenarioSpec]:
        specs = self.writer.specs(feature, story.iri, scenario, self.repeat)
        wanted = (spec for spec in specs if self.is_wanted is None or self.is_wanted(spec))
        if self.completed is not None:
            wanted = map(self.completed, wanted)
        if not self.faults:
            return wanted
        return (_with_fault(spec, fault) for spec in wanted for fault in self.faults)


def _with_fault(spec: ScenarioSpec, fault: RobotFault) -> ScenarioSpec:
    """Return an execution with a fault of the robots. It shares no behaviour tree's execution with other faults."""
    tree = None if spec.tree is None else replace(spec.tree, name=f"{spec.tree.name} [{fault}]")
    return replace(spec, name=f"{spec.name} [{fault}]", fault=fault, tree=tree)


def _parts(
    plan: FeaturePlan,
    model: str,
    seed: int,
    executions: tuple[Execution, ...],
    folder: str,
    repeat: int | None,
    chosen: Callable[[ScenarioSpec], bool] | None = None,
) -> Iterator[_Part]:
    relations = Relations(plan.model)
    if not executions:
        yield _Part(plan, SpecWriter(plan.model, seed, relations, name=model), folder, repeat or 1, chosen)
    names: set[str] = {"steps"}
    for execution in executions:
        own = replace(plan, stories=_stories(plan.stories, lambda iri, execution=execution: iri == execution.variant))
        stem = plan.model.curie(execution.iri).rpartition(":")[2]
        name = next(name for n in range(len(executions) + 2) if (name := f"{stem}-{n}" if n else stem) not in names)
        names.add(name)
        own_seed = seed if execution.seed is None else execution.seed
        writer = SpecWriter(plan.model, own_seed, relations, execution, model)
        yield _Part(own, writer, f"{folder}/{name}", repeat or execution.repeat, chosen)


def _stories(stories: Iterable[Story], wanted: Callable[[Iri], bool]) -> tuple[Story, ...]:
    """Return the stories with a wanted variant; each returned story has only its wanted variants."""
    chosen = (only(story, wanted) for story in stories)
    return tuple(story for story in chosen if story.variants)


def write_surroundings(folder: Path, model_name: str, json_ld: str) -> None:
    """Add files for plain behave and for graph readers: ``behave.ini`` and the model as JSON-LD. Raises ``OSError``."""
    folder.mkdir(parents=True, exist_ok=True)
    replace_file(folder / "behave.ini", _BEHAVE)
    replace_file(folder / f"{model_name}.jsonld", json_ld)
