"""Matrices of faults and clauses as lines of text, as Markdown and as JSON."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from robbdd_tools.campaign.fault_matrix import FaultStatus
from robbdd_tools.run.report import margin

if TYPE_CHECKING:
    from robbdd_tools.campaign.fault_matrix import FaultCell, FaultMatrix, FaultRow
    from robbdd_tools.campaign.fault_probes import ProbedTemplate
    from robbdd_tools.catalog.robot_faults import RobotFault
    from robbdd_tools.run.results import ScenarioResult

KEEPS = "·"


def matrix_lines(matrix: FaultMatrix) -> list[str]:
    """Return the matrix as aligned lines. A cell has the number of executions in which the clause is violated."""
    rows = list(_table(matrix))
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]


def survivor_lines(matrix: FaultMatrix, template: ProbedTemplate, place: str) -> Iterator[str]:
    """Yield each fault that goes unnoticed in an execution, the clause that it moves most, and a proposed clause."""
    where = f"{place}: " if place else ""
    for row in matrix.survivors:
        missed = row.executions - row.noticed
        seen = f"in {missed} of {row.executions} executions " if row.noticed else ""
        yield f"{where}template {template.name}: {seen}nothing notices that {row.fault.description} ({row.fault.name})"
        moved = _most_moved(matrix, row)
        if moved:
            yield f"    {moved}"
        for probe, words in row.proposals:
            yield f"    this clause notices it: {template.written(probe)}{f' ({words})' if words else ''}"
        if not row.proposals:
            yield "    no clause is known that notices it in all executions"


def markdown_lines(matrices: Sequence[FaultMatrix], templates: Mapping[str, ProbedTemplate]) -> Iterator[str]:
    """Yield the matrices as Markdown tables."""
    for matrix in matrices:
        yield f"### {templates[matrix.template].name}"
        yield ""
        head, *rows = _table(matrix)
        yield _markdown_row(head)
        yield "|" + "---|" * len(head)
        yield from map(_markdown_row, rows)
        yield ""


def mutation_json(
    matrices: Iterable[FaultMatrix], templates: Mapping[str, ProbedTemplate], unsound: Iterable[ScenarioResult]
) -> dict[str, Any]:
    """Return the matrices as a document that follows ``docs/schemas/mutation.schema.json``."""
    return {
        "unsound": [one.spec.name for one in unsound],
        "templates": [_matrix_json(matrix, templates[matrix.template]) for matrix in matrices],
    }


def _matrix_json(matrix: FaultMatrix, template: ProbedTemplate) -> dict[str, Any]:
    place = template.place
    return {
        "iri": matrix.template,
        "name": template.name,
        "file": "" if place is None or place.path is None else place.path.name,
        "line": None if place is None else place.line,
        "clauses": [asdict(clause) for clause in matrix.clauses],
        "faults": [
            {
                "name": row.fault.name,
                "size": row.fault.size if row.fault.has_size else None,
                "unit": row.fault.unit,
                "description": row.fault.description,
                "status": str(row.status),
                "reason": row.reason,
                "executions": row.executions,
                "noticed": row.noticed,
                "proposals": [
                    {"clause": template.written(probe), "measured": words}
                    for probe, words in (row.proposals if row in matrix.survivors else ())
                ],
                "cells": [asdict(cell) for cell in row.cells],
            }
            for row in matrix.rows
        ],
    }


def _table(matrix: FaultMatrix) -> Iterator[tuple[str, ...]]:
    yield ("fault", "noticed", *(clause.name for clause in matrix.clauses), "")
    for row in matrix.rows:
        noticed = f"{row.noticed}/{row.executions}" if row.executions else "–"
        remark = "" if row.status is FaultStatus.NOTICED else str(row.status)
        remark = f"{remark}: {row.reason}" if row.status is FaultStatus.ABSENT else remark
        yield (_label(row.fault), noticed, *(_cell(cell) for cell in row.cells), remark)


def _label(fault: RobotFault) -> str:
    return f"{fault} {fault.unit}".rstrip()


def _cell(cell: FaultCell) -> str:
    words = [str(cell.violated)] if cell.violated else []
    words += [f"{cell.unknown}?"] if cell.unknown else []
    return " ".join(words) or KEEPS


def _most_moved(matrix: FaultMatrix, row: FaultRow) -> str:
    """Return the clause whose smallest margin shrinks by the largest share; empty if no margin shrinks."""
    found: list[tuple[float, str]] = []
    for clause, cell in zip(matrix.clauses, row.cells, strict=True):
        if cell.before and cell.after is not None and 0.0 <= cell.after < cell.before:
            before, after = margin(cell.before, cell.unit), margin(cell.after, cell.unit)
            if before != after:
                found.append(((cell.before - cell.after) / cell.before, f"{clause.name}: margin {before} → {after}"))
    return max(found, default=(0.0, ""))[1]


def _markdown_row(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cell.replace('|', '&#124;') for cell in cells)} |"
