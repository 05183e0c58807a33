"""``robbdd query``: query a model's knowledge graph with SPARQL."""

from __future__ import annotations

import csv
import re
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Document
from robbdd_tools.base.files import Unreadable, read_text
from robbdd_tools.base.printable import printable, printable_json
from robbdd_tools.commands import FAILED, OK
from robbdd_tools.commands.graph_of_study import graph_of_study
from robbdd_tools.commands.graph_results import graph_with_results
from robbdd_tools.commands.models import valid_model
from robbdd_tools.commands.output import fail, print_document, print_line, print_note
from robbdd_tools.syntax.study_content import STUDY

if TYPE_CHECKING:
    from robbdd_tools.graph.ask.query import Rows, Term
    from robbdd_tools.graph.write.built import BuiltGraph

ROW_FORMS = ("table", "csv", "json")
FORMULA = ("=", "+", "-", "@", "\uff1d", "\uff0b", "\uff0d", "\uff20")
"""First characters of a cell that a spreadsheet reads as a formula, including full-width forms."""
NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?")


def query(path: Path, text: str | None, file: Path | None, name: str | None, form: str, results: str | None) -> int:
    """Print the answer to one query and return the exit code.

    The query is given as text, as a file, or as the name of a built-in query. If ``results`` names a run, its results
    are part of the queried graph (see ``graph_with_results``).
    """
    from robbdd_tools.graph.ask.query import BadQuery, run_query

    source = _source(text, file, name)
    if source is None:
        return FAILED
    place, asked = source
    built = _graph(path, results)
    if built is None:
        return FAILED
    try:
        rows = run_query(built.graph, asked)
    except BadQuery as error:
        start = Document("", 0, asked).position(error.offset)
        print_note(f"{place}:{start.line + 1}:{start.column + 1}: error: {error} [query]")
        return FAILED
    for remark in rows.remarks if name is None else ():
        print_note(f"{place}: note: {remark}")
    if form in ROW_FORMS:
        {"table": _table, "csv": _csv, "json": _json}[form](rows)
        return OK
    return _save(rows, form)


def _graph(path: Path, results: str | None) -> BuiltGraph | None:
    if path.suffix == f".{STUDY}":
        return graph_of_study(path, results)
    model = valid_model(path)
    return None if model is None else graph_with_results(model, path, results)


def _save(rows: Rows, form: str) -> int:
    """Print the graph that a CONSTRUCT or DESCRIBE query returns in one of the graph formats."""
    from robbdd_tools.graph.rdf.serialize import UnwritableGraph, serialize

    if rows.graph is None:
        return fail(f"--format {form} is for CONSTRUCT and DESCRIBE; for SELECT and ASK take {', '.join(ROW_FORMS)}")
    try:
        print_document(serialize(rows.graph, form))
    except UnwritableGraph as error:
        return fail(str(error))
    return OK


def _source(text: str | None, file: Path | None, name: str | None) -> tuple[str, str] | None:
    """Return the display name and the text of the query. If not exactly one query is given, a message is printed."""
    from robbdd_tools.graph.ask.query import ready_queries, ready_query

    if sum(given is not None for given in (text, file, name)) != 1:
        print_note("robbdd: give one query: 'SELECT …', -f FILE, or --name with one of these")
        for ready, tells in ready_queries().items():
            print_note(f"  {ready:22} {tells}")
        return None
    if text is not None:
        return "query", text
    if file is not None:
        content = read_text(file)
        if isinstance(content, Unreadable):
            print_note(f"robbdd: {content.reason}")
            return None
        return str(file), content
    found = ready_query(name or "")
    if found is None:
        print_note(f"robbdd: there is no query '{name}'; there are {', '.join(ready_queries())}")
        return None
    return f"{name}.rq", found


def _short(term: Term | None, prefixes: dict[str, str]) -> str:
    from robbdd_tools.graph.ask.vocabularies import shortened

    if term is None or term.kind != "uri":
        return "" if term is None else term.value
    return shortened(term.value, prefixes)


def _table(rows: Rows) -> None:
    lines = [list(rows.columns), *([_short(term, rows.prefixes) for term in row] for row in rows.rows)]
    lines = [[printable(" ".join(cell.split())) for cell in line] for line in lines]
    widths = [max(len(line[column]) for line in lines) for column in range(len(rows.columns))]
    lines.insert(1, ["-" * width for width in widths])
    for line in lines:
        print_line("  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip())


def _csv(rows: Rows) -> None:
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(rows.columns)
    writer.writerows(["" if term is None else _cell(term.value) for term in row] for row in rows.rows)
    print_document(text.getvalue())


def _cell(value: str) -> str:
    """Return a value as one line that no spreadsheet interprets as a formula.

    Numbers, including negative ones, stay unchanged.
    """
    cell = printable(value)
    return f"'{cell}" if cell.lstrip().startswith(FORMULA) and not NUMBER.fullmatch(cell) else cell


def _json(rows: Rows) -> None:
    """Print the answer as SPARQL 1.1 Query Results JSON."""
    bindings = [
        {name: _binding(term) for name, term in zip(rows.columns, row, strict=True) if term is not None}
        for row in rows.rows
    ]
    document = {"head": {"vars": list(rows.columns)}, "results": {"bindings": bindings}}
    print_document(printable_json(document, indent=1) + "\n")


def _binding(term: Term) -> dict[str, str]:
    more = {"datatype": term.datatype, "xml:lang": term.language}
    return {"type": term.kind, "value": term.value} | {key: value for key, value in more.items() if value}
