"""Select the scenarios that failed in a stored run, so that another run executes them again."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.prepare import DEFAULT_SEED
from robbdd_tools.run.store import NoSuchRun, RunStore, StoredRun, shown_path
from robbdd_tools.run.stored_results import RUNNING
from robbdd_tools.workbench.choice import Choice, Listed
from robbdd_tools.workbench.scene_choice import files_of
from robbdd_tools.workbench.substitution import substitutions_of


class NothingFailed(RobbddError):
    """There is nothing to execute again, because every scenario of the last run holds."""


@dataclass(frozen=True, slots=True)
class Failed:
    """The executions that did not hold, and the options with which to execute them again.

    - ``seed``: the seed that the user gave; ``None`` if the user gave none.
    - ``repeat``: the number of repetitions; ``None`` for the number that the model states.
    - ``default_seed``: the seed of scenarios that have no seed of their own.
    - ``substitutions``: the substitutions of the run.
    - ``scenex``: the files of the scene instances that the user chose.
    - ``world``: the world that the user chose; empty for physics.
    """

    choice: Choice
    seed: int | None
    repeat: int | None
    default_seed: int = DEFAULT_SEED
    substitutions: Mapping[str, str] = field(default_factory=dict[str, str])
    scenex: tuple[Path, ...] = ()
    world: str = ""


def last_run(store: RunStore, model: Path) -> StoredRun:
    """Return the last stored run of a model that has ended. Raises ``NoSuchRun``."""
    for place in reversed(store.runs()):
        with suppress(NoSuchRun):
            if place.record().path == shown_path(model) and place.status().state != RUNNING:
                return place
    raise NoSuchRun(f"there is no stored run of {model} in {store.folder}")


def failed_in(place: StoredRun) -> Failed:
    """Return the executions of a run that did not hold. Raises ``NothingFailed`` and ``NoSuchRun``."""
    results, specs = place.results(), place.manifest().scenarios
    entries = zip(specs, results["scenarios"], strict=False)
    failed = [spec for spec, entry in entries if entry["verdict"] != Outcome.HOLDS]
    if not failed:
        raise NothingFailed("nothing failed in the last run")
    listed = [
        Listed(
            spec.variant,
            frozenset({spec.variation}),
            None if spec.execution is None else spec.execution.iri,
            frozenset({spec.repetition}),
        )
        for spec in failed
    ]
    repeated = max(spec.repetition for spec in specs)
    repeat = repeated if repeated > 1 else None
    seed, substitutions = place.record().user_seed, substitutions_of(specs)
    return Failed(Choice(listed), seed, repeat, results["seed"], substitutions, files_of(failed), failed[0].world)
