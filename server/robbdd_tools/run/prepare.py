"""Lays a run out in a folder: features, hooks and steps for behave, the manifest, the graph as JSON-LD."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import asdict, dataclass, fields, replace
from functools import cache
from pathlib import Path
from typing import Any

from robbdd_tools.gherkin.feature import Numbered, every_scenario
from robbdd_tools.gherkin.files import FeaturePlan, only, whole_plan, written_scenarios
from robbdd_tools.graph.model import AcceptanceModel, Execution, Iri, Story, Variant
from robbdd_tools.run.protocol import MANIFEST, ExecutionSpec, Manifest, ScenarioSpec
from robbdd_tools.run.specs import SpecWriter

DEFAULT_SEED = 1
FEATURES = "features"
_ENVIRONMENT = '''"""Hooks that hold the simulated world while behave goes through the scenarios."""

from robbdd_tools.agent.hooks import after_all, after_scenario, before_all, before_scenario

__all__ = ["after_all", "after_scenario", "before_all", "before_scenario"]
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
    """What to run: a model, the name it goes by in reports, the seed, and the variants (all when ``None``).

    ``scenarios`` selects among those of a variant. A model with executions is run as they say, each of them the
    scenarios of its variant, with a seed of its own where it has one; ``executions`` are those to run (all when
    ``None``).
    """

    model: AcceptanceModel
    name: str
    seed: int = DEFAULT_SEED
    variants: Collection[Iri] | None = None
    scenarios: Callable[[Variant], Iterable[Numbered]] = every_scenario
    executions: tuple[Execution, ...] | None = None

    def wants(self, variant: Iri) -> bool:
        """Tell whether a variant is to be run."""
        return self.variants is None or variant in self.variants

    def stories(self) -> tuple[Story, ...]:
        """Return the stories with a variant to be run, with those variants."""
        return _stories(self.model.stories, self.wants)

    def chosen_executions(self) -> tuple[Execution, ...]:
        """Return the executions to be run, of the variants to be run."""
        chosen = self.model.executions if self.executions is None else self.executions
        return tuple(execution for execution in chosen if self.wants(execution.variant))


def prepare(request: RunRequest, folder: Path) -> Manifest:
    """Write everything that the agent needs into ``folder`` (made if missing); raises ``OSError``."""
    plan = replace(whole_plan(request.model), stories=request.stories(), scenarios=request.scenarios)
    specs = tuple(lay_out(plan, request.name, request.seed, folder, request.chosen_executions()))
    return Manifest(request.name, request.seed, specs)


def lay_out(
    plan: FeaturePlan, name: str, seed: int, folder: Path, executions: tuple[Execution, ...] = ()
) -> Iterator[ScenarioSpec]:
    """Write features, hooks, steps and manifest into ``folder`` (made if missing), scenario by scenario.

    ``name`` is that of the model in reports. Each of the ``executions`` has a folder of features of its own.
    Raises ``OSError`` and ``TemplateProblem``.
    """
    features = folder / FEATURES
    (features / "steps").mkdir(parents=True, exist_ok=True)
    (features / "environment.py").write_text(_ENVIRONMENT, encoding="utf-8", newline="\n")
    (features / "steps" / "catalog_steps.py").write_text(_STEPS, encoding="utf-8", newline="\n")
    parts = list(_parts(plan, seed, executions))
    with (folder / MANIFEST).open("w", encoding="utf-8", newline="\n") as manifest:
        known = [asdict(part.writer.execution) for part in parts if part.writer.execution is not None]
        head = {"model": name, "seed": seed, "executions": known}
        manifest.write(json.dumps(head, ensure_ascii=False)[:-1] + ', "scenarios": [')
        separator = "\n"
        for part in parts:
            for written in written_scenarios(part.plan, folder / part.folder):
                feature = f"{part.folder}/{written.file.name}"
                spec = part.writer.spec(feature, written.story.iri, written.scenario)
                manifest.write(separator + json.dumps(spec, default=_fields, ensure_ascii=False))
                separator = ",\n"
                yield spec
        manifest.write("\n]}\n")


@dataclass(frozen=True, slots=True)
class _Part:
    """Scenarios that are executed in one way, with the folder of their features in that of the run."""

    plan: FeaturePlan
    writer: SpecWriter
    folder: str


def _parts(plan: FeaturePlan, seed: int, executions: tuple[Execution, ...]) -> Iterator[_Part]:
    if not executions:
        yield _Part(plan, SpecWriter(plan.model, seed), FEATURES)
    names: set[str] = {"steps"}
    for execution in executions:
        own = replace(plan, stories=_stories(plan.stories, lambda iri, execution=execution: iri == execution.variant))
        stem = plan.model.curie(execution.iri).rpartition(":")[2]
        name = next(name for n in range(len(executions) + 2) if (name := f"{stem}-{n}" if n else stem) not in names)
        names.add(name)
        own_seed = seed if execution.seed is None else execution.seed
        yield _Part(own, SpecWriter(plan.model, own_seed, execution), f"{FEATURES}/{name}")


def _stories(stories: Iterable[Story], wanted: Callable[[Iri], bool]) -> tuple[Story, ...]:
    """Return the stories with a wanted variant, with these variants only."""
    chosen = (only(story, wanted) for story in stories)
    return tuple(story for story in chosen if story.variants)


def write_surroundings(folder: Path, model_name: str, json_ld: str) -> None:
    """Add what plain behave and readers of graphs want: ``behave.ini`` and the model as JSON-LD. Raises ``OSError``."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "behave.ini").write_text(_BEHAVE, encoding="utf-8", newline="\n")
    (folder / f"{model_name}.jsonld").write_text(json_ld, encoding="utf-8", newline="\n")


def _fields(value: Any) -> object:
    """Return the fields of a dataclass, for JSON; unlike ``asdict`` it copies nothing. Executions are named."""
    if isinstance(value, ExecutionSpec):
        return value.iri
    return {name: getattr(value, name) for name in _names(value.__class__)}


@cache
def _names(kind: type[Any]) -> tuple[str, ...]:
    return tuple(entry.name for entry in fields(kind))
