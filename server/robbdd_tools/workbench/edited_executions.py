"""Compare the stored executions of a run with an edited model: which clauses to re-judge, and where a trace is no
evidence.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.files import path_to_uri, uri_to_path
from robbdd_tools.base.step_files import may_define
from robbdd_tools.gherkin.select import SelectionError
from robbdd_tools.protocol.spec_changes import AGAIN, content_change, edited_clauses, seed_change, without_repetition
from robbdd_tools.protocol.specs import scenario_key
from robbdd_tools.run.used_files import changed
from robbdd_tools.workbench.judging import selection_of
from robbdd_tools.workbench.plan import Plan

if TYPE_CHECKING:
    from robbdd_tools.protocol.specs import ClauseSpec, Manifest, ScenarioSpec
    from robbdd_tools.run.store import StoredRun
    from robbdd_tools.workbench.model import ModelFile

GONE = f"the model no longer has this scenario with these values: {AGAIN}"


@dataclass(frozen=True, slots=True)
class EditedExecution:
    """A stored execution whose scenario was edited since.

    - ``index``: its number in the run.
    - ``stored``: its scenario when it was executed.
    - ``spec``: the edited scenario with only those clauses that can be re-judged; ``None`` if there is a ``reason``.
    - ``reason``: why the trace is no evidence for any clause of the edited scenario.
    - ``refused``: the edited clauses that cannot be re-judged, each with the reason.
    """

    index: int
    stored: ScenarioSpec
    spec: ScenarioSpec | None
    reason: str = ""
    refused: tuple[tuple[ClauseSpec, str], ...] = ()


def edited_executions(
    place: StoredRun, manifest: Manifest, file: ModelFile, indices: Iterable[int], drafts: Mapping[str, str]
) -> Iterator[EditedExecution]:
    """Yield the executions among ``indices`` that the edits of a model concern.

    ``manifest`` is the manifest of the run. ``drafts`` are the texts of open files by URI; the run may have used such a
    file. Raises ``NoSuchRun``, ``ModelErrors``, ``NothingToRun`` and ``OSError``.
    """
    record = place.record()
    wanted = {index: manifest.scenarios[index] for index in indices if index < len(manifest.scenarios)}
    reason = _changed_files(record.files, place.folder, drafts)
    if not reason and not record.models and file.digest == record.digest:
        return
    specs = {} if reason else _specs_now(place, manifest, file, wanted.values())
    comparison = Comparison(file)
    for index, stored in wanted.items():
        spec = specs.get(scenario_key(stored))
        edits = None if reason or spec is None else comparison.edits(spec, stored)
        if spec is None or edits is None:
            yield EditedExecution(index, stored, None, reason or GONE)
        elif why := edits.change or seed_change(spec, stored):
            yield EditedExecution(index, stored, None, why)
        elif edits.judged or edits.refused:
            yield EditedExecution(index, stored, replace(spec, clauses=edits.judged), refused=edits.refused)


@dataclass(frozen=True, slots=True)
class Edits:
    """The edits of a scenario since its execution: a ``change`` that makes its trace no evidence, or edited clauses."""

    change: str
    judged: tuple[ClauseSpec, ...] = ()
    refused: tuple[tuple[ClauseSpec, str], ...] = ()


class Comparison:
    """Compares scenarios with their stored executions; only once for all repetitions, as they have the same edits."""

    def __init__(self, file: ModelFile) -> None:
        self._file = file
        self._known: dict[tuple[str, int, str], tuple[ScenarioSpec, ScenarioSpec, Edits]] = {}

    def edits(self, spec: ScenarioSpec, stored: ScenarioSpec) -> Edits:
        """Return the edits of a scenario, except changes of its seed."""
        execution = "" if spec.execution is None else spec.execution.iri
        key = (spec.variant, spec.variation, execution)
        now, then = without_repetition(spec), without_repetition(stored)
        known = self._known.get(key)
        if known is None or (now, then) != known[:2]:
            known = self._known[key] = (now, then, self._found(spec, stored))
        return known[2]

    def _found(self, spec: ScenarioSpec, stored: ScenarioSpec) -> Edits:
        change = content_change(spec, stored)
        if change:
            return Edits(change)
        reasons = [(clause, _refusal(clause, spec, self._file)) for clause in edited_clauses(spec, stored)]
        judged = tuple(clause for clause, refusal in reasons if not refusal)
        return Edits("", judged, tuple((clause, refusal) for clause, refusal in reasons if refusal))


def _specs_now(
    place: StoredRun, manifest: Manifest, file: ModelFile, stored: Iterable[ScenarioSpec]
) -> dict[str, ScenarioSpec]:
    keys = {scenario_key(spec) for spec in stored}
    repeat = max(spec.repetition for spec in manifest.scenarios)
    try:
        plan = Plan.of_files(file.name, uri_to_path(file.uri), (file,), selection_of(place, manifest, keys))
        return {scenario_key(spec): spec for spec in plan.specs(repeat=repeat if repeat > 1 else None)}
    except SelectionError:
        return {}


def _changed_files(known: Mapping[str, str], folder: Path, drafts: Mapping[str, str]) -> str:
    """Return why a run's traces are no evidence if a used file has changed, saved or not; empty if none has."""
    found = dict.fromkeys(changed(known, folder))
    for name, digest in known.items():
        path = (folder / name).resolve()
        draft = drafts.get(path_to_uri(path))
        if draft is not None and hashlib.sha256(draft.encode("utf-8", "surrogatepass")).hexdigest() != digest:
            found.setdefault(path)
    if not found:
        return ""
    names = ", ".join(path.name for path in found)
    return f"{names} changed since the run: {AGAIN}"


def _refusal(clause: ClauseSpec, spec: ScenarioSpec, file: ModelFile) -> str:
    """Return why an edited clause is not judged while editing; empty unless users' code would judge it."""
    path = uri_to_path(file.uri)
    if path is not None and may_define(path, clause.sentence):
        return f"a step of the project judges it: {AGAIN}"
    policies = () if spec.execution is None else spec.execution.policies
    if any(policy.rule.kind == "python" for policy in policies if policy.clause in (clause.parts or (clause.iri,))):
        return f"Python code judges it: {AGAIN}"
    return ""
