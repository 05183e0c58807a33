"""The text that pytest prints about a scenario that does not hold."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.printable import printable
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.protocol.run_folder import trace_file
from robbdd_tools.run.consequences import consequences
from robbdd_tools.run.readable import title
from robbdd_tools.run.report import SIGNS, margin, plain_sentence, value_words

if TYPE_CHECKING:
    from robbdd_tools.monitor.fault import Fault
    from robbdd_tools.run.store import StoredRun
    from robbdd_tools.workbench.diagnostics import Place
    from robbdd_tools.workbench.execution_rows import ClauseResult
    from robbdd_tools.workbench.model import ModelFile
    from robbdd_tools.workbench.on_demand import Executed


class Failure(Exception):
    """A scenario does not hold, or cannot be executed.

    The message is the printed text. ``summary`` is the line in the short summary, and ``place`` is the place of the
    clause or scenario.
    """

    def __init__(self, summary: str, text: str, place: Place | None) -> None:
        super().__init__(text)
        self.summary = summary
        self.place = place


class Violated(Failure):
    """A clause is violated, so the test fails."""


class Unknown(Failure):
    """No clause is violated, but the evidence for a clause is missing, so the test has an error."""


def failure(executed: Executed, file: ModelFile, place: StoredRun) -> Failure:
    """Return the failure of an execution that does not hold."""
    result = executed.result
    kind = Violated if result.verdict is Outcome.VIOLATED else Unknown
    failed = [clause for clause in result.clauses if clause.verdict is not Outcome.HOLDS]
    worst = next((clause for clause in failed if clause.verdict is result.verdict), None)
    holding = [clause.name for clause in result.clauses if clause.verdict is Outcome.HOLDS]
    values = ", ".join(value_words(*value) for value in result.values.items())
    lines = [
        *([printable(values)] if values else []),
        *_failed_lines(failed, file),
        *([f"{SIGNS[Outcome.HOLDS]} {printable(', '.join(holding))}"] if holding else []),
        *(line for fault in executed.faults for line in _fault_lines(fault)),
        *(f"log: {printable(line)}" for line in executed.log),
        *map(printable, result.choices),
        *_evidence_lines(executed, place),
    ]
    found = file.place(worst.iri if worst is not None else result.variant) or file.place(result.variant)
    summary = f"{result.verdict}: no clause was judged" if worst is None else _summary(worst)
    return kind(summary, "\n".join(lines), found)


def _summary(clause: ClauseResult) -> str:
    return f"{printable(clause.name)} {_verdict_words(clause)}"


def _failed_lines(failed: Sequence[ClauseResult], file: ModelFile) -> Iterator[str]:
    """Yield each clause with its place. If another clause makes it unknown, its line names that clause."""
    named = [(title(clause.name, clause.sentence), clause) for clause in failed]
    for clause, because in zip(failed, consequences(named), strict=True):
        yield f"{SIGNS[clause.verdict]} {printable(clause.name)}: {printable(plain_sentence(clause.sentence))}"
        place = file.place(clause.iri)
        if place is not None:
            yield f"    {printable(str(place))}"
        yield f"    {_verdict_words(clause) if because is None else printable(because.words)}"


def _verdict_words(clause: ClauseResult) -> str:
    """Return the verdict with margin, instant and reason, where present."""
    return f"{_measured(clause)}: {printable(clause.reason)}" if clause.reason else _measured(clause)


def _measured(clause: ClauseResult) -> str:
    shown = margin(clause.margin, clause.unit)
    words = [str(clause.verdict)]
    words += [f"by {shown}"] if shown else []
    words += [] if clause.at is None else [f"at {clause.at:.2f} s"]
    return " ".join(words)


def _fault_lines(fault: Fault) -> Iterator[str]:
    yield f"error in your code: {printable(fault.code)} failed"
    yield from (printable(line) for line in fault.traceback())


def _evidence_lines(executed: Executed, place: StoredRun) -> Iterator[str]:
    yield f"seed: {executed.result.seed}"
    trace = trace_file(place.folder, executed.result.index)
    if not place.kept:
        yield "trace: not kept, because the run is not kept"
    elif trace.is_file():
        yield f"trace: {_shown(trace)}{f' (run {place.number})' if place.number else ''}"
    else:
        yield f"trace: none was recorded; the agent's log is in {_shown(place.folder / 'logs')}"


def _shown(path: Path) -> str:
    """Return a path relative to the working directory if it is below it."""
    return printable(os.path.relpath(path) if path.is_relative_to(Path.cwd()) else str(path))
