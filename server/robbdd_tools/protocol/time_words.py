"""Write and read time constraints in the sentences of Gherkin steps.

The wording has a version, because a sentence must never have two meanings. Wording 1 wrote "within 8 seconds after" if
a predicate must hold throughout the 8 seconds. Wording 2 writes "for 8 seconds after" instead, and "at some time within
8 seconds after" if a predicate must hold only at some time.
"""

from __future__ import annotations

import re

from robbdd_tools.monitor.time import After, Before, During, TimeConstraint

WORDING = 2
"""The version of the sentences that this version of RobBDD writes."""
FIRST_WORDING = 1
"""The version of a feature that does not state its version."""
HEADER = f"# wording: {WORDING}"
"""The line of a feature that states the version of its sentences."""
TIME = (
    r"(?:(?:(?P<lead>for|at some time within|within) (?P<horizon>\d+(?:\.\d+)?(?:e[+-]?\d+)?) seconds )?"
    r'(?P<relation>before|after) (?:(?:the )?(?P<which>first|last|every) )?event "(?P<event>[^"]*)"'
    r'|(?P<some>at some time )?from "(?P<start>[^"]*)" until "(?P<end>[^"]*)")'
)
"""A time constraint at the end of a sentence, in any wording."""
AMBIGUOUS = re.compile(r'(?<!at some time )\bwithin (?P<horizon>\S+) seconds (?P<relation>before|after) event "')
"""A time constraint of wording 1 that has another meaning in plain English."""
_HEADER = re.compile(r"\s*#\s*wording:\s*(\d+)\s*")


def wording_of(feature: str) -> int:
    """Return the version of the sentences of a feature, which a comment before the line ``Feature:`` states."""
    for line in feature.splitlines():
        if (match := _HEADER.fullmatch(line)) is not None:
            return int(match[1])
        if line.strip() and not line.lstrip().startswith(("#", "@")):
            break
    return FIRST_WORDING


def time_words(constraint: TimeConstraint) -> str:
    """Return a time constraint as the end of a sentence. Events are written as they are named in the constraint."""
    match constraint:
        case During(start, end):
            return interval_words(start, end, constraint.some_time)
        case Before(event, horizon):
            return instant_words("before", event, _seconds(horizon), constraint.some_time, constraint.which)
        case After(event, horizon):
            return instant_words("after", event, _seconds(horizon), constraint.some_time, constraint.which)


def interval_words(start: str, end: str, some_time: bool) -> str:
    """Return the words for an interval between two events."""
    return f'{"at some time " if some_time else ""}from "{start}" until "{end}"'


def occurrence_words(which: str | None) -> str:
    """Return the words before an event that select its occurrences; empty if none are selected."""
    return "" if not which else f"{which} " if which == "every" else f"the {which} "


def instant_words(relation: str, event: str, seconds: str | None, some_time: bool, which: str | None = "") -> str:
    """Return the words for a constraint ``before`` or ``after`` an event, with its horizon as text if it has one."""
    lead = "" if seconds is None else f"{'at some time within' if some_time else 'for'} {seconds} seconds "
    return f'{lead}{relation} {occurrence_words(which)}event "{event}"'


def constraint_of(match: re.Match[str]) -> TimeConstraint:
    """Return the time constraint of a match of ``TIME``. The words of wording 1 mean *throughout*."""
    if match["start"] is not None:
        return During(match["start"], match["end"], some_time=match["some"] is not None)
    horizon = float(match["horizon"]) if match["horizon"] is not None else None
    kind = Before if match["relation"] == "before" else After
    some_time = match["lead"] == "at some time within"
    return kind(match["event"], horizon, some_time=some_time, which=match["which"] or "")


def _seconds(horizon: float | None) -> str | None:
    return None if horizon is None else repr(horizon).removesuffix(".0")
