"""``robbdd judge``: judge the traces of a stored run against the clauses of an edited model, without simulating."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.printable import printable_json
from robbdd_tools.base.writing import replace_file
from robbdd_tools.commands import FAILED, FINDINGS, OK
from robbdd_tools.commands.output import fail
from robbdd_tools.commands.progress import Display
from robbdd_tools.commands.requests import Choice, load_models, requests
from robbdd_tools.commands.runs import say_unfinished, store_at
from robbdd_tools.gherkin.select import Wanted
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.launch import Agent, stop
from robbdd_tools.run.manifest import STORED_RESULTS
from robbdd_tools.run.misfit import misfit
from robbdd_tools.run.prepare import prepare_all
from robbdd_tools.run.protocol import LogLine, RunMessage, ScenarioStarted, scenario_key
from robbdd_tools.run.results import RunResults, finished_in
from robbdd_tools.run.store import NoSuchRun
from robbdd_tools.run.user_code import refusal

if TYPE_CHECKING:
    from robbdd_tools.run.protocol import Manifest
    from robbdd_tools.run.store import StoredRun


@dataclass(frozen=True, slots=True)
class JudgeOptions:
    """The run (a number, ``latest`` or a folder), the edited model, where runs are kept, where results go."""

    run: str
    path: Path
    store: Path | None = None
    report: Path | None = None


def judge(options: JudgeOptions) -> int:
    """Print the verdicts of a model's clauses on stored traces; returns the exit code as ``robbdd run``."""
    try:
        stored = store_at(options.path, options.store).find(options.run)
        manifest, results, status = stored.manifest(), stored.results(), stored.status()
    except NoSuchRun as error:
        return fail(str(error))
    models = load_models(options.path)
    if models is None:
        return FAILED
    say_unfinished(stored, status)
    finished = finished_in(results)
    if not finished:
        return fail(f"run {options.run} has finished no execution yet")
    known = {scenario_key(manifest.scenarios[index]) for index in finished}
    repeat = max(spec.repetition for spec in manifest.scenarios)
    choice = Choice(
        Wanted(seed=manifest.seed), repeat=repeat if repeat > 1 else None, only=lambda spec: scenario_key(spec) in known
    )
    wanted = requests(models, choice)
    if isinstance(wanted, str):
        return fail(wanted)
    with tempfile.TemporaryDirectory(prefix="robbdd-") as name:
        judged = prepare_all(wanted, str(options.path), manifest.seed, Path(name))
        if not judged.scenarios:
            return fail(f"no scenario of {options.path} has the values of one in run {options.run}")
        problem = refusal(judged, Path(name), simulates=False)
        if problem:
            return fail(problem)
        replace_file(Path(name) / STORED_RESULTS, json.dumps(results))
        found = _judged(Path(name), judged, stored)
    if options.report is not None:
        replace_file(options.report, printable_json(found.as_json(), indent=1) + "\n")
    if not found.complete:
        return FAILED
    return OK if found.count(Outcome.HOLDS) == len(found.scenarios) else FINDINGS


def _fitting(messages: Iterable[RunMessage], manifest: Manifest) -> Iterator[RunMessage]:
    """Yield the messages, each that cannot be meant as a line of the log."""
    present = None
    for message in messages:
        present = message.index if isinstance(message, ScenarioStarted) else present
        problem = misfit(message, manifest.scenarios, present)
        yield LogLine("warning", problem) if problem else message


def _judged(folder: Path, manifest: Manifest, stored: StoredRun) -> RunResults:
    results = RunResults(manifest)
    agent = Agent(folder, module="robbdd_tools.agent.judge", arguments=[str(stored.folder.absolute())])
    ending = ""
    with Display(results) as display:
        try:
            for message in _fitting(agent.messages(), manifest):
                results.apply(message)
                display.watch(message)
                display.show(message)
                ending = message.text if isinstance(message, LogLine) else ending
        finally:
            stop([agent])
        if not results.complete:
            results.close(ending or agent.ending())
            display.broken(ending or agent.ending())
        display.summary(results)
    return results
