"""A clause on an event without an emitter is reported at the event, with the available events."""

from __future__ import annotations

import pytest

from checks.models import found
from kit import DOCS, EVENTS, SCENE, STORY, TEMPLATE
from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.catalog.registry import load_catalog

CODE = "no-emitter"
DECLARED = EVENTS + "Event (ns=t) {}\n"
VARIANT_THEN = "Then: later: holds(<fetch.part> is located at <fetch.goal>, after <{}>) variation:"


def waiting(event: str) -> str:
    """A model whose template waits for an event."""
    return DECLARED.format(event) + TEMPLATE.replace("after <place-end>)", f"after <{event}>)") + STORY


def test_an_unemitted_event_is_reported_where_a_clause_waits_for_it() -> None:
    text = waiting("parked")
    (finding,) = found(text, CODE)
    assert text[finding.span.start : finding.span.end] == "parked"
    assert finding.severity is Severity.WARNING
    for name in ("start", "end", "pick-start", "place-end", "pick-end", "place-start"):
        assert f"'{name}'" in finding.message
    renamed = [fix.edits[0].text for fix in finding.fixes if fix.title.startswith("Change to")]
    assert set(renamed) <= {"start", "end", "pick-start", "place-end"}
    assert len(renamed) == 3


@pytest.mark.parametrize("moment", ["pick-start", "pick-end", "place-start", "place-end"])
def test_a_fix_lets_the_behaviour_emit_the_event(moment: str) -> None:
    text = waiting("parked")
    (finding,) = found(text, CODE)
    (fix,) = [fix for fix in finding.fixes if f"emits {moment} as" in fix.title]
    (edit,) = fix.edits
    fixed = text[: edit.span.start] + edit.text + text[edit.span.end :]
    assert f"places at <goal> emits {moment} as <parked>" in fixed
    assert found(fixed, "syntax", CODE) == []


def test_no_fix_lets_a_template_of_another_file_emit_an_event_that_it_may_not_know() -> None:
    imported = f"//- template.bdd\n{EVENTS}{TEMPLATE}"
    story = DECLARED.format("parked").replace(EVENTS, "") + STORY.replace("variation:", VARIANT_THEN.format("parked"))
    main = f'//- main.bdd\nimport "template.bdd"\nimport "lab.scene"\nns t = \'https://example.org/t/\'\n{story}'
    (finding,) = found(f"{main}{imported}//- lab.scene\n{SCENE}", CODE)
    assert [fix.title for fix in finding.fixes if "emit" in fix.title] == []


@pytest.mark.parametrize("event", ["evt-pick-end", "E_PLACE_START", "pickEnd", "pick_ended", "PlaceStarted"])
def test_events_of_the_behaviour_are_emitted_by_name(event: str) -> None:
    assert found(waiting(event), CODE) == []


def test_a_name_that_fits_several_behaviours_of_a_when_needs_emits() -> None:
    lasting = "duration: from <pick-start> until <place-end>"
    other = f"then Behaviour (ns=t) more {{ {lasting} <robot> picks <part> }}\n    Then:"
    text = waiting("evt-pick-end").replace("Then:", other, 1)
    (finding,) = found(text, "syntax", CODE)
    assert finding.message.startswith("several behaviours of the When emit 'pick-end'")
    assert "'emits pick-end as <evt-pick-end>'" in finding.message
    stated = text.replace("picks <part> }", "picks <part> emits pick-end as <evt-pick-end> }")
    assert found(stated, "syntax", CODE) == []
    assert found(text.replace("<evt-pick-end>", "<place-end>"), "syntax", CODE) == []


def test_durations_emit_their_events_whatever_their_names() -> None:
    text = waiting("parked").replace("from <pick-start> until <place-end>", "from <pick-start> until <parked>")
    assert found(text, CODE) == []


def test_an_event_of_a_behaviour_that_the_scenario_does_not_have_is_not_emitted() -> None:
    text = waiting("place_begin").replace("place_begin", "place-start").replace(" and places at <goal>", "")
    (finding,) = found(text, CODE)
    assert "'pick-start', 'pick-end', under" in finding.message


def test_clauses_of_a_variant_refer_to_what_its_template_emits() -> None:
    for event, count in (("parked", 1), ("evt-pick-end", 0), ("place-end", 0)):
        declared = "" if event == "place-end" else f"Event (ns=t) {event}\n"
        text = EVENTS + declared + TEMPLATE + STORY.replace("variation:", VARIANT_THEN.format(event))
        assert [entry.code for entry in found(text, "syntax", CODE)] == [CODE] * count, event


def test_an_awaited_event_must_be_emitted() -> None:
    text = DECLARED.format("door-open") + TEMPLATE.replace(
        "        Behaviour", "        event <door-open> occurs\n        Behaviour"
    )
    assert [entry.code for entry in found(text + STORY, "syntax", CODE)] == [CODE]


def test_the_page_lists_the_events_of_the_catalog() -> None:
    page = (DOCS / "semantics.md").read_text(encoding="utf-8")
    for behaviour in load_catalog().behaviours.values():
        assert f"| `{behaviour.name}` | {', '.join(f'`{event}`' for event in behaviour.events)} |" in page


PARTS = """    for all (var x in <parts>) {
        When: Behaviour (ns=t) load { duration: from <pick-start> until <place-end> <robot> picks <part> }
    }
    When:
        event <EVENT> occurs
        Behaviour (ns=t) unload { duration: from <pick-start> until <end> <robot> picks <part> }
"""


@pytest.mark.parametrize(
    ("event", "count"), [("place-end", 1), ("pick-start", 0), ("start", 0), ("end", 0), ("parked", 0)]
)
def test_an_event_of_another_part_is_never_awaited(event: str, count: int) -> None:
    begin, end = TEMPLATE.index("    When:"), TEMPLATE.index("    Then:")
    parts = PARTS.replace("EVENT", event)
    template = TEMPLATE[:begin] + parts + TEMPLATE[end:]
    template = template.replace("    Given:", "    event parked when <part> is at rest\n    Given:", 1)
    findings = found(f"//- main.bdd\n{EVENTS}{template}{STORY}//- lab.scene\n{SCENE}", "no-emitter")
    assert [one.message.partition(" emits ")[2].split("'")[1] for one in findings] == [event] * count
