"""Lays a run out in a folder: features, hooks and steps for behave, the manifest, the graph as JSON-LD."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass, fields, replace
from functools import cache
from pathlib import Path
from typing import Any

from robbdd_tools.gherkin.feature import Numbered, every_scenario
from robbdd_tools.gherkin.files import FeaturePlan, only, whole_plan, written_scenarios
from robbdd_tools.graph.model import AcceptanceModel, Iri, Story, Variant
from robbdd_tools.run.protocol import MANIFEST, Manifest, ScenarioSpec
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

    ``scenarios`` selects among those of a variant.
    """

    model: AcceptanceModel
    name: str
    seed: int = DEFAULT_SEED
    variants: Collection[Iri] | None = None
    scenarios: Callable[[Variant], Iterable[Numbered]] = every_scenario

    def wants(self, variant: Iri) -> bool:
        """Tell whether a variant is to be run."""
        return self.variants is None or variant in self.variants

    def stories(self) -> tuple[Story, ...]:
        """Return the stories with a variant to be run, with those variants."""
        stories = (only(story, self.wants) for story in self.model.stories)
        return tuple(story for story in stories if story.variants)


def prepare(request: RunRequest, folder: Path) -> Manifest:
    """Write everything that the agent needs into ``folder`` (made if missing); raises ``OSError``."""
    plan = replace(whole_plan(request.model), stories=request.stories(), scenarios=request.scenarios)
    specs = tuple(lay_out(plan, request.name, request.seed, folder))
    return Manifest(request.name, request.seed, specs)


def lay_out(plan: FeaturePlan, name: str, seed: int, folder: Path) -> Iterator[ScenarioSpec]:
    """Write features, hooks, steps and manifest into ``folder`` (made if missing), scenario by scenario.

    ``name`` is that of the model in reports. Raises ``OSError`` and ``TemplateProblem``.
    """
    features = folder / FEATURES
    (features / "steps").mkdir(parents=True, exist_ok=True)
    (features / "environment.py").write_text(_ENVIRONMENT, encoding="utf-8", newline="\n")
    (features / "steps" / "catalog_steps.py").write_text(_STEPS, encoding="utf-8", newline="\n")
    writer = SpecWriter(plan.model, seed)
    with (folder / MANIFEST).open("w", encoding="utf-8", newline="\n") as manifest:
        manifest.write(f'{{"model": {json.dumps(name, ensure_ascii=False)}, "seed": {seed}, "scenarios": [')
        separator = "\n"
        for written in written_scenarios(plan, features):
            spec = writer.spec(f"{FEATURES}/{written.file.name}", written.story.iri, written.scenario)
            manifest.write(separator + json.dumps(spec, default=_fields, ensure_ascii=False))
            separator = ",\n"
            yield spec
        manifest.write("\n]}\n")


def write_surroundings(folder: Path, model_name: str, json_ld: str) -> None:
    """Add what plain behave and readers of graphs want: ``behave.ini`` and the model as JSON-LD. Raises ``OSError``."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "behave.ini").write_text(_BEHAVE, encoding="utf-8", newline="\n")
    (folder / f"{model_name}.jsonld").write_text(json_ld, encoding="utf-8", newline="\n")


def _fields(value: Any) -> dict[str, object]:
    """Return the fields of a dataclass, for JSON; unlike ``asdict`` it copies nothing."""
    return {name: getattr(value, name) for name in _names(value.__class__)}


@cache
def _names(kind: type[Any]) -> tuple[str, ...]:
    return tuple(entry.name for entry in fields(kind))
