"""Read results of runs made elsewhere, as written by ``robbdd run --json`` or ``--junit``."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Any, cast
from xml.etree import ElementTree

from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.protocol.messages import ClauseJudged
from robbdd_tools.run.consequences import Causes
from robbdd_tools.run.readable import title
from robbdd_tools.run.report import (
    SIGNS,
    failure_words,
    margin,
    plain_sentence,
    reason_first,
    value_words,
    verdict_words,
)

_VERDICTS = tuple(str(outcome) for outcome in SIGNS)
_CASE = re.compile(r"(?:[^\s:]*:)?(?P<variant>\S+) -- (?P<number>\d+)[^\[]*(?:\[(?P<values>.*)\])?", re.DOTALL)
_CLAUSE = re.compile(
    r"^(?P<sign>[✔✗?])(?P<said>.*?)  \[(?:Given|When|Then) (?P<sentence>[^\n]*)\]$", re.DOTALL | re.MULTILINE
)
"""Matches a clause in a test case's output. Only the reason may span several lines."""
_CONSEQUENCE = re.compile(r"unknown (?:because of|for the same reason as) ")
"""Matches how the JUnit text of a clause begins that is unknown because of another one. A reason follows a colon."""
_MARGIN = re.compile(r" ([+−][\d.]+ [^\s:]+)")


@dataclass(frozen=True, slots=True)
class ImportedCause:
    """A clause that makes another clause unknown.

    ``iri`` and ``position`` (its number) are ``None`` if the file lacks them. ``words`` name the clause.
    """

    iri: str | None
    position: int | None
    words: str


@dataclass(frozen=True, slots=True)
class ImportedClause:
    """A judged clause of an imported execution.

    ``iri`` is ``None`` if the file does not contain the IRI of the clause. ``said`` is the full text of the verdict,
    ``margin`` is the text of the margin alone, and ``failure`` is the text with the reason first. ``because`` is
    the clause of the same execution that is the cause.
    """

    iri: str | None
    sentence: str
    verdict: str
    margin: str
    said: str
    failure: str
    because: ImportedCause | None = None


@dataclass(frozen=True, slots=True)
class ImportedScenario:
    """One execution in an imported results file: scenario number ``variation`` of a variant.

    - ``variant``: the IRI of the variant, or only its name if the file is JUnit XML.
    - ``model``: the path of the model file on the machine of the run; empty if the file is JUnit XML.
    - ``story``: the name of the story.
    - ``execution``: the name of the execution in a ``.bddx``; empty if the scenario was run without one.
    - ``seconds``: the wall time, if known.

    The clauses are in the order in which they were judged.
    """

    model: str
    story: str
    variant: str
    variation: int
    values: str
    seconds: float | None
    clauses: tuple[ImportedClause, ...]
    execution: str = ""


class BrokenResults(Exception):
    """The text is not a results file.

    The message is for the user. ``line`` and ``column`` (both from 1) are the place of the error in the text.
    """

    def __init__(self, message: str, line: int = 1, column: int = 1) -> None:
        super().__init__(message)
        self.line = line
        self.column = column


def read_results(text: str) -> list[ImportedScenario]:
    """Return the executions of a results file. Raises ``BrokenResults``.

    The text may begin with a byte-order mark.
    """
    text = text.removeprefix("\ufeff")
    return _from_junit(text) if text.lstrip().startswith("<") else _from_json(text)


def _from_json(text: str) -> list[ImportedScenario]:
    try:
        data: object = json.loads(text)
    except json.JSONDecodeError as error:
        raise BrokenResults(f"this is neither JSON nor XML: {error.msg}", error.lineno, error.colno) from None
    except RecursionError:
        raise BrokenResults("this is not a results file: it is nested too deeply") from None
    scenarios = _Reader("", data).mapping("scenarios")
    return [_scenario(entry) for entry in scenarios.entries()]


def _scenario(entry: _Reader) -> ImportedScenario:
    values = entry.mapping("values")
    return ImportedScenario(
        entry.text("model", ""),
        _local(entry.text("story")),
        entry.text("variant"),
        entry.number("variation"),
        ", ".join(value_words(name, value) for name, value in values.items()),
        None,
        tuple(_clauses(entry.mapping("clauses").entries())),
        (entry.optional("execution") or "").rpartition(":")[2],
    )


def _clauses(entries: Iterable[_Reader]) -> Iterator[ImportedClause]:
    causes, found = Causes(), list[ImportedClause]()
    for position, entry in enumerate(entries):
        judged, clause = _clause(entry)
        because = causes.add(position, title(entry.text("name", ""), clause.sentence), judged)
        if because is not None:
            cause = ImportedCause(found[because.position].iri, because.position, because.words)
            clause = replace(clause, because=cause)
        found.append(clause)
        yield clause


