"""The rooms name modules and tests that exist; samples and places follow from their arguments."""

from __future__ import annotations

import ast

import pytest
from tests.mutants.rooms import ROOMS, Room
from tests.mutants.session import ROOT, changed_line, first_line, sample

FUNCTION = """
import x


def one():
    return 1


class Two:
    def three(self):
        return 3
"""


@pytest.mark.parametrize("room", ROOMS.values(), ids=str)
def test_a_room_names_modules_and_tests_that_exist(room: Room) -> None:
    for module in room.modules:
        assert list((ROOT / "server" / "robbdd_tools" / room.name).glob(f"{module}.py")), module
    assert (ROOT / room.tests[0]).is_dir()
    for file in room.reading_source:
        assert (ROOT / room.tests[0] / file).is_file()


def test_a_sample_follows_from_its_seed_and_is_never_larger_than_the_whole() -> None:
    names = [f"m{number}" for number in range(100)]
    assert sample(names, 5, 1) == sample(names, 5, 1) != sample(names, 5, 2)
    assert len(set(sample(names, 60, 1))) == 60
    assert sample(names, None, 1) == sample(names, 200, 1) == names


def test_the_place_of_a_mutant_is_that_of_the_first_line_it_changes() -> None:
    module = ast.parse(FUNCTION)
    assert (first_line(module, "x_one"), first_line(module, "xǁTwoǁthree")) == (5, 10)
    assert changed_line("@@ -1,2 +1,2 @@\n def one():\n-    return 1\n+    return 2") == 1
    assert changed_line("@@ -4,3 +4,3 @@\n a\n b\n-c\n+d") == 5
