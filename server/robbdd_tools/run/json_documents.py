"""Build the JSON documents that display stored runs and recorded executions.

Their schemas are ``docs/schemas/runs.schema.json`` and ``docs/schemas/trace.schema.json``.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any

from robbdd_tools.base import interpreter
from robbdd_tools.base.files import load_text, path_to_uri
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.protocol.run_folder import curves_file, trace_file
from robbdd_tools.protocol.specs import ScenarioSpec
from robbdd_tools.run.report import plain_sentence, values_words
from robbdd_tools.run.results import finished_in
from robbdd_tools.run.store import NoSuchRun, RunStore, StoredRun
from robbdd_tools.run.stored_results import FAILED, FINISHED


class NoTrace(Exception):
    """There is no trace to show; the message gives the reason."""


def summary(run: StoredRun) -> dict[str, Any]:
    """Return a run's entry in the list of runs."""
    found: dict[str, Any] = {"run": run.number, "folder": path_to_uri(run.folder.absolute())}
    try:
        record, status = run.record(), run.status()
        found |= {"path": record.path, "model": path_to_uri(run.model()), "seed": record.seed}
        extent = {"state": status.state, "finished": status.finished, "total": status.total}
        return {**found, **_counts(status.counts), "complete": status.state == FINISHED, **extent, "problem": None}
    except (NoSuchRun, KeyError, TypeError) as error:
        nothing = {"path": "", "model": "", "seed": 0, "complete": False, "state": FAILED, "finished": 0, "total": 0}
        return {**found, **nothing, **_counts({}), "problem": str(error)}


def scenarios(run: StoredRun) -> Iterator[dict[str, Any]]:
    """Yield the scenarios of a run as entries of the JSON list of runs. Raises ``NoSuchRun``."""
    results = run.results()
    finished = finished_in(results)
    for index, (spec, entry) in enumerate(zip(run.manifest().scenarios, results["scenarios"], strict=False)):
        yield _scenario(run, index, spec, entry["verdict"], finished=index in finished)


def traced_variants(run: StoredRun) -> frozenset[str]:
    """Return the IRIs of the variants that have a stored trace in a run; empty if the run cannot be read."""
    try:
        return frozenset(one["variant"] for one in scenarios(run) if one["trace"])
    except NoSuchRun:
        return frozenset()


def find_trace(store: RunStore, word: str | None, given: Mapping[str, object]) -> tuple[StoredRun, int]:
    """Find a scenario with a stored trace; return its run and its number. Raises ``NoTrace`` and ``NoSuchRun``.

    ``word`` names the run. Without a word, the newest run with such a scenario is used. ``given`` are fields that the
    entry of the scenario (see ``scenarios``) must match. If several scenarios match, the first violated one is
    returned, or the first one if none is violated.
    """
    runs = list(reversed(store.runs())) if word is None else [store.find(word)]
    for run in runs:
        try:
            fitting = [one for one in scenarios(run) if one["trace"] and given.items() <= one.items()]
        except NoSuchRun:
            if word is not None:
                raise
            continue
        if fitting:
            return run, min(fitting, key=lambda one: one["verdict"] != Outcome.VIOLATED)["index"]
    where = f"run {word}" if word is not None else f"the runs in {store.folder}" if runs else str(store.folder)
    raise NoTrace(f"there is no trace of {'that scenario' if given else 'any scenario'} in {where}: run it first")


def trace_document(run: StoredRun, index: int) -> dict[str, Any]:
    """Return the JSON document of a trace. Raises ``NoTrace`` and ``NoSuchRun``.

    The document does not depend on the current text of the model. So its clauses have no ``source`` and no ``stale``;
    ``written`` has the sentence of the step instead.
    """
    specs, document = run.manifest().scenarios, run.results()
    results = document["scenarios"]
    if not 0 <= index < min(len(specs), len(results)):
        raise NoTrace(f"run {run.number} has no scenario number {index}")
    spec, result = specs[index], results[index]
    if index not in finished_in(document) or not trace_file(run.folder, index).is_file():
        raise NoTrace(f"run {run.number} keeps no trace of {spec.name}")
    seen = _seen(run, index)
    kept = stored_curves(run, index)
    parts = {str(clause.line): kept["clauses"].get(str(clause.line), []) for clause in spec.clauses}
    return {
        "run": run.number,
        "folder": path_to_uri(run.folder.absolute()),
        "scenario": _scenario(run, index, spec, result["verdict"], finished=True),
        "duration": kept["duration"],
        "remark": kept["remark"],
        "events": kept["events"],
        **seen,
        "clauses": [
            {
                **entry,
                "sentence": plain_sentence(clause.sentence),
                "written": clause.sentence,
                "parts": parts[str(clause.line)],
            }
            for clause, entry in zip(spec.clauses, result["clauses"], strict=True)
        ],
    }


def stored_curves(run: StoredRun, index: int) -> Mapping[str, Any]:
    """Return the curves that are stored with a trace. Raises ``NoTrace``.

    The result has the duration, the remark and the events of the trace, and the curves of each clause by its feature
    line.
    """
    path = curves_file(run.folder, index)
    try:
        return json.loads(load_text(path, RESULT_SIZE))
    except (OSError, ValueError) as error:
        raise NoTrace(f"{path} cannot be read: {error}") from error


def _seen(run: StoredRun, index: int) -> dict[str, Any]:
    done = interpreter.run("robbdd_tools.agent.show_trace", str(run.folder.absolute()), str(index))
    if done.returncode:
        said = (done.stderr.strip().splitlines() or [f"the reading process ended with code {done.returncode}"])[-1]
        raise NoTrace(said)
    return json.loads(done.stdout)


def scenario_entry(index: int, spec: ScenarioSpec, verdict: str, *, trace: bool) -> dict[str, Any]:
    """Return the JSON of a scenario. ``trace`` is true if a trace of the scenario can be shown."""
    return {
        "index": index,
        "name": spec.name,
        "values": values_words(spec),
        "story": spec.story,
        "variant": spec.variant,
        "variation": spec.variation,
        "execution": None if spec.execution is None else spec.execution.iri,
        "repetition": spec.repetition,
        "seed": spec.seed,
        "verdict": verdict,
        "trace": trace,
    }


def _scenario(run: StoredRun, index: int, spec: ScenarioSpec, verdict: str, *, finished: bool) -> dict[str, Any]:
    # A result of an interrupted execution is no evidence.
    return scenario_entry(index, spec, verdict, trace=finished and trace_file(run.folder, index).is_file())


def _counts(verdicts: Mapping[str, int]) -> dict[str, int]:
    return {str(outcome): verdicts.get(outcome, 0) for outcome in Outcome}
