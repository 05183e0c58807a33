"""``robbdd compare``: decide whether a run is worse than another one, for people and for continuous integration."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.printable import printable, printable_json
from robbdd_tools.base.writing import replace_file
from robbdd_tools.campaign.comparison_json import comparison_json
from robbdd_tools.campaign.comparison_text import advice, conclusion, markdown, method_words, remarks, table
from robbdd_tools.campaign.gate import parse_gate
from robbdd_tools.campaign.run_comparison import ComparisonOptions, Decision, compare_results
from robbdd_tools.campaign.run_sources import run_source
from robbdd_tools.commands import CANNOT_TELL, FINDINGS, OK
from robbdd_tools.commands.output import print_line
from robbdd_tools.commands.run import Outputs, report_problems
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.readable import title
from robbdd_tools.run.report import SIGNS, margin
from robbdd_tools.workbench.comparison import compare as list_changes

if TYPE_CHECKING:
    from robbdd_tools.campaign.run_sources import RunSource
    from robbdd_tools.workbench.comparison import Comparison, ExecutionChange

MOST_FLIPS = 20
"""So many executions that flipped are printed."""
CODES = {Decision.IDENTICAL: OK, Decision.ACCEPTED: OK, Decision.WORSE: FINDINGS, Decision.UNCLEAR: CANNOT_TELL}


@dataclass(frozen=True, slots=True)
class CompareOptions:
    """The options of ``robbdd compare``.

    - ``before``, ``after``: stored runs or results files. ``path`` is in the project, ``store`` another store.
    - ``gates``: texts such as ``no clause worse than 2 points``.
    - ``json``, ``markdown``: output files.
    """

    before: str
    after: str
    path: Path
    store: Path | None = None
    gates: tuple[str, ...] = ()
    level: float = 0.95
    by_margin: bool = False
    json: Path | None = None
    markdown: Path | None = None


def compare(options: CompareOptions) -> int:
    """Compare two runs and print what is shown of each clause.

    Returns 0 if the runs are identical or the gate is shown to be kept, 1 if a clause is worse, 2 if the runs cannot be
    compared, 3 if the executions do not tell.
    """
    return report_problems(Outputs(report=options.json), viewer=False, work=lambda: _compare(options))


def _compare(options: CompareOptions) -> int:
    gate = parse_gate(options.gates)
    before, after = (run_source(word, options.path, options.store) for word in (options.before, options.after))
    found = compare_results(
        before.results, after.results, ComparisonOptions(gate, options.level, by_margin=options.by_margin)
    )
    title = f"{before.name} → {after.name}"
    changes = _changes(before, after)
    notes = [*(changes.inputs if changes else ()), *remarks(found)]
    for line in (title, method_words(found), *notes, "", *table(found), "", *_flips(changes)):
        print_line(line)
    print_line(conclusion(found))
    hint = advice(found, gate.limit(""))
    if hint:
        print_line(hint)
    if options.json is not None:
        document = comparison_json(before.name, after.name, found, notes)
        replace_file(options.json, printable_json(document, indent=1) + "\n")
    if options.markdown is not None:
        text = markdown(title, found, notes)
        replace_file(options.markdown, "".join(f"{printable(line)}\n" for line in text.splitlines()))
    return CODES[found.decision]


def _changes(before: RunSource, after: RunSource) -> Comparison | None:
    """Return which executions flipped, and what differs in the input; ``None`` unless both runs are stored."""
    if before.place is None or after.place is None:
        return None
    return list_changes(before.place, after.place)


def _flips(changes: Comparison | None) -> Iterator[str]:
    if changes is None or not changes.flipped:
        return
    flipped = [change for change in changes.changes if change.flipped]
    yield f"{len(flipped)} execution{'s' * (len(flipped) > 1)} with other verdicts:"
    for change in flipped[:MOST_FLIPS]:
        yield from _flip(change)
    if len(flipped) > MOST_FLIPS:
        yield f"  … and {len(flipped) - MOST_FLIPS} more: *Compare Runs* of the editor lists all of them"
    yield ""


def _flip(change: ExecutionChange) -> Iterator[str]:
    places = dict.fromkeys(f"execution {side.index + 1}" for side in (change.before, change.after) if side is not None)
    yield f"  {change.name}  {change.values}  ({' → '.join(places)})"
    # What is unknown now follows from what is violated now.
    causes = [clause for clause in change.clauses if clause.after is Outcome.VIOLATED] or change.clauses
    for clause in causes:
        old = f"{SIGNS[clause.before]} {margin(clause.margin_before, clause.unit)}" if clause.before else "—"
        new = f"{SIGNS[clause.after]} {margin(clause.margin_after, clause.unit)}" if clause.after else "—"
        reason = f": {clause.reason}" if clause.reason else ""
        yield f"      {title(clause.name, clause.name)}  {old.strip()} → {new.strip()}{reason}"
    if len(causes) < len(change.clauses):
        yield f"      and {len(change.clauses) - len(causes)} more"
