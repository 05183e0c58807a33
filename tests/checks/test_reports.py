"""Findings on models and on their graphs, and what each fix changes; ``reports/`` has the models and the answers."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import groupby, islice
from pathlib import Path

import pytest

from checks.models import apply, fixes_of
from kit import Fixture, fixture
from report_kit import HEADING, check_report, heading, message_of, reported
from robbdd_tools.base.diagnostic import Diagnostic
from robbdd_tools.checks import DECLARATION_RULES, FILE_RULES
from robbdd_tools.checks.graph_files import graph_findings
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.graph.write.build import build_graph

MOST_AT_A_PLACE = 2
"""Findings at one place that are shown: there may be one for each element of a set of similar ones."""
REPORTS = sorted((Path(__file__).parent / "reports").glob("*.txt"))
ON_DISK = {"python-source", "model-file", "model-name"}
"""Rules that read files beside the model; ``test_executions.py`` and ``test_model_names.py`` write these."""


def text_and_graph(case: Fixture) -> Iterator[str]:
    """Yield the report on a fixture, then the findings on the graph of its first file."""
    yield from reported(case)
    found = groupby(graph_findings(build_graph(case.snapshot, case.uri)), lambda entry: heading(case, entry))
    for position, (line, entries) in enumerate(found):
        if position == 0:
            yield "//== reported of the graph"
        yield line
        yield from (f"  {message_of(entry)}" for entry in islice(entries, MOST_AT_A_PLACE))


@pytest.mark.parametrize("path", REPORTS, ids=lambda path: path.stem)
def test_a_model_is_reported_as_before(path: Path) -> None:
    check_report(path, text_and_graph)


def test_every_rule_has_a_model_that_it_reports() -> None:
    reported = {line.partition(" ")[0] for path in REPORTS for line in path.read_text(encoding="utf-8").splitlines()}
    rules = {rule.__name__.replace("_", "-") for rule in (*DECLARATION_RULES, *FILE_RULES)}
    assert rules - ON_DISK <= reported


def test_a_fix_removes_its_finding_and_breaks_no_syntax() -> None:
    """One fix of each kind is applied: kinds differ in the words of the title outside of quotes."""
    kinds: set[tuple[str, str]] = set()
    for path in REPORTS:
        text = path.read_text(encoding="utf-8").partition(HEADING)[0]
        case = fixture(text)
        before = findings(case)
        for entry in before:
            for fix in fixes_of(case, entry):
                kind = entry.code, re.sub(r"'[^']*'", "", fix.title)
                if entry.code in ON_DISK or kind in kinds:
                    continue
                kinds.add(kind)
                changed = fixture(text)
                apply(changed, fix)
                after = findings(changed)
                assert count(after, entry.code, entry.message) < count(before, entry.code, entry.message), (path, fix)
                assert count(after, "syntax") <= count(before, "syntax"), (path, fix)
    assert len(kinds) > 40


def findings(case: Fixture) -> list[Diagnostic]:
    return [entry for uri in sorted(case.project.texts()) for entry in fast_diagnostics(case.snapshot, uri)]


def count(found: list[Diagnostic], code: str, message: str = "") -> int:
    return sum(entry.code == code and entry.message.startswith(message) for entry in found)
