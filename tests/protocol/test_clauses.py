"""What clauses state, written to JSON and read back."""

from __future__ import annotations

from typing import Any

import pytest

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.monitor.time import After, During
from robbdd_tools.protocol.clauses import (
    AnyOf,
    BehaviourCall,
    EventOccurrence,
    Fluent,
    Junction,
    Statement,
    Text,
    fluents_of,
    from_plain,
    leaves_of,
    to_plain,
)

LOCATED = load_catalog().predicates["located-at"]
AT = Fluent(LOCATED, {"object": ("t:a", "t:b"), "workspace": AnyOf(("t:x",))}, After("t:e", 0.5), "t:c", {"n": [1]})
GREEN = Text("the lamp is green", During("t:a", "t:b"), "t:d")
PICK = BehaviourCall(load_catalog().behaviours["pick"], {"agent": "t:arm", "object": "t:a"})


@pytest.mark.parametrize("statement", [AT, GREEN, Text("green"), Junction("not", (AT,)), PICK, EventOccurrence("t:e")])
def test_a_statement_is_read_back_as_it_was_written(statement: Statement) -> None:
    assert from_plain(to_plain(statement)) == statement


@pytest.mark.parametrize(
    "data",
    [
        {},
        {"predicate": "located-at", "arguments": {}, "time": None},
        {"predicate": "no-such-word", "arguments": {}, "time": {"after": "t:e", "horizon": None}},
        {"operator": "xor", "operands": []},
        {"operator": "and", "operands": [{"event": "t:e"}]},
        {"text": "green", "time": {"at": "t:e"}},
    ],
)
def test_anything_else_is_refused(data: dict[str, Any]) -> None:
    with pytest.raises((KeyError, TypeError, ValueError)):
        from_plain(data)


def test_leaves_stand_in_the_order_of_the_sentence() -> None:
    clause = Junction("and", (GREEN, Junction("or", (AT, Text("green")))))
    assert list(leaves_of(clause)) == [GREEN, AT, Text("green")]
    assert list(fluents_of(clause)) == [AT]
