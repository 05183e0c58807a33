"""Requirements as a table: the coverage of models with the results of stored runs, and CSV files of other tools."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, count
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.features.pass_rates import Missing, extent
from robbdd_tools.features.project_findings import findings_of
from robbdd_tools.features.rejudged_results import BADNESS
from robbdd_tools.features.requirement_results import Coverage, coverage
from robbdd_tools.features.run_verdicts import Results
from robbdd_tools.names.elements import site_of
from robbdd_tools.names.requirement_links import requirements_of
from robbdd_tools.syntax import tree
from robbdd_tools.workbench.found_runs import NOTHING_SEEN, read_store

if TYPE_CHECKING:
    from robbdd_tools.features.run_verdicts import Findings
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.run.store import RunStore
    from robbdd_tools.workbench.model import Model

COLUMNS = ("name", "id", "text", "source", "scenarios", "held", "executions", "verdict")
"""The columns of an exported table. An import reads the first four."""
NO_SCENARIO, NOT_RUN, STALE, VACUOUS = "no scenario", "not run", "stale", "vacuous"
INCOMPLETE = "not run in full"
_NAME = re.compile(r"[^\W\d][\w\-]*")
_OTHER = re.compile(r"[^\w\-]+")


class TableProblem(Exception):
    """A table of requirements cannot be used. The message begins with the file, the line and the column."""


@dataclass(frozen=True, slots=True)
class ScenarioCell:
    """The latest result of a scenario for a requirement.

    ``outcome`` is the worst outcome of its executions; empty if the scenario was never run. ``missing`` executions were
    not made.
    """

    scenario: str
    outcome: str
    held: int
    executions: int
    vacuous: bool
    stale: bool
    missing: Missing = 0

    @property
    def remarks(self) -> list[str]:
        """The reasons why the result is no proof."""
        partial = [extent(self.executions, self.missing)] * (self.missing != 0)
        return partial + [VACUOUS] * self.vacuous + [STALE] * self.stale


@dataclass(frozen=True, slots=True)
class RequirementRow:
    """A requirement with its coverage.

    ``verdict`` is ``holds``, ``violated``, ``unknown`` or ``undefined``; or ``no scenario``, ``not run`` (some scenario
    that verifies it), ``not run in full`` (not all of its executions), ``stale`` (the text has changed since) or
    ``vacuous``, which are no proof either. ``iri`` is empty if no model declares the requirement yet.
    """

    name: str
    identifier: str
    text: str
    source: str
    evidence: tuple[ScenarioCell, ...] = ()
    verdict: str = NO_SCENARIO
    iri: str = ""

    @property
    def scenarios(self) -> tuple[str, ...]:
        """The scenarios that verify the requirement."""
        return tuple(cell.scenario for cell in self.evidence)

    @property
    def held(self) -> int:
        """The number of executions that satisfied the requirement."""
        return sum(cell.held for cell in self.evidence)

    @property
    def executions(self) -> int:
        """The number of executions of the requirement's scenarios."""
        return sum(cell.executions for cell in self.evidence)

    def is_shown(self, *, links_only: bool) -> bool:
        """Return whether the requirement is satisfied or, with ``links_only``, whether a scenario verifies it."""
        return bool(self.evidence) if links_only else self.verdict == "holds"

    @property
    def cells(self) -> tuple[str, ...]:
        """The cells of the row, in the order of ``COLUMNS``."""
        known = (self.name, self.identifier, self.text, self.source, "; ".join(self.scenarios))
        return (*known, str(self.held), str(self.executions), self.verdict)


def stored_findings(store: RunStore) -> Findings:
    """Return the latest result of each scenario in a store."""
    read = read_store(store, NOTHING_SEEN)
    results = Results()
    for run in read.found:
        results.merge(run.scenarios, read.newest, some_repetitions=run.some_repetitions)
    return findings_of(results)


def requirement_rows(model: Model, findings: Findings) -> list[RequirementRow]:
    """Return the requirements of the files of a model and of their imports, in the order of files and text."""
    found: dict[tuple[str, str], RequirementRow] = {}
    for file in model.files:
        for analysis in reversed(file.snapshot.closure(file.uri)):
            for one in coverage(file.snapshot, requirements_of(analysis), findings):
                found[one.requirement.uri, one.requirement.symbol.path] = _row(file.snapshot, one)
    return list(found.values())


def _row(snapshot: Snapshot, found: Coverage) -> RequirementRow:
    site = site_of(snapshot, found.requirement)
    root = None if site is None else site.tree
    texts = (root.identifier, root.text, root.source) if isinstance(root, tree.Requirement) else (None, None, None)
    identifier, text, source = ("" if one is None else one.value for one in texts)
    evidence = tuple(
        ScenarioCell(
            one.verifier.variant.definition.symbol.path,
            one.worst,
            one.held,
            one.run,
            one.vacuous,
            one.stale,
            one.missing,
        )
        for one in found.evidence
    )
    iri = found.requirement.iri or ""
    return RequirementRow(found.requirement.symbol.path, identifier, text, source, evidence, verdict_of(evidence), iri)


def verdict_of(evidence: Sequence[ScenarioCell]) -> str:
    """Return the verdict on a requirement that some scenarios verify."""
    if not evidence:
        return NO_SCENARIO
    worst = min((one.outcome for one in evidence if one.outcome), key=BADNESS.index, default="")
    if worst not in ("", "holds"):
        return worst
    if not all(one.outcome for one in evidence):
        return NOT_RUN
    if any(one.missing != 0 for one in evidence):
        return INCOMPLETE
    if any(one.stale for one in evidence):
        return STALE
    return VACUOUS if all(one.vacuous for one in evidence) else worst


