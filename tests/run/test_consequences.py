"""Of several clauses that are unknown for one reason, one has the reason, and the others name it."""

from __future__ import annotations

from robbdd_tools.monitor.verdict import Cause
from robbdd_tools.protocol.messages import ClauseJudged
from robbdd_tools.run.consequences import Consequence, consequences

STUCK = "panda cannot reach a free place"


def judged(verdict: str, reason: str = "", cause: str = "") -> ClauseJudged:
    return ClauseJudged(0, 5, verdict, None, "", None, reason, None, cause=cause)


def words(*clauses: tuple[str, ClauseJudged]) -> list[str]:
    return ["" if found is None else found.words for found in consequences(clauses)]


def test_clauses_that_wait_for_what_a_behaviour_did_not_reach_are_consequences_of_it() -> None:
    found = words(
        *[
            ("at-source", judged("holds")),
            ("carry", judged("violated", STUCK)),
            ("in-hand", judged("unknown", f"event evt-pick-end never occurred: {STUCK}", Cause.NO_EVENT)),
            ("at-goal", judged("unknown", STUCK, Cause.UNREACHED)),
        ]
    )
    assert found == ["", "", "unknown because of carry", "unknown for the same reason as carry"]


def test_the_first_clause_that_is_unknown_for_a_reason_has_it() -> None:
    late = judged("unknown", "it timed out", Cause.TIMED_OUT)
    found = words(("in-hand", late), ("at-goal", late), ("in-hand", late))
    assert found == ["", "unknown for the same reason as in-hand", ""]


def test_reasons_of_another_type_and_violations_are_their_own_cause() -> None:
    found = words(
        *[
            ("carry", judged("unknown", STUCK, Cause.SIMULATION)),
            ("seen", judged("unknown", STUCK, Cause.UNOBSERVED)),
            ("recorded", judged("unknown", f"no record: {STUCK}", Cause.NO_RECORD)),
            ("at-goal", judged("violated", STUCK)),
            ("free", judged("unknown")),
            ("open", judged("unknown")),
        ]
    )
    assert found == ["", "", "", "", "", ""]


def test_a_consequence_has_the_number_and_the_name_of_its_cause() -> None:
    late = judged("unknown", STUCK, Cause.UNREACHED)
    found = list(
        consequences([("at-source", judged("holds")), ("carry", judged("violated", STUCK)), ("at-goal", late)])
    )
    assert found == [None, None, Consequence(1, "carry", same_reason=True)]
