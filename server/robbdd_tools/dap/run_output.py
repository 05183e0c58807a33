"""Messages of a run as lines of the debug console."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.protocol.messages import ClauseJudged, LogLine, Output, UserCodeFailed
from robbdd_tools.run.report import plain_sentence, verdict_words

if TYPE_CHECKING:
    from robbdd_tools.protocol.messages import RunMessage
    from robbdd_tools.protocol.specs import ScenarioSpec


def output_of(message: RunMessage, spec: ScenarioSpec) -> Iterator[tuple[str, str]]:
    """Yield the lines that describe a message, each with its category in the protocol."""
    match message:
        case ClauseJudged():
            clause = next(one for one in spec.clauses if one.line == message.line)
            yield f"{verdict_words(message, clause)}  {plain_sentence(clause.sentence)}", "console"
        case LogLine(level, text):
            yield text, "console" if level == "info" else "stderr"
        case Output(_, text):
            yield text.rstrip("\n"), "stdout"
        case UserCodeFailed(_, fault):
            yield "\n".join(fault.traceback()), "stderr"
        case _:
            return
