"""The behaviours of a clause's iteration of ``for all``."""

from __future__ import annotations

import pytest

from robbdd_tools.gherkin.steps import Scope
from robbdd_tools.graph.acceptance_model import Iri
from robbdd_tools.run.iterations import iterations_of


def scope(*turns: int) -> Scope:
    return tuple((Iri("t:loop"), turn) for turn in turns)


@pytest.mark.parametrize(
    ("clause", "behaviours", "expected"),
    [
        ((), [(1,)], ()),
        ((), [], ()),
        ((), [(1,), (2,)], (1, 2)),
        ((1,), [(1,), (2,)], (1, 1)),
        ((2,), [(1,), (2,)], (2, 2)),
        ((2,), [(1,), (2, 1), (2, 2), (3,)], (2, 3)),
        ((2, 7), [(1,), (2,), (3,)], (2, 2)),
        ((9,), [(1,), (2,), (3,)], (1, 3)),
    ],
)
def test_a_clause_belongs_to_the_behaviours_of_the_nearest_scope_that_has_any(
    clause: tuple[int, ...], behaviours: list[tuple[int, ...]], expected: tuple[int, ...]
) -> None:
    assert iterations_of(scope(*clause), [scope(*one) for one in behaviours]) == expected
