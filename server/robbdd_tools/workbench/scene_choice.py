"""Run scenarios in the scene instances of a ``.scenex`` that the user names (``--scenex``).

An execution of a ``.bddx`` names its scene instance and keeps it. A scenario without an execution runs in the scene
instance of the named files that instantiates its scene.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.exceptions import RobbddError

if TYPE_CHECKING:
    from robbdd_tools.catalog.executable import SceneInstance
    from robbdd_tools.graph.acceptance_model import AcceptanceModel, Iri, Variant
    from robbdd_tools.protocol.specs import ScenarioSpec
    from robbdd_tools.run.prepare import RunRequest

NOTHING_TO_PLACE = (
    "every selected scenario runs in the scene instance of its execution; run the .bdd file to use another"
)


class SceneChoiceError(RobbddError):
    """The named scene instances do not fit the scenarios; the message gives the user the reason."""


def in_instances(
    model: AcceptanceModel, variants: Collection[Iri], instances: Sequence[SceneInstance], *, must_fit: bool
) -> AcceptanceModel:
    """Return a model whose variants have the scene instance that instantiates their scene.

    Raises ``SceneChoiceError`` if several instances fit one of ``variants``, and with ``must_fit`` also if none does.
    """
    if not instances:
        return model

    def placed(variant: Variant) -> Variant:
        fitting = [one for one in instances if one.scene in variant.scenes]
        if variant.iri in variants and (len(fitting) > 1 or (must_fit and not fitting)):
            raise SceneChoiceError(_misfit(model, variant, fitting, instances))
        return replace(variant, instance=fitting[0]) if len(fitting) == 1 else variant

    stories = (replace(story, variants=tuple(map(placed, story.variants))) for story in model.stories)
    return replace(model, stories=tuple(stories))


def refuse_unused(models: Iterable[AcceptanceModel], instances: Sequence[SceneInstance]) -> None:
    """Raise ``SceneChoiceError`` if no scenario of any model runs in a scene that the instances instantiate."""
    variants = [variant for model in models for story in model.stories for variant in story.variants]
    if instances and not any(one.scene in variant.scenes for one in instances for variant in variants):
        raise SceneChoiceError(f"no scenario runs in a scene that is instantiated: there is {_listed(instances)}")


def uses_instances(request: RunRequest) -> bool:
    """Return whether some selected scenario runs in one of the chosen scene instances."""
    model = request.model
    placed = {one.iri for story in model.stories for one in story.variants if one.instance and request.wants(one.iri)}
    own = {one.variant for one in request.chosen_executions() if one.scene is not None}
    return not placed <= own


def files_of(scenarios: Iterable[ScenarioSpec]) -> tuple[Path, ...]:
    """Return the ``.scenex`` files of the scene instances that a run chose."""
    chosen = (spec.chosen_scene for spec in scenarios)
    return tuple(dict.fromkeys(Path(one.file) for one in chosen if one is not None))


def instances_of(scenarios: Iterable[ScenarioSpec]) -> tuple[SceneInstance, ...]:
    """Return the scene instances that a run chose, with their text at the time of the run."""
    chosen: Mapping[str, SceneInstance] = {
        spec.chosen_instance.iri: spec.chosen_instance for spec in scenarios if spec.chosen_instance is not None
    }
    return tuple(chosen.values())


def _misfit(
    model: AcceptanceModel, variant: Variant, fitting: Sequence[SceneInstance], instances: Sequence[SceneInstance]
) -> str:
    name = _local(variant.iri)
    if fitting:
        return (
            f"several scene instances fit {name}: {', '.join(map(_named, fitting))}; "
            "name one of them in an execution of a .bddx, or keep one"
        )
    if not variant.scenes:
        return f"the graph of {name} does not name its scene, so no scene instance fits it"
    scenes = " and ".join(map(model.curie, variant.scenes))
    return f"{name} runs in the scene {scenes}, which is not instantiated: there is {_listed(instances)}"


def _listed(instances: Iterable[SceneInstance]) -> str:
    return ", ".join(f"{_named(one)} of the scene {_local(one.scene)}" for one in instances)


def _named(instance: SceneInstance) -> str:
    name = _local(instance.iri)
    return name if instance.origin is None else f"{name} ({instance.origin})"


def _local(iri: str) -> str:
    return iri.replace("#", "/").rpartition("/")[2]
