"""Wording of verdicts, shared by the command line and editors."""

from __future__ import annotations

import re
from math import floor, isfinite, log10
from typing import cast

from robbdd_tools.gherkin.steps import sentence
from robbdd_tools.monitor.contact import Contact
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.protocol.clauses import Junction, fluents_of
from robbdd_tools.protocol.messages import ClauseJudged
from robbdd_tools.protocol.specs import ClauseSpec, ScenarioSpec

SIGNS = {Outcome.HOLDS: "✔", Outcome.VIOLATED: "✗", Outcome.UNKNOWN: "?"}
MINUS = "−"
MOST_DECIMALS = 6
"""A number that needs more decimals is written with an exponent."""


def plain_sentence(text: str) -> str:
    """Return a step's sentence for display: names without prefixes and quotes, and without the word ``event``."""
    without_event = text.replace('event "', '"')
    return re.sub(r'"([^"]*)"', lambda match: re.sub(r"'?[\w.-]+:([^,'\]]*)'?", r"\1", match[1]), without_event)


def contact_words(contact: Contact) -> str:
    """Return a contact as text: who touched what, when, and how hard."""
    agent, part, other = (name.rpartition(":")[2] for name in (contact.agent, contact.part, contact.other))
    who = f"{part}, held by {agent}," if part else agent
    whom = "itself" if other == agent else other
    strength = f"at most {contact.peak:.1f} N at {contact.peak_time:.2f} s, {contact.impulse:.2f} N s"
    return f"{who} touches {whom} at {contact.time:.2f} s: {strength}"


def margin(robustness: float | None, unit: str) -> str:
    """Return a margin with its sign and unit; empty if there is no unit.

    A margin in metres is written in millimetres; other units are unchanged. Small margins keep two digits that are not
    zero (millimetres), or three.
    """
    if robustness is None or not unit:
        return ""
    value, shown, digits = (robustness * 1000.0, "mm", 2) if unit == "m" else (robustness, unit, 3)
    return f"{MINUS if value < 0 else '+'}{_rounded(abs(value), digits)} {shown}"


def _rounded(value: float, digits: int) -> str:
    """Return a number of at least 0 with this many significant digits, but with all digits before the point."""
    if value == 0 or not isfinite(value):
        return f"{value:.1f}"
    decimals = digits - 1 - floor(log10(value))
    return f"{value:.{max(decimals, 0)}f}" if decimals <= MOST_DECIMALS else f"{value:.{digits - 1}e}"


def deciding_words(clause: ClauseSpec, judged: ClauseJudged) -> str:
    """Return a text that names the fluent that decided the verdict; empty if the clause has only one fluent."""
    statement = clause.statement
    if judged.operand is None or not isinstance(statement, Junction):
        return ""
    # The judged sentence may have been edited by hand.
    fluents = list(fluents_of(statement))
    known = 1 < len(fluents) > judged.operand
    return f"decided by: {plain_sentence(sentence(fluents[judged.operand]))}" if known else ""


def verdict_words(judged: ClauseJudged, clause: ClauseSpec | None = None) -> str:
    """Return the verdict of a clause as text: its sign and its margin.

    The text of a violated clause also has the deciding fluent and the reason.
    """
    outcome = Outcome(judged.verdict)
    parts = [SIGNS[outcome]]
    shown = margin(judged.robustness, judged.unit)
    if shown:
        parts.append(shown)
    if outcome is Outcome.VIOLATED and judged.at is not None:
        parts.append(f"at {judged.at:.2f} s")
    if outcome is Outcome.UNKNOWN:
        parts.append("unknown")
    decided = "" if clause is None else deciding_words(clause, judged)
    return ": ".join(filter(None, (" ".join(parts), judged.reason))) + (f" ({decided})" if decided else "")


def failure_words(judged: ClauseJudged, clause: ClauseSpec | None = None) -> str:
    """Return why a clause is violated or unknown, the reason first; empty if it holds.

    For example ``panda cannot reach a free place (violated)`` or ``violated by −12 mm at 3.20 s``.
    """
    outcome = Outcome(judged.verdict)
    if outcome is Outcome.HOLDS:
        return ""
    shown = margin(judged.robustness, judged.unit)
    measured = [f"by {shown}"] * bool(shown)
    if outcome is Outcome.VIOLATED and judged.at is not None:
        measured.append(f"at {judged.at:.2f} s")
    decided = "" if clause is None else deciding_words(clause, judged)
    return reason_first(" ".join((outcome, *measured)), "; ".join(filter(None, (judged.reason, decided))))


def reason_first(state: str, reason: str) -> str:
    """Return a state as one line. A reason, if there is one, comes first."""
    return f"{' '.join(reason.split())} ({state})" if reason else state


def values_words(spec: ScenarioSpec) -> str:
    """Return the values of a scenario as text, for example ``thing = cube0, goal = left_ws``."""
    return ", ".join(value_words(name, value) for name, value in spec.values.items())


def value_words(name: str, value: object) -> str:
    """Return a variable and its value as text, for example ``thing = cube0``. Both arguments have their prefix."""
    return f"{variable_word(name)} = {value_word(value)}"


def variable_word(name: str) -> str:
    """Return the name of a variable as written in its template."""
    return name.rsplit(":", 1)[-1].removeprefix("var-")


def value_word(value: object) -> str:
    """Return a value as text, without its prefix."""
    if isinstance(value, list):
        return "{" + ", ".join(value_word(entry) for entry in cast(list[object], value)) + "}"
    return value.rsplit(":", 1)[-1] if isinstance(value, str) else str(value)
