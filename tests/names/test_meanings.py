"""What the names of a model mean, as text: declarations, references, types of variables, clauses and variants.

``meanings/`` has the models and the answers.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from kit import FOLDER, Fixture
from report_kit import check_report, place
from robbdd_tools.base.document import Document
from robbdd_tools.names.analysis import FileAnalysis
from robbdd_tools.names.clause_places import clauses_in
from robbdd_tools.names.definition import Definition
from robbdd_tools.names.elements import elements_of, scene_members, site_of
from robbdd_tools.names.index import imports_of
from robbdd_tools.names.name_parts import parts_of
from robbdd_tools.names.types import variable_type
from robbdd_tools.names.uses import clauses_of
from robbdd_tools.names.variant_places import variants_of
from robbdd_tools.syntax.declaration import SymbolKind

MEANINGS = sorted((Path(__file__).parent / "meanings").glob("*.txt"))
VARIABLES = (SymbolKind.VARIABLE, SymbolKind.SET_VARIABLE)


@pytest.mark.parametrize("path", MEANINGS, ids=lambda path: path.stem)
def test_the_names_of_a_model_mean_what_they_meant(path: Path) -> None:
    check_report(path, meaning)


def meaning(case: Fixture) -> Iterator[str]:
    """Yield what is known of the names of all files of a fixture."""
    for uri in sorted(case.project.texts()):
        analysis = case.snapshot.file(uri)
        assert analysis is not None
        for link in analysis.imports:
            yield f"import {place(case, uri, link.span)} {link.uri.removeprefix(FOLDER)} {link.problem or ''}".rstrip()
        for found in imports_of(Document(uri, 0, case.project.texts()[uri][1])):
            yield f"path {place(case, uri, found.span)}"
        for path, definition in analysis.definitions.items():
            yield f"{definition.kind} {path} {place(case, uri, definition.span)} {definition.iri}"
            yield from _known(case, definition)
        yield from _references(case, uri, analysis)
        for clause in clauses_in(case.snapshot, uri):
            yield f"clause {clause.iri} {place(case, uri, clause.span)}"
        for variant in variants_of(case.snapshot, uri):
            template = None if variant.template is None else variant.template.symbol.path
            rows = " ".join(place(case, uri, row) for row in variant.rows)
            yield f"variant {variant.iri} {template} {rows}".rstrip()


def _known(case: Fixture, definition: Definition) -> Iterator[str]:
    if definition.kind in VARIABLES:
        clauses, values = (
            variable_type(case.snapshot, definition, from_values=from_values) for from_values in (False, True)
        )
        yield f"  of clauses {clauses}, with values {values}{'' if values.is_known else ', unknown'}"
    site = site_of(case.snapshot, definition)
    for word, found in (("elements", elements_of(site)), ("members", scene_members(site))):
        if found:
            yield f"  {word} {' '.join(sorted(f'{one.kind}:{one.name}' for one in found))}"


def _references(case: Fixture, uri: str, analysis: FileAnalysis) -> Iterator[str]:
    for placed in analysis.parts():
        for reference in placed.declaration.references:
            if reference.ref in placed.targets:
                parts = parts_of(case.snapshot, uri, placed, reference)
                shown = [
                    f"{place(case, uri, span)} -> {found.uri.removeprefix(FOLDER)} {found.symbol.path}"
                    for span, found in parts
                ]
                yield f"reference {' '.join(shown)}"
        for clauses in clauses_of(placed.declaration):
            for use in clauses.uses:
                kinds = " ".join(sorted(use.kinds))
                yield f"use {place(case, uri, use.ref.span.shifted(placed.offset))} {kinds}: {use.phrase}"
