"""A behaviour, which has no name in a model, has words in the results of a study, and is found by them."""

import pytest

from robbdd_tools.campaign.study_clauses import clause_named, clause_words

WORDS = {
    "in-bin": "in-bin",
    "and-tidy.then.0": "and-tidy.then.0",
    "when-bhv": "when-bhv",
    "when-bhv-tidy.when": "behaviour of tidy",
    "when-bhv-tidy-up.when2": "behaviour 2 of tidy-up",
    "when-bhv-tidy.all.when": "behaviour of tidy (all)",
    "when-bhv-tidy.2.all.when3": "behaviour 3 of tidy (2.all)",
}


@pytest.mark.parametrize(("name", "words"), WORDS.items())
def test_a_behaviour_is_named_by_its_template(name: str, words: str) -> None:
    assert clause_words(name) == words
    assert clause_named(words, WORDS) == name
    assert clause_named(name, WORDS) == name


def test_other_words_are_no_clause() -> None:
    assert clause_named("behaviour of nothing", WORDS) is None


def test_behaviours_have_different_words() -> None:
    assert len({clause_words(name) for name in WORDS}) == len(WORDS)
