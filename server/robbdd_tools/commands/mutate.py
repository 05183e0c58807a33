"""``robbdd mutate``: give the simulated robots faults, and show which clauses notice them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING

from robbdd_tools.base.printable import printable, printable_json
from robbdd_tools.base.processes import end_requests
from robbdd_tools.base.writing import replace_file
from robbdd_tools.campaign.fault_matrix import FaultStatus
from robbdd_tools.campaign.fault_text import markdown_lines, matrix_lines, mutation_json, survivor_lines
from robbdd_tools.campaign.mutation import Mutation
from robbdd_tools.catalog.robot_faults import ROBOT_FAULTS
from robbdd_tools.commands import FAILED, FINDINGS, OK, signal_code
from robbdd_tools.commands.execute import INTERRUPTED
from robbdd_tools.commands.output import fail, print_line, print_note
from robbdd_tools.commands.run import Outputs, report_problems
from robbdd_tools.run.report import failure_words
from robbdd_tools.workbench.model import load_all
from robbdd_tools.workbench.plan import Plan, Selection

if TYPE_CHECKING:
    from robbdd_tools.campaign.fault_matrix import FaultMatrix
    from robbdd_tools.campaign.fault_probes import ProbedTemplate
    from robbdd_tools.catalog.robot_faults import RobotFault
    from robbdd_tools.run.results import ScenarioResult
    from robbdd_tools.run.run_policy import Policy

PAUSE = 5.0
"""Seconds between two lines of progress."""
MOST_SHOWN = 10
"""At most this many executions that fail without a fault are listed."""


@dataclass(frozen=True, slots=True)
class MutateOptions:
    """The options of ``robbdd mutate``. ``json`` and ``markdown`` are output files."""

    paths: Sequence[Path]
    selection: Selection
    faults: Sequence[RobotFault]
    policy: Policy
    repeat: int | None = None
    json: Path | None = None
    markdown: Path | None = None


def mutate(options: MutateOptions) -> int:
    """Execute models with faults and print the matrix of faults and clauses.

    Returns 0 if every fault is noticed in all executions, 1 if some fault is not, 2 if the executions show nothing.
    """
    return report_problems(Outputs(report=options.json), viewer=False, work=lambda: _mutate(options))


def list_faults() -> int:
    """Print the known faults with their sizes."""
    width = max(map(len, map(str, ROBOT_FAULTS.values())))
    for fault in ROBOT_FAULTS.values():
        print_line(f"{str(fault).ljust(width)}  {fault.description}")
    return OK


def _mutate(options: MutateOptions) -> int:
    plan = Plan.of(load_all(options.paths), options.selection)
    faults = tuple(dict.fromkeys(options.faults))
    mutation = Mutation(plan, faults, options.policy, options.selection.seed, options.repeat)
    ended_by = _follow(mutation)
    if mutation.ending:
        print_note(f"robbdd: {mutation.ending}")
        return signal_code(ended_by) if ended_by else FAILED
    _print_unsound(mutation.unsound)
    if not mutation.sound:
        return fail("no execution holds without a fault, so nothing can be said about faults: repair the model first")
    matrices, templates = mutation.matrices()
    for matrix in matrices:
        _print_matrix(matrix, templates[matrix.template])
    if options.json is not None:
        document = mutation_json(matrices, templates, mutation.unsound)
        replace_file(options.json, f"{printable_json(document, indent=2)}\n")
    if options.markdown is not None:
        replace_file(options.markdown, "\n".join(markdown_lines(matrices, templates)))
    survivors = sum(len(matrix.survivors) for matrix in matrices)
    return FINDINGS if survivors else OK


def _follow(mutation: Mutation) -> int:
    """Execute everything and print the progress. Return the number of the signal that ended the work, or 0."""
    ended_by = 0

    def cancel(number: int) -> None:
        nonlocal ended_by
        ended_by = number
        mutation.cancel(INTERRUPTED)

    shown = monotonic()
    with end_requests(cancel):
        for finished, total in mutation.progress():
            if monotonic() - shown >= PAUSE:
                shown = monotonic()
                print_note(f"{finished:,} of {total:,} executions")
    return ended_by


def _print_unsound(unsound: Sequence[ScenarioResult]) -> None:
    if not unsound:
        return
    counted = "1 execution does" if len(unsound) == 1 else f"{len(unsound)} executions do"
    print_line(f"{counted} not hold without any fault, which comes first:")
    for scenario in unsound[:MOST_SHOWN]:
        names = {clause.line: clause for clause in scenario.spec.clauses}
        words = (failure_words(one, names.get(one.line)) for one in scenario.judged.values() if one.verdict != "holds")
        print_line(f"  {printable(scenario.spec.name)}: {printable(next(words, 'not judged'))}")
    if len(unsound) > MOST_SHOWN:
        print_line(f"  … and {len(unsound) - MOST_SHOWN} more")
    print_line("")


def _print_matrix(matrix: FaultMatrix, template: ProbedTemplate) -> None:
    executions = max((row.executions for row in matrix.rows), default=0)
    counted = "1 execution" if executions == 1 else f"{executions} executions"
    print_line(f"{printable(template.name)}: {counted} with each fault; the clauses that it violates:")
    print_line("")
    for line in matrix_lines(matrix):
        print_line(printable(line))
    print_line("")
    place = template.place
    named = "" if place is None or place.path is None else f"{place.path.name}:{place.line}"
    for line in survivor_lines(matrix, template, named):
        print_line(printable(line))
    caught = sum(row.status is FaultStatus.NOTICED for row in matrix.rows)
    possible = sum(row.executions > 0 for row in matrix.rows)
    print_line(f"{caught} of {possible} faults are noticed in every execution")
    print_line("")
