"""``robbdd compare``: decide whether a run or study is worse than another, for people and continuous integration."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.printable import printable, printable_json
from robbdd_tools.base.writing import replace_file
from robbdd_tools.campaign.aligned_sources import aligned, flipped
from robbdd_tools.campaign.comparison_json import comparison_json
from robbdd_tools.campaign.comparison_page import TracedRun, comparison_page, flips_of
from robbdd_tools.campaign.comparison_text import (
    advice,
    conclusion,
    deciding_clauses,
    markdown,
    method_words,
    moved_words,
    remarks,
    table,
)
from robbdd_tools.campaign.gate import parse_gate
from robbdd_tools.campaign.log_sources import is_log_folder, log_source
from robbdd_tools.campaign.report_moments import Moments
from robbdd_tools.campaign.run_comparison import ComparisonOptions, Decision, compare_results
from robbdd_tools.campaign.run_sources import run_source
from robbdd_tools.campaign.study_again import execute_again
from robbdd_tools.campaign.study_source import stored_study
from robbdd_tools.commands import CANNOT_TELL, FINDINGS, OK
from robbdd_tools.commands.output import print_line
from robbdd_tools.commands.run import Outputs, report_problems
from robbdd_tools.run.readable import title
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.workbench.comparison import compare as list_changes

if TYPE_CHECKING:
    from robbdd_tools.campaign.run_sources import RunSource
    from robbdd_tools.workbench.comparison import Comparison, ExecutionChange

MOST_FLIPS = 20
"""At most this many flipped executions are printed."""
CODES = {Decision.IDENTICAL: OK, Decision.ACCEPTED: OK, Decision.WORSE: FINDINGS, Decision.UNCLEAR: CANNOT_TELL}


@dataclass(frozen=True, slots=True)
class CompareOptions:
    """The options of ``robbdd compare``.

    - ``before``, ``after``: stored runs or results files. ``path`` is in the project; ``store`` is another store.
    - ``gates``: texts such as ``no clause worse than 2 points``.
    - ``json``, ``markdown``, ``html``: output files.
    - ``again``: how many of a study's flipped executions are executed again, under ``policy``, to show replays.
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
    html: Path | None = None
    again: int = 0
    policy: Policy = field(default_factory=Policy)


def compare(options: CompareOptions) -> int:
    """Compare two runs and print the result for each clause.

    Returns 0 if the runs are identical or shown to be within the gate, 1 if a clause is worse, 2 if the runs cannot be
    compared, 3 if there are too few executions to decide.
    """
    return report_problems(Outputs(report=options.json), viewer=False, work=lambda: _compare(options))


def _compare(options: CompareOptions) -> int:
    gate = parse_gate(options.gates)
    before, after = (_source(word, options) for word in (options.before, options.after))
    before, after, differing = aligned(before, after)
    found = compare_results(
        before.results, after.results, ComparisonOptions(gate, options.level, by_margin=options.by_margin)
    )
    title = f"{before.name} → {after.name}"
    listed = _listed(before, after)
    changes = flipped(before, after) if listed is None else [change for change in listed.changes if change.flipped]
    notes = [*(listed.inputs if listed else ()), *differing, *remarks(found)]
    for line in (
        title,
        method_words(found),
        *notes,
        "",
        *table(found),
        "",
        *_flips(changes, listed=listed is not None),
    ):
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
    if options.html is not None:
        moments = Moments()
        with tempfile.TemporaryDirectory(prefix="robbdd-") as folder:
            sides = [
                _recordings(
                    options, source, [_index(change, later=later) for change in changes], Path(folder, str(later))
                )
                for later, source in enumerate((before, after))
            ]
            flips = flips_of(changes, (sides[0], sides[1]), moments)
        replace_file(options.html, comparison_page(title, found, notes, flips, len(changes), moments))
    return CODES[found.decision]


def _source(word: str, options: CompareOptions) -> RunSource:
    if is_log_folder(word):
        return log_source(word, options.path)
    return run_source(word, options.path, options.store)


def _listed(before: RunSource, after: RunSource) -> Comparison | None:
    """Return the flipped executions, and what differs in the input; ``None`` unless both runs are stored."""
    if before.place is None or after.place is None:
        return None
    return list_changes(before.place, after.place)


def _index(change: ExecutionChange, *, later: int) -> int:
    side = change.after if later else change.before
    assert side is not None
    return side.index


def _recordings(
    options: CompareOptions, source: RunSource, indices: Sequence[int], folder: Path
) -> Sequence[TracedRun]:
    """Return the runs that recorded the executions ``indices`` of a source.

    If the user asks for it, the first ones of a study are executed again.
    """
    if source.place is not None:
        results = source.results
        return [TracedRun(source.place, results, {one.index: one.index for one in results})]
    if source.study is None or not options.again:
        return []
    with stored_study(str(source.study), options.store) as store:
        found = execute_again(source.study, store, indices[: options.again], folder, options.policy)
    return [TracedRun(one.run.place, one.run.results, one.indices) for one in found]


def _flips(changes: Sequence[ExecutionChange], *, listed: bool) -> Iterator[str]:
    if not changes:
        return
    yield f"{len(changes)} execution{'s' * (len(changes) > 1)} with other verdicts:"
    for change in changes[:MOST_FLIPS]:
        yield from _flip(change)
    if len(changes) > MOST_FLIPS:
        where = ": *Compare Runs* of the editor lists all of them" if listed else ""
        yield f"  … and {len(changes) - MOST_FLIPS} more{where}"
    yield ""


def _flip(change: ExecutionChange) -> Iterator[str]:
    places = dict.fromkeys(f"execution {side.index + 1}" for side in (change.before, change.after) if side is not None)
    yield f"  {change.name}  {change.values}  ({' → '.join(places)})"
    causes = deciding_clauses(change)
    for clause in causes:
        reason = f": {clause.reason}" if clause.reason else ""
        yield f"      {title(clause.name, clause.name)}  {moved_words(clause)}{reason}"
    if len(causes) < len(change.clauses):
        yield f"      and {len(change.clauses) - len(causes)} more"
