"""Writes ``docs/time.md`` and its pictures: ``.venv/bin/python docs/site/time_page.py``.

Each clause of the page is judged by the monitor and drawn as the editors draw it.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path

import numpy as np

from robbdd_tools.judging.decisions import decide
from robbdd_tools.judging.margin_curves import curves
from robbdd_tools.judging.parsed_sentences import read_clause
from robbdd_tools.monitor.trace import EventStamp, Trace
from robbdd_tools.run.plot import plot
from robbdd_tools.run.report import SIGNS, margin

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "time.md"
PICTURES = ROOT / "docs" / "images" / "time"
STEP = 0.02
"""Seconds between samples of the drawn trace."""
WAY = np.array(
    [(0.0, 0.5), (1.8, 0.5), (3.2, 0.12), (4.0, 0.04), (5.4, 0.04), (5.6, 0.18), (6.0, 0.18), (6.2, 0.06), (9.0, 0.06)]
)
"""The distance (m) of the part from the bin at some times (s), linear between them."""
EVENTS = (("pick-end", 1.6), ("place-start", 2.8), ("place-end", 4.2), ("bell", 4.8), ("bell", 5.8))
NEAR = '"part" is nearer than "0.1 m" to "bin"'
FAST = '"part" moves slower than "0.2 m/s"'
HEAD = """# Time in clauses

Each picture shows one clause, judged on the same nine seconds: a part waits, is carried to a bin, arrives after 4 s, is
bumped away at 5.5 s, and returns. In most of them, the curve is the margin of *the part is nearer than 0.1 m to the
bin*: above zero, the predicate holds. The window of the clause is shaded, and the dot is the sample that decides.
`pick-end` occurs at 1.6 s, and `place-end` at 4.2 s.
[semantics.md](semantics.md#windows) has the rules. `docs/site/time_page.py` judges the clauses and writes this page.
"""
SECTIONS: Mapping[str, tuple[str, tuple[tuple[str, str, str], ...]]] = {
    "At one instant": (
        "Without a duration, one sample decides: the last one at or before the event, or the first one at or after it.",
        (
            ("before", NEAR, 'before event "place-end"'),
            ("after", NEAR, 'after event "place-end"'),
        ),
    ),
    "Throughout": (
        "With a duration, or between two events, every sample of the window counts. The margin of\n"
        "the clause is the smallest margin in the window, so a short disturbance is enough to violate the clause.",
        (
            ("seconds-before", NEAR, 'for 0.3 seconds before event "place-end"'),
            ("seconds-after", NEAR, 'for 2 seconds after event "place-end"'),
            ("from-until", NEAR, 'from "pick-end" until "place-end"'),
        ),
    ),
    "At some time": (
        "One sample of the window suffices. The margin of the clause is the largest margin in the window. Use this\n"
        "form for deadlines. The time is the first at which the predicate held.",
        (
            ("within-after", NEAR, 'at some time within 3 seconds after event "pick-end"'),
            ("within-too-short", NEAR, 'at some time within 1.5 seconds after event "pick-end"'),
            ("some-time-from", NEAR, 'at some time from "pick-end" until "place-end"'),
        ),
    ),
    "Which occurrence": (
        "The bell rings at 4.8 s and at 5.8 s. `every` judges the clause at each occurrence, and it must\n"
        "hold at all of them.",
        (
            ("first", NEAR, 'after the first event "bell"'),
            ("last", NEAR, 'for 0.5 seconds after the last event "bell"'),
            ("every", NEAR, 'after every event "bell"'),
        ),
    ),
    "Only while something else holds": (
        "`whenever` leaves out the samples at which its condition does not hold. The margin is still that of the\n"
        "predicate. The part is fast on its way, and slow near the bin.",
        (
            ("whenever", f"{FAST} whenever {NEAR}", 'from "pick-end" until "place-end"'),
            ("unconditional", FAST, 'from "pick-end" until "place-end"'),
        ),
    ),
    "No window": (
        "If the window does not exist, or the execution ends before it closes, the clause is unknown. It never counts\n"
        "as passed.",
        (
            ("never", NEAR, 'after event "door-open"'),
            ("too-late", NEAR, 'for 20 seconds after event "place-end"'),
            ("reversed", NEAR, 'from "place-end" until "pick-end"'),
        ),
    ),
}
WRITTEN = (
    (re.compile(r"for ([\d.]+) seconds"), r"\1 seconds"),
    (re.compile("at some time within"), "within"),
    (re.compile(r'event "([\w-]+)"'), r"<\1>"),
    (re.compile(r'"(part|bin)"'), r"<\1>"),
    (re.compile(r'(from|until) "([\w-]+)"'), r"\1 <\2>"),
    (re.compile(r'"([\d.]+ [\w/]+)"'), r"\1"),
)
"""From a Gherkin sentence to the text of a model."""


def trace() -> Trace:
    """Return the execution that all clauses of the page are judged on."""
    times = np.arange(0.0, 9.0 + STEP / 2, STEP)
    positions = np.zeros((len(times), 2, 3))
    positions[:, 0, 0] = np.interp(times, WAY[:, 0], WAY[:, 1])
    orientations = np.tile([1.0, 0.0, 0.0, 0.0], (len(times), 2, 1))
    stamps = tuple(EventStamp(name, time) for name, time in EVENTS)
    return Trace(("part", "bin"), times, positions, orientations, events=stamps)


def page(pictures: dict[str, str]) -> str:
    """Return the text of the page, and add its pictures by their names."""
    lines = [HEAD]
    for title, (words, clauses) in SECTIONS.items():
        lines += [f"## {title}", "", words, ""]
        for name, predicate, time in clauses:
            lines += shown(name, predicate, time, pictures)
    return "\n".join(lines)


def shown(name: str, predicate: str, time: str, pictures: dict[str, str]) -> list[str]:
    """Return the lines of one clause: its text in a model, its verdict, its picture."""
    clause, execution = read_clause(f"{predicate} {time}"), trace()
    verdict = decide(clause, execution, {}, {event for event, _ in EVENTS} | {"door-open"})
    said = " ".join(filter(None, (SIGNS[verdict.outcome], verdict.outcome, margin(verdict.robustness, verdict.unit))))
    when = "" if verdict.at is None else f", at {verdict.at:.2f} s"
    reason = verdict.reason and f": {verdict.reason}"
    lines = ["```text", f"holds({written(predicate)}, {written(time)})", "```", "", f"{said}{when}{reason}", ""]
    kept = {
        "duration": execution.end,
        "events": [{"name": event, "time": at} for event, at in EVENTS],
        "clauses": {"1": [asdict(one) for one in curves(clause, execution, {})]},
    }
    picture = plot(kept, 1)
    if picture is not None:
        pictures[f"{name}.svg"] = f"{picture}\n"
        lines += [f"![{said}](images/time/{name}.svg)", ""]
    return lines


def written(sentence: str) -> str:
    """Return a part of a Gherkin sentence as a model states it."""
    for found, words in WRITTEN:
        sentence = found.sub(words, sentence)
    return sentence


if __name__ == "__main__":
    found: dict[str, str] = {}
    PAGE.write_text(page(found), encoding="utf-8")
    PICTURES.mkdir(exist_ok=True)
    for place, text in found.items():
        (PICTURES / place).write_text(text, encoding="utf-8")