def table_text(rows: Sequence[RequirementRow]) -> str:
    """Return rows as CSV (RFC 4180)."""
    output = io.StringIO()
    writer = csv.writer(output)
    writer.writerow(COLUMNS)
    writer.writerows(row.cells for row in rows)
    return output.getvalue()


def read_table(file: Path, text: str) -> list[RequirementRow]:
    """Return the requirements in a CSV table, with commas, semicolons or tabs between its cells.

    Its first row has the names of the columns: ``text``, and ``name`` or ``id`` or both; ``source`` is optional, other
    columns are ignored. Raises ``TableProblem``.
    """
    text = text.removeprefix("\ufeff")
    header = text.partition("\n")[0]
    sign = max(",;\t", key=header.count)
    cells = list(_cells(text, sign))
    places = {name.strip().lower(): number for number, (name, _, _) in enumerate(cells[0])} if cells else {}
    if "text" not in places or not {"name", "id"} & places.keys():
        listed = ", ".join(repr(name) for name in places) or "nothing"
        raise TableProblem(f"{file}:1:1: the first row needs the columns 'text' and 'id' (or 'name'); it has {listed}")
    names = Names()
    return [_read_row(file, places, row, names) for row in cells[1:] if any(cell for cell, _, _ in row)]


Cell = tuple[str, int, int]
"""The text of a cell with its line and column, from 1."""


class Names:
    """The names of requirements in use, each with the line where it was read."""

    def __init__(self) -> None:
        self.lines: dict[str, int] = {}

    def free(self, name: str, line: int) -> str:
        """Record a name and return it; empty if the name is in use or not valid in the language."""
        if name in self.lines or not _NAME.fullmatch(name):
            return ""
        self.lines[name] = line
        return name

    def made(self, identifier: str, line: int) -> str:
        """Return a new name for an identifier of another tool."""
        name = _OTHER.sub("-", identifier).strip("-")
        name = name if _NAME.fullmatch(name) else f"R-{name}"
        free = next(one for one in chain([name], (f"{name}-{number}" for number in count(2))) if one not in self.lines)
        self.lines[free] = line
        return free


def _read_row(file: Path, places: Mapping[str, int], row: list[Cell], names: Names) -> RequirementRow:
    _, line, _ = row[0]

    def cell(column: str) -> Cell:
        number = places.get(column, len(row))
        return (row[number][0].strip(), *row[number][1:]) if number < len(row) else ("", line, row[-1][2])

    (text, *at), (name, *named), (identifier, *identified) = cell("text"), cell("name"), cell("id")
    if not text:
        raise TableProblem(f"{file}:{at[0]}:{at[1]}: this requirement has no text: write what is required")
    if not name and not identifier:
        raise TableProblem(f"{file}:{identified[0]}:{identified[1]}: this requirement has neither a name nor an id")
    if name and not _NAME.fullmatch(name):
        words = "is no name of the language (letters, digits, '_' and '-'; a letter first): make it the id"
        raise TableProblem(f"{file}:{named[0]}:{named[1]}: '{name}' {words}")
    if name in names.lines:
        first = names.lines[name]
        raise TableProblem(
            f"{file}:{named[0]}:{named[1]}: '{name}' is the name of the requirement in line {first}, too"
        )
    if name:
        names.lines[name] = line
    else:
        name = names.made(identifier, line)
    return RequirementRow(name, "" if identifier == name else identifier, text, cell("source")[0])


def _cells(text: str, sign: str) -> Iterator[list[Cell]]:
    """Yield the rows of a table. The csv module reads the same cells, but does not report their places."""
    field = re.compile(rf'"((?:[^"]|"")*)"|([^{sign}\n]*)')
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    row: list[Cell] = []
    offset, line, start = 0, 1, 0
    while offset < len(text):
        match = field.match(text, offset)
        assert match is not None
        quoted = match[1] is not None
        value = match[1].replace('""', '"') if quoted else match[2]
        row.append((value, line, offset - start + 1))
        if newlines := match[0].count("\n"):
            line += newlines
            start = match.start() + match[0].rindex("\n") + 1
        offset = match.end()
        if quoted and offset < len(text) and text[offset] not in (sign, "\n"):
            # Text after the closing quote belongs to the cell.
            rest = re.compile(rf"[^{sign}\n]*").match(text, offset)
            assert rest is not None
            row[-1] = (value + rest[0], *row[-1][1:])
            offset = rest.end()
        if offset >= len(text) or text[offset] == "\n":
            yield row
            row, line, start = [], line + 1, offset + 1
        offset += 1


def model_text(rows: Sequence[RequirementRow], namespace: str) -> str:
    """Return requirements as the text of a model, whose namespace has the given IRI."""
    blocks = [f"ns req = {_quoted(namespace)}\n"]
    for row in rows:
        lines = [_quoted(row.text)]
        lines += [f"id: {_quoted(row.identifier)}"] * bool(row.identifier)
        lines += [f"source: {_quoted(row.source)}"] * bool(row.source)
        inner = "\n".join(f"    {line}" for line in lines)
        blocks.append(f"Requirement (ns=req) {row.name} {{\n{inner}\n}}\n")
    return "\n".join(blocks)


def _quoted(text: str) -> str:
    escapes = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\r": "\\r", "\t": "\\t"}
    return '"' + "".join(escapes.get(sign, sign) for sign in text) + '"'
