"""Quantities must measure what their predicate compares with."""

import pytest

from checks.models import LINES, check, fixed, found, marked, story
from kit import TEMPLATE
from robbdd_tools.base.diagnostic import Severity

GIVEN = "        on-bench: holds(<part> is located at <goal>, before <pick-start>)\n"


def model(limit: str, values: str = "") -> str:
    clause = f"slow: holds(<robot> moves slower than {limit}, before <pick-start>)"
    template = TEMPLATE.replace(GIVEN, f"        ( {GIVEN.strip()} and {clause} )\n")
    if not values:
        return story(LINES, template)
    template = template.replace("var goal\n", "var goal\n    var value\n")
    return story(f"{LINES}                var <fetch.value>: {values}\n", template)


@pytest.mark.parametrize(("limit", "values"), [("0.25 m/s", ""), ("<value>", "{ 0.25 m/s, 1m/s }")])
def test_a_quantity_that_fits_is_no_finding(limit: str, values: str) -> None:
    check(model(limit, values))


def test_a_length_is_no_speed() -> None:
    check(marked(model("0.25 m"), "slower than «0.25 m»,", "quantity '0.25 m' is a length, not a speed"))
    text = model("<value>", "{ 0.25 m/s, 5 deg }")
    check(marked(text, "0.25 m/s, «5 deg» }", "quantity '5 deg' is an angle, not a speed"))


def test_a_negative_limit_decides_nothing() -> None:
    words = "quantity the limit '-0.25 m/s' is negative"
    check(marked(model("-0.25 m/s"), "slower than «-0.25 m/s»,", words))
    check(marked(model("<value>", "{ 0.25 m/s, -0.25 m/s }"), "0.25 m/s, «-0.25 m/s» }", words))
    check(model("0 m/s"))
    assert fixed(model("-0.25 m/s"), "quantity") == model("0.25 m/s")


def test_a_number_needs_a_unit() -> None:
    (entry, *_) = [one for one in found(model("<value>", "{ 0.25 }")) if one.severity is Severity.ERROR]
    assert entry.code == "type-conflict"
    assert entry.message.endswith("give it a quantity")
