"""Find out whether a log has more than one execution of a scenario."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.catalog.coordination import each_emitter
from robbdd_tools.judging.scenario_clauses import iteration_of, statement_of
from robbdd_tools.logs.log_names import occurrences_of
from robbdd_tools.protocol.clauses import BehaviourCall

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robbdd_tools.logs.log_contents import TextStamp
    from robbdd_tools.protocol.specs import ScenarioSpec


class SeveralExecutions(RobbddError):
    """A log has more than one execution of a scenario; the message says when the second one begins."""


def check_one_execution(spec: ScenarioSpec, texts: Sequence[TextStamp]) -> None:
    """Raise ``SeveralExecutions`` if a log reports the start of the behaviour again after its end.

    Only the first execution would be judged. Scenarios with several behaviours or iterations are not checked, because
    even one execution reports events more than once.
    """
    when = [(statement_of(clause), clause) for clause in spec.clauses]
    calls = [(one, clause) for one, clause in when if isinstance(one, BehaviourCall)]
    if len(calls) != 1 or spec.node or iteration_of(calls[0][1]):
        return
    behaviour = calls[0][0].behaviour
    first, last = behaviour.events[0], behaviour.events[-1]
    ends = _times(spec, last, texts)
    again = [time for time in _times(spec, first, texts) if ends and time > ends[0]]
    if not again or first == last:
        return
    words = f"the log reports '{first}' again at {again[0]:.2f} s, after '{last}' at {ends[0]:.2f} s"
    middle = (ends[0] + again[0]) / 2
    raise SeveralExecutions(
        f"{words}: it has more than one execution; choose one with --from SECONDS and --until SECONDS, for example "
        f"--until {middle:.1f}, or state --from 0 if all of it is one"
    )


def _times(spec: ScenarioSpec, emitter: str, texts: Sequence[TextStamp]) -> list[float]:
    names = [event for event, source in spec.events.items() if emitter in each_emitter(source)] or [emitter]
    return sorted({one.time for name in names for one in occurrences_of(name, emitter, texts)})
