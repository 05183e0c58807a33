"""Our own requests refuse parameters of a wrong kind with a sentence."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from lsprotocol import types
from pygls.exceptions import JsonRpcInvalidParams

from robbdd_tools.lsp.parameters import Parameters


def given(**fields: Any) -> Parameters:
    """Parameters as pygls hands them on."""
    return Parameters(Fields(fields))


class Fields:
    """pygls' form of a JSON object, as far as used."""

    def __init__(self, fields: dict[str, Any]) -> None:
        self._fields = fields

    def _asdict(self) -> dict[str, Any]:
        return self._fields


def test_values_of_the_right_kind_are_returned() -> None:
    asked = given(uri="file:///m.bdd", most=5, run=3, position=Fields({"line": 1, "character": 2}))
    assert (asked.text("uri"), asked.optional_number("most"), asked.run()) == ("file:///m.bdd", 5, "3")
    assert asked.optional_position("position") == types.Position(1, 2)
    assert given(run="latest").run() == "latest"
    assert given(variant="x", index=None).others("variant", "index") == {"variant": "x"}


def test_what_is_left_out_is_none() -> None:
    asked = Parameters(None)
    assert asked.optional_text("uri") is None
    assert asked.optional_number("most") is None
    assert asked.optional_position("position") is None
    assert asked.run() is None


@pytest.mark.parametrize(
    ("read", "message"),
    [
        (lambda: Parameters([1]).text("uri"), "'uri' is missing: it must be a text"),
        (lambda: given(uri=7).text("uri"), "'uri' must be a text"),
        (lambda: given(most=-1).optional_number("most"), "'most' must be a whole number from 0"),
        (lambda: given(most=1.5).optional_number("most"), "'most' must be a whole number"),
        (lambda: given(most=True).optional_number("most"), "'most' must be a whole number"),
        (lambda: given(position="x").optional_position("position"), "'position' must be a position"),
    ],
)
def test_a_value_of_another_kind_is_refused(read: Callable[[], object], message: str) -> None:
    with pytest.raises(JsonRpcInvalidParams, match=message):
        read()
