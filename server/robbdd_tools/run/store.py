"""Keeps runs in numbered folders beside the models: ``.robbdd/runs/<n>/``.

A stored run is the run's own folder (features, manifest, logs, moments, traces) with the results and ``run.json``,
which says what was run. Nothing in it depends on the wall clock.
"""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, cast

from robbdd_tools.base.files import full_path, load_text
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.base.printable import printable_json
from robbdd_tools.base.writing import replace_file
from robbdd_tools.run.manifest import read_manifest
from robbdd_tools.run.protocol import Manifest

MARKS = ("pyproject.toml", "robbdd.toml", ".git")
"""What the root of a project has one of."""
FOLDER = Path(".robbdd") / "runs"
RESULTS = "results.json"
RECORD = "run.json"
KEPT = 20
"""Runs that a store holds; a new one replaces the oldest."""
LATEST = "latest"


class NoSuchRun(Exception):
    """There is no such run, or it cannot be read; the message says which there are, or why."""


@dataclass(frozen=True, slots=True)
class RunRecord:
    """What was run: the model, and a digest of its graph.

    ``path`` is the model's relative to the project's root, ``origin`` relative to the run's folder; ``version`` is that
    of this package, ``simulator`` that of the engine. ``files`` are digests of the other files that were used, by
    their paths relative to the run's folder.
    """

    path: str
    origin: str
    digest: str
    seed: int
    version: str
    simulator: str = ""
    files: Mapping[str, str] = field(default_factory=dict[str, str])


@dataclass(frozen=True, slots=True)
class StoredRun:
    """A run's folder; ``number`` is its place in its store, 0 for a folder elsewhere; ``kept`` when it stays."""

    number: int
    folder: Path
    kept: bool = True

    def record(self) -> RunRecord:
        """Return what was run; raises ``NoSuchRun``."""
        fields = self._json(RECORD)
        try:
            return RunRecord(**fields)
        except TypeError:
            raise NoSuchRun(f"{self.folder / RECORD} is not the record of a run") from None

    def results(self) -> Mapping[str, Any]:
        """Return the document of ``docs/schemas/run.schema.json``; raises ``NoSuchRun``."""
        return self._json(RESULTS)

    def manifest(self) -> Manifest:
        """Return what the agent was told; raises ``NoSuchRun``."""
        try:
            return read_manifest(self.folder)
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise NoSuchRun(f"{self.folder} holds no run: {error}") from error

    def model(self) -> Path:
        """Return what was run, a file or a folder, which may be gone by now; raises ``NoSuchRun``."""
        return (self.folder / self.record().origin).resolve()

    def write_record(self, record: RunRecord) -> None:
        """Write what is run; raises ``OSError``."""
        _write(self.folder / RECORD, asdict(record))

    def write_results(self, results: Mapping[str, Any]) -> None:
        """Write what came out; raises ``OSError``."""
        _write(self.folder / RESULTS, results)

    def _json(self, name: str) -> dict[str, Any]:
        path = self.folder / name
        try:
            found: object = json.loads(load_text(path, RESULT_SIZE))
        except FileNotFoundError:
            raise NoSuchRun(f"{self.folder} holds no finished run: there is no {name}") from None
        except (OSError, ValueError) as error:
            raise NoSuchRun(f"{path} cannot be read: {error}") from error
        if not isinstance(found, dict):
            raise NoSuchRun(f"{path} is not an object")
        return cast(dict[str, Any], found)


class RunStore:
    """The numbered runs in one folder, which need not exist."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def runs(self) -> list[StoredRun]:
        """Return the runs, the oldest first."""
        try:
            found = [entry for entry in self.folder.iterdir() if entry.name.isdecimal() and entry.is_dir()]
        except OSError:
            return []
        return sorted((StoredRun(int(entry.name), entry) for entry in found), key=lambda run: run.number)

    def begin(self) -> StoredRun:
        """Make the folder of a new run and remove the oldest ones beyond ``KEPT``; raises ``OSError``."""
        self.folder.mkdir(parents=True, exist_ok=True)
        ignore = self.folder / ".gitignore"
        if not ignore.exists():
            replace_file(ignore, "*\n")
        runs = self.runs()
        number = runs[-1].number if runs else 0
        while True:
            number += 1
            run = StoredRun(number, self.folder / str(number))
            try:
                run.folder.mkdir()
            except FileExistsError:
                continue
            for old in self.runs()[:-KEPT]:
                shutil.rmtree(old.folder, ignore_errors=True)
            return run

    def find(self, word: str) -> StoredRun:
        """Return a run by its number, ``latest``, or its folder; raises ``NoSuchRun``."""
        runs = self.runs()
        if word == LATEST and runs:
            return runs[-1]
        found = [run for run in runs if str(run.number) == word]
        if found:
            return found[0]
        if (Path(word) / RECORD).is_file():
            return StoredRun(0, Path(word))
        known = f"it has {', '.join(str(run.number) for run in runs)}" if runs else "it has none"
        raise NoSuchRun(f"there is no run '{word}' in {self.folder}; {known}")


def project_root(path: Path) -> Path:
    """Return the nearest folder above a model that is a project's root, else the model's own folder."""
    here = full_path(path) if path.is_dir() else full_path(path).parent
    return next((folder for folder in (here, *here.parents) if any((folder / mark).exists() for mark in MARKS)), here)


def origin(model: Path, folder: Path) -> str:
    """Return a model's path relative to the folder of its run: both may be moved together."""
    return Path(os.path.relpath(model, folder)).as_posix()


def store_beside(path: Path) -> RunStore:
    """Return the store of a model's project."""
    return RunStore(project_root(path) / FOLDER)


def shown_path(path: Path) -> str:
    """Return a model's path as records have it: relative to its project's root."""
    return full_path(path).relative_to(project_root(path)).as_posix()


def _write(path: Path, document: object) -> None:
    """Write a document as a whole: who reads meanwhile, an editor that follows the runs, gets the old one or this."""
    replace_file(path, printable_json(document, indent=1) + "\n")
