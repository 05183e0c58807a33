"""A set in a phrase is explained: phrases take sets as values of variables."""

from __future__ import annotations

import pytest

from checks.models import found
from kit import MODEL, SCENE

GIVEN = "on-bench: holds(<part> is located at <goal>, before <pick-start>)"


@pytest.mark.parametrize(("name", "kind"), [("places", "a workspace set"), ("parts", "an object set")])
def test_the_message_leads_to_a_set_variable(name: str, kind: str) -> None:
    text = MODEL.replace(GIVEN, f"on-bench: holds(<{name}> are sorted into <goal>, before <pick-start>)")
    (one,) = found(f"//- main.bdd\n{text}//- lab.scene\n{SCENE}", "wrong-kind")
    assert one.message == (
        f"'{name}' is {kind}, but a variable belongs here: declare a 'set var', whose values are '{{ {{ … }} }}' or "
        f"'select N combinations from <{name}>'"
    )


def test_other_names_are_only_named() -> None:
    text = MODEL.replace(GIVEN, "on-bench: holds(<part> is located at <start>, before <pick-start>)")
    (one,) = found(f"//- main.bdd\n{text}//- lab.scene\n{SCENE}", "wrong-kind")
    assert one.message == "'start' is an event, but a variable belongs here"
