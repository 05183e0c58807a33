"""Reading a text can be left in its middle, and taken up again."""

import pytest

from kit import MODEL
from robbdd_tools.base.checkpoint import Abandoned, watched
from robbdd_tools.syntax.parse import forget_declarations, parse_declaration

LONG_SET = f"const set (ns=t) numbers {{ {', '.join(map(str, range(100)))} }}"
TEMPLATE = MODEL[MODEL.index("Scenario Template") : MODEL.index("User Story")]
STORY = MODEL[MODEL.index("User Story") :]


class LeaveAt:
    """Leaves work at one of its checkpoints."""

    def __init__(self, last: int) -> None:
        self.left = last

    def __call__(self) -> None:
        """Count down."""
        self.left -= 1
        if self.left == 0:
            raise Abandoned


@pytest.mark.parametrize("text", [LONG_SET, TEMPLATE, STORY], ids=["set", "template", "story"])
def test_a_text_that_was_left_at_any_checkpoint_is_read_as_if_never_begun(text: str) -> None:
    forget_declarations()
    expected = parse_declaration("bdd", text)
    left = 0
    for checkpoints in range(1, 40):
        forget_declarations()
        with watched(LeaveAt(checkpoints)):
            try:
                parse_declaration("bdd", text)
            except Abandoned:
                left += 1
        found = parse_declaration("bdd", text)
        assert found.tree == expected.tree
        assert list(found.references) == list(expected.references)
        assert found.faults == expected.faults
    assert left > 5


def test_a_text_may_be_read_at_a_checkpoint_inside_of_another() -> None:
    forget_declarations()
    expected = parse_declaration("bdd", TEMPLATE).tree
    forget_declarations()
    found: list[object] = []

    def read_another() -> None:
        if not found:
            found.append(None)
            found.append(parse_declaration("bdd", TEMPLATE).tree)

    with watched(read_another):
        assert parse_declaration("bdd", LONG_SET).faults == ()
    assert found == [None, expected]
