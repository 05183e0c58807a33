"""What a run of a model, or of all models in a folder, is to execute."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.files import path_to_uri
from robbdd_tools.commands.models import model_files, sound_model
from robbdd_tools.commands.output import print_note
from robbdd_tools.commands.selection import describe

if TYPE_CHECKING:
    from robbdd_tools.gherkin.select import Selected, Wanted
    from robbdd_tools.graph.model import AcceptanceModel, Execution, Iri
    from robbdd_tools.run.prepare import RunRequest
    from robbdd_tools.run.protocol import ScenarioSpec


@dataclass(frozen=True, slots=True)
class Choice:
    """What is to be executed of models: executions and variants of some names, of these the wanted scenarios.

    ``seed`` goes before those of executions, ``repeat`` before their number of repetitions; ``only`` is the last word.
    """

    wanted: Wanted
    names: Sequence[str] = ()
    seed: int | None = None
    repeat: int | None = None
    only: Callable[[ScenarioSpec], bool] | None = None


@dataclass(frozen=True, slots=True)
class Loaded:
    """A model that is free of errors, with a digest of its graph."""

    path: Path
    model: AcceptanceModel
    digest: str


def load_models(path: Path) -> list[Loaded] | None:
    """Load a model, or all in a folder; prints what is wrong, and returns ``None``, when there is nothing to run."""
    files = model_files([path]) if path.is_dir() else [path]
    # An execution says more than the model that it executes, which then need not be run by itself.
    files.sort(key=lambda file: file.suffix != ".bddx")
    loaded = [_load(file) for file in files]
    if any(one is None for one in loaded):
        return None
    found = [one for one in loaded if one is not None and any(story.variants for story in one.model.stories)]
    if not found:
        place = f"robbdd: {path}: " if path.is_dir() else f"{path}:1:1: error: "
        code = "" if path.is_dir() else " [no-scenario]"
        print_note(f"{place}the model has no scenario to run{code}")
        return None
    return found


def digest(models: Sequence[Loaded]) -> str:
    """Return a digest of the graphs of models together."""
    from robbdd_tools.graph.digest import joint_digest

    return joint_digest(one.digest for one in models)


def requests(models: Sequence[Loaded], choice: Choice) -> list[RunRequest] | str:
    """Return what to run of some models; a sentence when that is not possible.

    Each execution, and each variant that has none, is run once, whichever of the models name it.
    """
    from robbdd_tools.gherkin.select import Selected, SelectionError
    from robbdd_tools.run.prepare import RunRequest

    problems: list[str] = []
    found: list[RunRequest] = []
    seen: set[Iri] = set()
    unknown = _unknown_names(models, choice.names)
    if unknown:
        return unknown
    for one in models:
        variants, executions = _chosen(one.model, choice.names)
        if one.model.executions:
            executions = tuple(execution for execution in executions if execution.iri not in seen)
            fresh = [variant for variant in variants if any(e.variant == variant.iri for e in executions)]
        else:
            fresh = [variant for variant in variants if variant.iri not in seen]
        seen.update((*(variant.iri for variant in fresh), *(execution.iri for execution in executions)))
        if not fresh:
            continue
        try:
            selected: Selected = Selected(one.model, fresh, choice.wanted)
        except SelectionError as error:
            problems.append(str(error))
            continue
        if selected.is_empty():
            problems.append("no scenario fits the selection")
            continue
        describe(one.model, selected)
        if choice.seed is not None:
            executions = tuple(replace(execution, seed=None) for execution in executions)
        found.append(
            RunRequest(
                one.model,
                str(one.path),
                choice.wanted.seed,
                frozenset(variant.iri for variant in fresh),
                selected.scenarios,
                executions,
                choice.repeat,
                choice.only,
            )
        )
    return found or problems[0]


def _load(path: Path) -> Loaded | None:
    from robbdd_tools.graph.build import build_graph
    from robbdd_tools.graph.digest import graph_digest
    from robbdd_tools.graph.places import placed_model

    snapshot = sound_model(path)
    if snapshot is None:
        return None
    built = build_graph(snapshot, path_to_uri(path))
    return Loaded(path, placed_model(built, snapshot), graph_digest(built))


def _unknown_names(models: Sequence[Loaded], names: Sequence[str]) -> str:
    known: set[str] = set()
    for one in models:
        variants, executions = _chosen(one.model, ())
        known |= {_name(one.model, thing.iri) for thing in (*variants, *executions)}
    missing = [name for name in names if name not in known]
    return f"there is no scenario '{missing[0]}'; the model has {', '.join(sorted(known))}" if missing else ""


def _chosen(model: AcceptanceModel, names: Sequence[str]) -> tuple[list[Any], tuple[Execution, ...]]:
    """Return the variants and executions of some names, all without any.

    A model with executions has those variants only that these execute.
    """
    executions = model.executions
    variants = [variant for story in model.stories for variant in story.variants]
    if executions:
        variants = [one for one in variants if any(execution.variant == one.iri for execution in executions)]
    if names:
        wanted = set(names)
        executions = tuple(e for e in executions if {_name(model, e.iri), _name(model, e.variant)} & wanted)
        if model.executions:
            variants = [one for one in variants if any(execution.variant == one.iri for execution in executions)]
        else:
            variants = [one for one in variants if _name(model, one.iri) in wanted]
    return variants, executions


def _name(model: AcceptanceModel, iri: Iri) -> str:
    return model.curie(iri).rsplit(":", 1)[-1]
