"""Selections are counted, listed and ranked by one rule."""

from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robbdd_tools.base.selections import SelectionRule

RULES = st.builds(SelectionRule, st.sampled_from(["combinations", "permutations"]), st.integers(1, 4), st.booleans())


@given(RULES, st.integers(0, 5))
def test_a_rule_counts_what_it_lists_and_ranks_it_in_that_order(rule: SelectionRule, available: int) -> None:
    source = "abcde"[:available]
    listed = list(rule.sets(source))
    assert rule.count(available) == len(listed)
    assert [rule.at(source, rank) for rank in range(len(listed))] == listed


@given(RULES, st.integers(0, 5))
def test_a_rule_lists_each_distinct_selection_once(rule: SelectionRule, available: int) -> None:
    source = "abcde"[:available]
    every = product(source, repeat=rule.length)
    fitting = [one for one in every if rule.repeated or len(set(one)) == len(one)]
    if rule.kind == "combinations":
        fitting = [one for one in fitting if list(one) == sorted(one)]
    assert list(rule.sets(source)) == fitting


@pytest.mark.parametrize("rank", [0, 10**29])
def test_a_set_is_found_by_its_rank_without_listing_those_before(rank: int) -> None:
    rule = SelectionRule("permutations", 20, repeated=True)
    source = range(40)
    digits = [rank // 40**place % 40 for place in range(19, -1, -1)]
    assert rule.at(source, rank) == tuple(digits)
