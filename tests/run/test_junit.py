"""JUnit XML as its readers expect it."""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from robbdd_tools.protocol.messages import ClauseJudged, ScenarioFinished
from robbdd_tools.protocol.specs import ClauseSpec, Manifest, ScenarioSpec, SceneSpec
from robbdd_tools.run.junit import junit
from robbdd_tools.run.results import RunResults

CLAUSES = tuple(ClauseSpec(line, f"https://x/c{line}", f"c{line}", "then", f'"e:a" {line}') for line in (5, 6))
VALUES = {"e:x": "<&\"\x07'😀"}
SPEC = ScenarioSpec(
    "features/s.feature", 3, "e:v -- 1", "https://x/s", "https://x/v", 1, VALUES, 7, SceneSpec(), {}, CLAUSES
)


def schema_faults(text: str) -> list[str]:
    # xmlschema's types are left open.
    schema: Any = import_module("xmlschema").XMLSchema(str(Path(__file__).with_name("junit.xsd")))
    return [str(fault.reason) for fault in schema.iter_errors(text)]


def written(*outcomes: str) -> str:
    """A document of one scenario per outcome, the last one of another story and never judged."""
    specs = [replace(SPEC, variation=number) for number, _ in enumerate(outcomes, start=1)]
    results = RunResults(Manifest("m.bdd", 1, (*specs, replace(SPEC, story="https://x/other", values={}))))
    for index, outcome in enumerate(outcomes):
        for clause in CLAUSES:
            results.apply(ClauseJudged(index, clause.line, outcome, -0.01, "m", 1.0, "because \x00 ]]> of\nthis"))
        results.apply(ScenarioFinished(index, 10.0, 1.5, 0.5))
    return junit(results)


@pytest.mark.parametrize("outcomes", [(), ("holds",), ("holds", "violated", "unknown")])
def test_a_document_is_valid(outcomes: tuple[str, ...]) -> None:
    assert schema_faults(written(*outcomes)) == []


def test_the_schema_finds_faults() -> None:
    text = written("violated")
    assert schema_faults(text.replace(' classname="v"', "", 1))
    assert schema_faults(text.replace('time="1.500"', 'time="long"', 1))
    assert schema_faults(text.replace("<system-out>", "<output>").replace("</system-out>", "</output>"))


def test_verdicts_become_failures_and_errors_that_are_counted() -> None:
    root = ElementTree.fromstring(written("holds", "violated", "unknown"))
    suite, other = root
    assert [suite.get(name) for name in ("name", "tests", "failures", "errors", "time")] == [
        "s",
        "3",
        "1",
        "1",
        "4.500",
    ]
    assert [[child.tag for child in case] for case in suite] == [
        ["system-out"],
        ["failure", "system-out"],
        ["error", "system-out"],
    ]
    assert (other.get("errors"), other[0][0].get("message")) == (
        "1",
        "? unknown: the clause was never judged  [Then a 5]",
    )
