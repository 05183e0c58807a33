"""Write a stored run as results for Allure Report: one file per execution, its clauses as steps, pictures, plots."""

from __future__ import annotations

import json
from base64 import b64decode
from collections.abc import Iterator, Mapping, Sequence
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any
from uuid import NAMESPACE_URL, uuid5

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.printable import printable, printable_json
from robbdd_tools.base.writing import replace_file
from robbdd_tools.campaign.report_moments import Moments
from robbdd_tools.campaign.report_source import run_report
from robbdd_tools.graph.verified_requirements import names_by_variant
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.plot import plot
from robbdd_tools.run.readable import title
from robbdd_tools.run.report import margin, plain_sentence, value_word, variable_word
from robbdd_tools.run.stored_results import execution_ends

if TYPE_CHECKING:
    from robbdd_tools.campaign.report_moments import Moment
    from robbdd_tools.campaign.report_source import ReportSource
    from robbdd_tools.workbench.execution_rows import ClauseResult, ExecutionResult
    from robbdd_tools.workbench.stored import PastRun

STATUS = {Outcome.HOLDS: "passed", Outcome.VIOLATED: "failed", Outcome.UNKNOWN: "broken"}
"""Verdict → Allure's status. ``broken`` is a test that came to no result."""


class NothingToExport(RobbddError):
    """The choice contains no execution of the run."""


def write_allure(run: PastRun, output: Path, names: Sequence[str] = ()) -> tuple[int, str]:
    """Write the results of a run into a folder; ``names`` limits them to these scenarios or variants.

    Equal content gives equal files: names are derived from the run's record and its executions. Returns the number of
    results, and the reason why there are no pictures (empty if there are some). Raises ``NothingToExport``,
    ``NoSuchRun`` and ``OSError``.
    """
    source = run_report(run)
    chosen = [one for one in source.results if not names or _is_named(one, names)]
    if not chosen:
        raise NothingToExport(f"the run has no scenario {', '.join(names)}" if names else "the run has no executions")
    moments = Moments()
    failed = [one for one in chosen if one.verdict is Outcome.VIOLATED]
    seen = moments.add(run.place, failed)
    ends = execution_ends(run.place.database, run.number)
    output.mkdir(parents=True, exist_ok=True)
    for result in chosen:
        identity = f"{run.record.digest}/{run.record.seed}/{run.number}/{result.index}"
        unique = str(uuid5(NAMESPACE_URL, identity))
        attachments = list(_attachments(source, result, seen.get(result.index), output, unique))
        document = _document(source, result, unique, ends.get(result.index), attachments)
        replace_file(output / f"{unique}-result.json", printable_json(document, indent=1) + "\n")
    lines = (f"{_property(name)}={printable(value)}\n" for name, value in source.environment)
    replace_file(output / "environment.properties", "".join(lines))
    return len(chosen), moments.problem


def _is_named(result: ExecutionResult, names: Sequence[str]) -> bool:
    known = {result.name, result.name.rpartition(" -- ")[0]}
    return bool({*known, *(name.rpartition(":")[2] for name in known)} & set(names))


def _document(
    source: ReportSource,
    result: ExecutionResult,
    unique: str,
    end: tuple[str, float] | None,
    attachments: Sequence[Mapping[str, str]],
) -> Mapping[str, Any]:
    # A scenario with the same values and repetition is the same test in every run, so Allure shows its history.
    same = json.dumps([result.variant, dict(result.values), result.execution, result.repetition], sort_keys=True)
    times: Mapping[str, int] = {} if end is None else _times(*end)
    violated = next((one for one in result.clauses if one.verdict is result.verdict), None)
    labels = [
        ("framework", "robbdd"),
        ("language", "robbdd"),
        ("parentSuite", result.model),
        ("suite", result.story.replace("#", "/").rpartition("/")[2]),
        ("subSuite", result.name.rpartition(" -- ")[0]),
        ("feature", result.story.replace("#", "/").rpartition("/")[2]),
        ("story", result.name.rpartition(" -- ")[0]),
        *(("requirement", name) for name in names_by_variant(source.requirements).get(result.variant, ())),
    ]
    return {
        "uuid": unique,
        "historyId": uuid5(NAMESPACE_URL, same).hex,
        "testCaseId": uuid5(NAMESPACE_URL, same).hex,
        "name": result.name,
        "fullName": f"{result.variant} {result.variation}",
        "status": STATUS[result.verdict],
        **({} if result.verdict is Outcome.HOLDS or violated is None else {"statusDetails": _details(violated)}),
        "stage": "finished",
        **times,
        "labels": [{"name": name, "value": value} for name, value in labels if value],
        "parameters": [
            *({"name": variable_word(name), "value": value_word(value)} for name, value in result.values.items()),
            {"name": "repetition", "value": str(result.repetition)},
            {"name": "seed", "value": str(result.seed), "excluded": True},
        ],
        "steps": [_step(clause, times) for clause in result.clauses],
        "attachments": list(attachments),
        "description": f"Simulate it again: `{source.command(result)}`",
    }


def _step(clause: ClauseResult, times: Mapping[str, int]) -> Mapping[str, Any]:
    shown = margin(clause.margin, clause.unit)
    at = "" if clause.at is None else f"{clause.at:.2f} s"
    known = (
        ("clause", title(clause.name, clause.sentence)),
        ("margin", shown),
        ("at", at),
        ("vacuous", clause.vacuous),
    )
    return {
        "name": f"{clause.role.capitalize()} {plain_sentence(clause.sentence)}",
        "status": STATUS[clause.verdict],
        **({} if clause.verdict is Outcome.HOLDS else {"statusDetails": _details(clause)}),
        "stage": "finished",
        **times,
        "parameters": [{"name": name, "value": value} for name, value in known if value],
    }


def _details(clause: ClauseResult) -> Mapping[str, str]:
    shown = margin(clause.margin, clause.unit)
    words = f"{title(clause.name, clause.sentence)} is {clause.verdict}{f' by {shown}' if shown else ''}"
    return {"message": f"{words}: {clause.reason}" if clause.reason else words}


def _times(ended: str, wall: float) -> Mapping[str, int]:
    """Return begin and end of an execution in ms since 1970; empty if the stored end is not a valid time."""
    try:
        stop = round(datetime.fromisoformat(ended).timestamp() * 1000)
    except ValueError:
        return {}
    return {"start": stop - round(wall * 1000), "stop": stop}


def _attachments(
    source: ReportSource, result: ExecutionResult, moment: Moment | None, output: Path, unique: str
) -> Iterator[Mapping[str, str]]:
    """Write picture and plots of an execution, and yield their entries. Raises ``OSError``."""
    if moment is not None and moment.picture:
        name = f"{unique}-attachment.png"
        replace_file(output / name, b64decode(moment.picture.partition(",")[2]))
        yield {"name": moment.words, "source": name, "type": "image/png"}
    curves, lines = source.curves(result)
    for clause, line in zip(result.clauses, lines, strict=False):
        drawn = plot(curves, line, clause.operand) if clause.verdict is Outcome.VIOLATED else None
        if drawn:
            name = f"{unique}-{line}-attachment.svg"
            replace_file(output / name, drawn)
            yield {"name": f"margin of {title(clause.name, clause.sentence)}", "source": name, "type": "image/svg+xml"}


def _property(name: str) -> str:
    """Return a name as a key of a Java properties file, in which spaces, = and : end a key."""
    return "".join(f"\\{letter}" if letter in " =:\\#!" else letter for letter in printable(name))
