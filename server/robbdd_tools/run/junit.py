"""JUnit XML report for CI systems: one suite per user story, one test case per execution."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import groupby
from xml.etree import ElementTree

from robbdd_tools.base.printable import printable
from robbdd_tools.monitor.fault import Fault
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.consequences import consequences
from robbdd_tools.run.readable import clause_title, readable
from robbdd_tools.run.report import SIGNS, plain_sentence, values_words, verdict_words
from robbdd_tools.run.results import RunResults, ScenarioResult, unjudged

Requirements = Mapping[str, Sequence[str]]
"""IRI of a variant → names of the requirements that it verifies."""


def junit(results: RunResults, requirements: Requirements | None = None) -> str:
    """Return the results as JUnit XML.

    A violated clause is a failure and an unknown clause is an error. ``time`` is the wall time in s. ``requirements``
    maps variants to the requirements that they verify; the output of their test cases names these.
    """
    root = ElementTree.Element("testsuites")
    for story, scenarios in groupby(results.scenarios, key=lambda scenario: scenario.spec.story):
        _suite(root, story, list(scenarios), results, requirements or {})
    ElementTree.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def _suite(
    root: ElementTree.Element,
    story: str,
    scenarios: list[ScenarioResult],
    results: RunResults,
    requirements: Requirements,
) -> None:
    outcomes = [scenario.verdict for scenario in scenarios]
    suite = ElementTree.SubElement(root, "testsuite", name=printable(story.replace("#", "/").rsplit("/", 1)[-1]))
    suite.set("tests", str(len(scenarios)))
    suite.set("failures", str(outcomes.count(Outcome.VIOLATED)))
    suite.set("errors", str(outcomes.count(Outcome.UNKNOWN)))
    suite.set("skipped", "0")
    suite.set("time", f"{sum(map(_wall, scenarios)):.3f}")
    for scenario in scenarios:
        verified = requirements.get(scenario.spec.variant, ())
        _case(suite, scenario, results.faults_of(scenario), verified)


def _case(
    suite: ElementTree.Element, scenario: ScenarioResult, faults: list[Fault], requirements: Sequence[str]
) -> None:
    spec = scenario.spec
    group = spec.variant.replace("#", "/").rsplit("/", 1)[-1]
    group = group if spec.execution is None else f"{group}.{spec.execution.name.rpartition(':')[2]}"
    name = f"{spec.name} [{values_words(spec)}]" if spec.values else spec.name
    case = ElementTree.SubElement(suite, "testcase", name=printable(name), classname=printable(group))
    case.set("time", f"{_wall(scenario):.3f}")
    failed = list(_failed(scenario))
    outcome = scenario.verdict
    if outcome is not Outcome.HOLDS:
        tag = "failure" if outcome is Outcome.VIOLATED else "error"
        worst = next((words for verdict, words in failed if verdict is outcome), "no clause was judged")
        element = ElementTree.SubElement(case, tag, message=printable(worst), type=str(outcome))
        element.text = _lines((*(words for _, words in failed), *_tracebacks(faults)))
    output = ElementTree.SubElement(case, "system-out")
    printed = (f"│ {line}" for line in scenario.printed.splitlines())
    verified = [f"verifies {', '.join(requirements)}"] if requirements else []
    output.text = _lines(
        (f"seed {spec.seed}", *verified, *spec.choices, *(words for _, words in _clauses(scenario)), *printed)
    )


def _tracebacks(faults: Iterable[Fault]) -> Iterable[str]:
    for fault in faults:
        yield f"{fault.code} failed"
        yield from fault.traceback()


def _failed(scenario: ScenarioResult) -> Iterable[tuple[Outcome, str]]:
    return ((outcome, words) for outcome, words in _clauses(scenario) if outcome is not Outcome.HOLDS)


def _clauses(scenario: ScenarioResult) -> Iterable[tuple[Outcome, str]]:
    """Yield the outcome and the text of each clause: its sentence, margin, instant and reason.

    If a clause is unknown because of another clause, its text names this clause instead of the reason.
    """
    clauses = scenario.spec.clauses
    every = [scenario.judged.get(clause.line) or unjudged(clause) for clause in clauses]
    names = (clause_title(clause) for clause in clauses)
    for clause, judged, because in zip(clauses, every, consequences(zip(names, every, strict=True)), strict=True):
        words = (
            f"{SIGNS[Outcome.UNKNOWN]} {because.words}"
            if because
            else verdict_words(readable(judged, scenario.spec), clause)
        )
        yield Outcome(judged.verdict), f"{words}  [{clause.role.capitalize()} {plain_sentence(clause.sentence)}]"


def _wall(scenario: ScenarioResult) -> float:
    return 0.0 if scenario.finished is None else scenario.finished.wall


def _lines(words: Iterable[str]) -> str:
    """Escape the characters that XML cannot contain and those that control a terminal; keep line breaks."""
    return "\n".join(printable(line) for each in words for line in each.split("\n"))
