"""Find the results to compare: stored runs, results files of ``robbdd run --json``, and studies."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import UnreadableFile, load_bytes
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.campaign.study_executions import study_executions
from robbdd_tools.campaign.study_source import names_study, stored_study
from robbdd_tools.run.imported import BrokenResults, read_results
from robbdd_tools.run.report import value_word, variable_word
from robbdd_tools.workbench.execution_rows import ExecutionResult, execution_results
from robbdd_tools.workbench.stored import PastRun, find_run

if TYPE_CHECKING:
    from robbdd_tools.run.store import StoredRun


class NotResults(RobbddError):
    """A results file cannot be read."""


@dataclass(frozen=True, slots=True)
class RunSource:
    """The results to compare.

    - ``name``: the source in words. ``place``: the stored run, if the source is one.
    - ``is_study``: whether the source is a study, in which names identify clauses.
    - ``study``: the study's file, if the user named the file.
    - ``facts``: the versions that a study used, and digests of its input, by name.
    """

    name: str
    results: tuple[ExecutionResult, ...]
    place: StoredRun | None = None
    is_study: bool = False
    study: Path | None = None
    facts: Mapping[str, str] = field(default_factory=dict[str, str])


def run_source(word: str, path: Path, store: Path | None = None) -> RunSource:
    """Return the results that ``word`` names.

    ``word`` is a results file (``.json``), a stored run's number or folder, ``latest``, or a study. A study is named by
    its file (``.study``) or by the folder of its results. Levels of factors may follow, which its executions must have
    (``cell.study:robot=panda,range=dense``). ``path`` is in the project; ``store`` is another folder of runs or
    studies. Raises ``NotResults``, ``NoSuchRun``, ``StudyProblem`` and ``DatabaseProblem``.
    """
    named, levels = _levels_of(word)
    if names_study(named):
        return _study(word, named, levels, store)
    file = Path(word)
    if file.suffix == ".json":
        return RunSource(word, _from_file(file))
    return stored_source(find_run(word, path, store=store))


def stored_source(run: PastRun) -> RunSource:
    """Return the results of a stored run. Raises ``NoSuchRun``."""
    name = f"run {run.number}" if run.number else str(run.folder)
    return RunSource(f"{name} ({run.record.path}, seed {run.record.seed})", run.results, run.place)


def _levels_of(word: str) -> tuple[str, Mapping[str, str]]:
    """Split the levels of factors from a study's name. A name stays whole if its colon is not followed by levels."""
    name, colon, text = word.rpartition(":")
    if not colon or not names_study(name):
        return word, {}
    levels: dict[str, str] = {}
    for part in text.split(","):
        factor, equals, level = part.partition("=")
        if not (factor.strip() and equals and level.strip()):
            raise NotResults(f"{word}: write levels as FACTOR=LEVEL, separated by commas, not '{part}'")
        levels[factor.strip()] = level.strip()
    return name, levels


def _study(word: str, named: str, levels: Mapping[str, str], store: Path | None) -> RunSource:
    with stored_study(named, store) as stored:
        executed, facts = study_executions(stored.rows()), stored.facts()
    results = executed
    for factor, level in levels.items():
        results = _with_level(word, results, factor, level)
    total = int(facts.get("total", len(executed)))
    some = f", {len(executed)} of {total} executions" if len(executed) < total else ""
    name, file = f"{word} (study {facts.get('name', '')}{some})", Path(named) if Path(named).is_file() else None
    return RunSource(name, results, is_study=True, study=file, facts=facts)


def _with_level(word: str, results: Iterable[ExecutionResult], factor: str, level: str) -> tuple[ExecutionResult, ...]:
    """Return the executions with a level of a factor. As all of them have this level, their values leave it out."""
    results = tuple(results)
    names = dict.fromkeys(name for result in results for name in result.values)
    wanted = [name for name in names if factor in (name, variable_word(name))]
    if not wanted:
        known = ", ".join(map(variable_word, names))
        raise NotResults(f"{word}: the study has no factor or variable '{factor}'; it has {known}")
    (name, *_) = wanted
    found = tuple(one for one in results if name in one.values and level in _words(one.values[name]))
    if not found:
        known = ", ".join(dict.fromkeys(value_word(one.values[name]) for one in results if name in one.values))
        raise NotResults(f"{word}: no execution has {factor} = '{level}'; its levels are {known}")
    return tuple(replace(one, values={key: value for key, value in one.values.items() if key != name}) for one in found)


def _words(value: object) -> tuple[str, str]:
    return str(value), value_word(value)


def _from_file(path: Path) -> tuple[ExecutionResult, ...]:
    try:
        text = load_bytes(path, RESULT_SIZE).decode("utf-8-sig")
        read_results(text)  # explains what is wrong with a file
        document: Mapping[str, Any] = json.loads(text)
        return execution_results(document)
    except BrokenResults as error:
        raise NotResults(f"{path}:{error.line}:{error.column}: {error}") from error
    except UnicodeDecodeError as error:
        raise NotResults(f"{path}: this is not UTF-8 text") from error
    except UnreadableFile as error:
        raise NotResults(f"{path}: {error}") from error
    except (KeyError, TypeError, ValueError) as error:
        raise NotResults(f"{path}: {error} is missing or wrong: compare results of `robbdd run --json`") from error
