"""``robbdd requirements``: show the coverage of requirements by scenarios and runs; exchange files with other tools."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.files import read_text
from robbdd_tools.base.graph_formats import graph_format
from robbdd_tools.base.writing import replace_file
from robbdd_tools.commands import FINDINGS, OK
from robbdd_tools.commands.models import print_findings
from robbdd_tools.commands.output import fail, print_line, print_note
from robbdd_tools.features.rejudged_results import SIGNS
from robbdd_tools.features.run_verdicts import NOTHING
from robbdd_tools.syntax.parse import LANGUAGES
from robbdd_tools.workbench.coverage_page import SUFFIXES, coverage_page
from robbdd_tools.workbench.model import load_all
from robbdd_tools.workbench.named_files import NotAModel
from robbdd_tools.workbench.reqif_file import SUFFIX, read_reqif, reqif_text
from robbdd_tools.workbench.requirement_graphs import graph_rows, graph_text, read_requirement_graph
from robbdd_tools.workbench.requirement_table import (
    NO_SCENARIO,
    RequirementRow,
    TableProblem,
    model_text,
    read_table,
    requirement_rows,
    stored_findings,
    table_text,
)
from robbdd_tools.workbench.stored import store_at

if TYPE_CHECKING:
    from robbdd_tools.run.store import RunStore
    from robbdd_tools.workbench.model import Model

_IRI = re.compile(r"[A-Za-z][A-Za-z0-9+.\-]*:[^\x00-\x20<>\"{}|\\^`]*[/#:]")


def list_requirements(paths: Sequence[Path], store: Path | None, output: Path | None, *, links_only: bool) -> int:
    """Print the coverage of the requirements of models, and write it to ``output``; return the exit code.

    The suffix of ``output`` selects ReqIF, a graph, a page (HTML) or CSV. The exit code is 1 unless a scenario verifies
    each requirement and, without ``links_only``, each held in the last runs.
    """
    if output is not None and output.suffix[1:].lower() in LANGUAGES:
        return fail(
            f"to write a model such as {output}, import a table or a graph: name its namespace (--namespace IRI)"
        )
    try:
        model = load_all(paths)
    except NotAModel as error:
        return fail(str(error))
    errors = [finding for finding in model.diagnostics if finding.is_error]
    if errors:
        print_findings(errors, print_note)
        return FINDINGS
    rows = _rows(model, store_at(paths[0], store), links_only=links_only)
    if not rows:
        print_note("robbdd: no requirements: declare one by 'Requirement name { \"…\" }'")
    for row in rows:
        print_line(_line(row, links_only=links_only))
    if output is not None:
        try:
            replace_file(output, _written(output, rows, links_only=links_only))
        except TableProblem as error:
            return fail(str(error))
        except OSError as error:
            return fail(f"cannot write {output}: {error.strerror}")
    missing = [row for row in rows if not row.is_shown(links_only=links_only)]
    proved = "verified by a scenario" if links_only else "shown by the last runs"
    print_line(f"{len(rows) - len(missing)} of {len(rows)} requirements {proved}")
    return FINDINGS if missing else OK


def _rows(model: Model, store: RunStore, *, links_only: bool) -> list[RequirementRow]:
    """Return the requirements of the text models, then those of the graphs, each once."""
    findings = NOTHING if links_only else stored_findings(store)
    texts = replace(model, files=[file for file in model.files if not graph_format(file.name)])
    found = {row.iri or row.name: row for row in requirement_rows(texts, findings)}
    for file in model.files:
        if graph_format(file.name):
            for row in graph_rows(file, findings.variants, store):
                found.setdefault(row.iri, row)
    return list(found.values())


def import_requirements(table: Path, output: Path | None, namespace: str | None, *, overwrite: bool) -> int:
    """Write the requirements of a table (CSV), a ReqIF file or a graph as a model or a graph; return the exit code."""
    if output is None or namespace is None:
        return fail(f"to import {table}, name the model (-o NEEDS.bdd) and its namespace (--namespace IRI)")
    if not _IRI.fullmatch(namespace):
        return fail(f"'{namespace}' is no IRI: write one such as https://example.org/needs/")
    text = read_text(table)
    if not isinstance(text, str):
        return fail(f"{table}: {text.reason}")
    if output.exists() and not overwrite:
        return fail(f"{output} exists: add --force to replace it")
    try:
        rows = _read(table, text)
        is_graph = graph_format(output.name) != ""
        replace_file(output, graph_text(output, rows, namespace) if is_graph else model_text(rows, namespace))
    except TableProblem as error:
        return fail(str(error))
    except OSError as error:
        return fail(f"cannot write {output}: {error.strerror}")
    print_line(f"{len(rows)} requirement{'' if len(rows) == 1 else 's'} in {output}")
    return OK


def _read(table: Path, text: str) -> list[RequirementRow]:
    if graph_format(table.name):
        return read_requirement_graph(table, text)
    return read_reqif(table, text) if table.suffix.lower() == SUFFIX else read_table(table, text)


def _written(output: Path, rows: Sequence[RequirementRow], *, links_only: bool) -> str:
    """Return the content of a file of requirements in the format of its suffix. Raises ``TableProblem``."""
    suffix = output.suffix.lower()
    if suffix == SUFFIX:
        return reqif_text(output, rows)
    if graph_format(output.name):
        return graph_text(output, rows)
    return coverage_page(rows, links_only=links_only) if suffix in SUFFIXES else table_text(rows)


def _line(row: RequirementRow, *, links_only: bool) -> str:
    label = f"{row.name} ({row.identifier})" if row.identifier else row.name
    if not row.scenarios:
        return f"✗ {label}: {NO_SCENARIO}"
    scenarios = ", ".join(row.scenarios)
    if links_only:
        return f"✔ {label}: {scenarios}"
    sign = SIGNS.get(row.verdict, "?")
    return f"{sign} {label}: {row.verdict}, {row.held} of {row.executions} executions ({scenarios})"
