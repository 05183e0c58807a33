"""Rules about events that delimit durations."""

from checks.models import check, fixed, found, marked
from kit import MODEL
from robbdd_tools.base.diagnostic import Severity

REVERSED = marked(
    MODEL.replace("0.5 seconds after <place-end>)", "from <place-end> until <pick-start>)"),
    "«from <place-end> until <pick-start>»)",
    "contradictory-order swap the two events",
)


def test_a_duration_needs_two_events() -> None:
    text = MODEL.replace("duration: from <start> until <end>", "duration: from <start> until <start>")
    text = text.replace(
        "until <start>\n",
        "until <start>\n//            ^^^^^^^^^^^^^^^^^^^^^^^^^^ empty-duration starts and ends with 'start'\n",
    )
    text = text.replace("until <place-end>", "until <end>")
    check(text)
    assert [entry.severity for entry in found(text)] == [Severity.WARNING]


def test_events_in_contradictory_order_are_swapped() -> None:
    check(REVERSED)
    (finding,) = found(REVERSED)
    assert finding.related[0].message == "here 'pick-start' comes first"
    assert "goal>, from <pick-start> until <place-end>)" in fixed(REVERSED, "contradictory-order")


def test_a_variant_does_not_contradict_its_template() -> None:
    clause = "Then: late: holds(<fetch.part> is held by <fetch.robot>, from <end> until <start>)\n variation:"
    (finding,) = found(MODEL.replace("variation:", clause))
    assert finding.code == "contradictory-order"
    assert finding.related[0].message == "here 'start' comes first"


def test_other_templates_have_an_order_of_their_own() -> None:
    other = """Scenario Template (ns=t) later {
    duration: from <end> until <start>
    task: <task>
    var robot
    var part
    When: Behaviour (ns=t) later-carry { duration: from <place-end> until <pick-start> <robot> picks <part> }
}
"""
    check(MODEL + other)


def test_events_inside_a_for_all_come_again() -> None:
    text = """Event (ns=t) go
Event (ns=t) stop
Scenario Template (ns=t) loop {
    duration: from <start> until <end>
    task: <task>
    set var things
    var arm
    for all ( var x in <things> ) {
        When: Behaviour (ns=t) lift { duration: from <go> until <stop> <arm> picks <x> }
        Then: free: holds(<arm> can reach <x>, from <stop> until <go>)
    }
}
"""
    check(MODEL + text)