def _clause(entry: _Reader) -> tuple[ClauseJudged, ImportedClause]:
    verdict = entry.text("verdict")
    if verdict not in _VERDICTS:
        raise BrokenResults(f"{entry.path}.verdict: expected one of {', '.join(_VERDICTS)}, got '{verdict}'")
    robustness, at = entry.measure("robustness"), entry.measure("at")
    reason, cause = entry.text("reason", ""), entry.text("cause", "")
    judged = ClauseJudged(0, 0, verdict, robustness, entry.text("unit", ""), at, reason, cause=cause)
    sentence = plain_sentence(entry.text("sentence"))
    return judged, ImportedClause(
        entry.text("iri"),
        sentence,
        verdict,
        margin(judged.robustness, judged.unit),
        verdict_words(judged),
        failure_words(judged),
    )


@dataclass(frozen=True, slots=True)
class _Reader:
    """A value of a JSON document, with its path in the document for error messages."""

    path: str
    value: object

    def mapping(self, name: str) -> _Reader:
        path = f"{self.path}.{name}".lstrip(".")
        found = self._object()
        if name not in found:
            raise BrokenResults(f"{path}: missing: is this what robbdd run --json wrote?")
        return _Reader(path, found[name])

    def entries(self) -> Iterator[_Reader]:
        value = self.value
        if not isinstance(value, list):
            raise BrokenResults(f"{self.path}: expected a list")
        for number, entry in enumerate(cast("list[object]", value)):
            yield _Reader(f"{self.path}[{number}]", entry)

    def items(self) -> Iterator[tuple[str, object]]:
        yield from self._object().items()

    def text(self, name: str, otherwise: str | None = None) -> str:
        return self._of(name, (str,), "a text", otherwise)

    def optional(self, name: str) -> str | None:
        return self._of(name, (str, type(None)), "a text or null", None) if name in self._object() else None

    def number(self, name: str) -> int:
        return self._of(name, (int,), "a whole number", None)

    def measure(self, name: str) -> float | None:
        found = self._of(name, (int, float, type(None)), "a number or null", None)
        return None if found is None else float(found)

    def _object(self) -> dict[str, object]:
        value = self.value
        if not isinstance(value, dict):
            raise BrokenResults(f"{self.path or 'the file'}: expected an object, as robbdd run --json writes it")
        return cast("dict[str, object]", value)

    def _of(self, name: str, kinds: tuple[type[Any], ...], wanted: str, otherwise: Any) -> Any:
        if otherwise is not None and name not in self._object():
            return otherwise
        found = self.mapping(name)
        if not isinstance(found.value, kinds) or isinstance(found.value, bool):
            raise BrokenResults(f"{found.path}: expected {wanted}")
        return found.value


def _from_junit(text: str) -> list[ImportedScenario]:
    try:
        root = ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        line, column = error.position
        raise BrokenResults(f"this is not well-formed XML: {error}", line, column + 1) from None
    suites = [root] if root.tag == "testsuite" else list(root.iter("testsuite"))
    if root.tag not in ("testsuite", "testsuites"):
        raise BrokenResults(f"this is not JUnit XML: its element is <{root.tag}>, not <testsuites>")
    cases = [(suite.get("name", ""), case) for suite in suites for case in suite.findall("testcase")]
    found = [scenario for story, case in cases if (scenario := _case(story, case)) is not None]
    if cases and not found:
        raise BrokenResults("these test results are not from robbdd: no test case names a scenario")
    return found


def _case(story: str, case: ElementTree.Element) -> ImportedScenario | None:
    named = _CASE.fullmatch(case.get("name", ""))
    if named is None:
        return None
    clauses = tuple(map(_described, _CLAUSE.finditer(case.findtext("system-out", ""))))
    values, seconds = named["values"] or "", _seconds(case.get("time"))
    execution = case.get("classname", "").partition(".")[2]
    return ImportedScenario("", story, named["variant"], int(named["number"]), values, seconds, clauses, execution)


def _described(found: re.Match[str]) -> ImportedClause:
    verdict = next(str(outcome) for outcome, sign in SIGNS.items() if sign == found["sign"])
    measured = _MARGIN.match(found["said"])
    said = f"{found['sign']}{found['said']}"
    words = found["said"].strip()
    state, _, reason = words.partition(": ")
    if state.endswith("(decided by"):
        state, reason = words, ""
    if verdict == Outcome.VIOLATED:
        state = " ".join(filter(None, (verdict, "by" * bool(measured), state)))
    failure = "" if verdict == Outcome.HOLDS else reason_first(state, reason)
    margin_words = measured[1] if measured else ""
    because = ImportedCause(None, None, words) if _CONSEQUENCE.match(words) else None
    return ImportedClause(None, found["sentence"], verdict, margin_words, said, failure, because)


def _seconds(text: str | None) -> float | None:
    try:
        return None if text is None else float(text)
    except ValueError:
        return None


def _local(iri: str) -> str:
    return iri.replace("#", "/").rsplit("/", 1)[-1]
