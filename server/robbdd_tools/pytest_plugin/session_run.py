"""The single stored run of a pytest session: which process creates it, executes its scenarios and ends it.

Without pytest-xdist, one process does everything. With pytest-xdist, the controller creates the folder and ends the
run, and the workers execute scenarios. The first worker with a scenario prepares the folder, and each worker records
its own executions.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.locks import acquire
from robbdd_tools.workbench.folder import RunFolder, new_folder
from robbdd_tools.workbench.on_demand import Executed, OnDemand, end_run
from robbdd_tools.workbench.plan import Plan

if TYPE_CHECKING:
    from robbdd_tools.protocol.specs import ScenarioSpec
    from robbdd_tools.pytest_plugin.plugin_options import Options
    from robbdd_tools.run.results import RunResults
    from robbdd_tools.run.store import StoredRun
    from robbdd_tools.workbench.folder import Keeping
    from robbdd_tools.workbench.model import ModelFile

ENDED = "pytest ended before it was executed"
PATIENCE = 120.0
"""Seconds that a worker waits while another one prepares the run."""

Key = tuple[str, str, str, int, int]
"""Key of an execution: path of the model, variant, execution (IRIs), variation, repetition."""


def key_of(spec: ScenarioSpec) -> Key:
    """Return the key of an execution in the session."""
    execution = "" if spec.execution is None else spec.execution.iri
    return spec.model, spec.variant, execution, spec.variation, spec.repetition


class Owner:
    """Creates the folder of the session's run at its first use, and ends the run."""

    def __init__(self, keeping: Keeping) -> None:
        self._keeping = keeping
        self._folder: RunFolder | None = None

    @property
    def remark(self) -> str:
        """A note about the store for the user; empty without a run."""
        return "" if self._folder is None else self._folder.remark

    def open(self, model: Path) -> StoredRun:
        """Return the run folder. The default store is that of the project with ``model``. Raises ``OSError``."""
        if self._folder is None:
            self._folder = new_folder(model, self._keeping)
        return self._folder.place

    def end(self) -> tuple[StoredRun, RunResults] | None:
        """End the run and return it with its results; return ``None`` if no scenario was to be executed.

        Scenarios that were not executed are unknown. Raises ``OSError``.
        """
        if self._folder is None:
            return None
        place = self._folder.place
        try:
            if not place.began:
                place.discard()
                return None
            return place, end_run(place, ENDED)
        finally:
            self._folder.remove()
            self._folder = None


class Executor:
    """Executes scenarios in this process.

    - ``specs``: the scenarios, from the models ``files``.
    - ``open_place``: returns the run folder.
    - ``lock``: a lock file, so that only one of several processes prepares the folder at a time.
    - ``processes``: the number of processes.
    - ``first_agent``: the number of the first agent of this process.
    """

    def __init__(
        self,
        options: Options,
        specs: Iterable[ScenarioSpec],
        files: tuple[ModelFile, ...],
        open_place: Callable[[], StoredRun],
        lock: Path | None = None,
        first_agent: int = 1,
        processes: int = 1,
    ) -> None:
        self._options = options
        self._wanted = {key_of(spec) for spec in specs}
        self._files = files
        self._open_place = open_place
        self._lock = lock
        self._first_agent = first_agent
        self._processes = processes
        self._on_demand: OnDemand | None = None
        self._problem: Exception | None = None

    @property
    def place(self) -> StoredRun:
        """The folder of the run."""
        return self._open_place()

    def execute(self, spec: ScenarioSpec) -> Executed:
        """Execute one of the scenarios. Raises ``RobbddError`` and ``OSError`` if nothing can be executed."""
        if self._problem is not None:
            raise self._problem
        try:
            on_demand = self._on_demand = self._on_demand or self._begin()
        except (RobbddError, OSError) as error:
            self._problem = error
            raise
        wanted = key_of(spec)
        index = next(n for n, one in enumerate(on_demand.manifest.scenarios) if key_of(one) == wanted)
        return on_demand.execute(index)

    def close(self) -> None:
        """End the agent."""
        if self._on_demand is not None:
            self._on_demand.close()
            self._on_demand = None

    def _begin(self) -> OnDemand:
        place = self._open_place()
        lock = None if self._lock is None else acquire(self._lock, PATIENCE)
        try:
            if lock is None and self._lock is not None:
                raise RobbddError(f"another process has been preparing {place.folder} for {PATIENCE:g} s")
            # The process that created the folder ends the run and then releases its lock.
            return self._join(replace(place, lock=None)) if place.began else self._prepare(replace(place, lock=None))
        finally:
            if lock is not None:
                lock.release()

    def _join(self, place: StoredRun) -> OnDemand:
        return OnDemand.join(place, timeout=self._options.timeout, first_agent=self._first_agent)

    def _prepare(self, place: StoredRun) -> OnDemand:
        plan = session_plan(self._files, self._options, lambda spec: key_of(spec) in self._wanted)
        return OnDemand.begin(
            plan,
            place,
            repeat=self._options.repeat,
            timeout=self._options.timeout,
            models=[Path(file.name) for file in plan.files] if len(plan.files) > 1 else (),
            first_agent=self._first_agent,
            processes=self._processes,
        )


def session_plan(
    files: tuple[ModelFile, ...], options: Options, only: Callable[[ScenarioSpec], bool] | None = None
) -> Plan:
    """Return the plan of models. Several models are named after their common folder. Raises ``SelectionError``."""
    path = Path(files[0].name if len(files) == 1 else os.path.commonpath([file.name for file in files]))
    return Plan.of_files(str(path), path, files, replace(options.selection, is_wanted=only))


def model_files(files: Iterable[ModelFile]) -> tuple[ModelFile, ...]:
    """Return the models without duplicates. Models with executions are first, as in a run of a folder."""
    found = {file.uri: file for file in files}
    return tuple(sorted(found.values(), key=lambda file: not file.uri.endswith(".bddx")))
