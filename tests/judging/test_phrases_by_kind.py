"""The elements of a scene decide between predicates whose phrases have the same words, in sentences edited by hand."""

from __future__ import annotations

import pytest

from robbdd_tools.judging.parsed_sentences import read_clause
from robbdd_tools.judging.scenario_clauses import stated_by_step
from robbdd_tools.protocol.clauses import Fluent, Junction
from robbdd_tools.protocol.specs import ClauseSpec, SceneSpec

SCENE = SceneSpec(objects=("e:box", "e:crate"), agents=("e:arm", "e:leg"), workspaces={"e:floor": ()})
TIME = 'after event "t:e"'


def read(words: str) -> Fluent:
    found = stated_by_step("then", f"{words} {TIME}", None, scene=SCENE)
    assert isinstance(found, Fluent)
    return found


@pytest.mark.parametrize("words", ["does not collide", "does not collide with"])
@pytest.mark.parametrize(
    ("subject", "predicate", "slots"),
    [
        ("e:arm", "does-not-collide", ("agent", "target")),
        ("e:box", "object-does-not-collide", ("one", "other")),
        ("['e:arm', 'e:leg']", "does-not-collide", ("agent", "target")),
        ("any of ['e:box', 'e:crate']", "object-does-not-collide", ("one", "other")),
    ],
)
def test_the_subject_decides(words: str, subject: str, predicate: str, slots: tuple[str, str]) -> None:
    found = read(f'"{subject}" {words} "e:floor"')
    assert (found.predicate.name, tuple(found.arguments)) == (predicate, slots)
    assert found.arguments[slots[1]] == "e:floor"


@pytest.mark.parametrize("subject", ["e:floor", "e:unknown", "any of ['e:arm', 'e:box']"])
def test_elements_that_no_phrase_takes_leave_the_predicate_of_the_sentence(subject: str) -> None:
    for words, predicate in (
        ("does not collide", "does-not-collide"),
        ("does not collide with", "object-does-not-collide"),
    ):
        assert read(f'"{subject}" {words} "e:floor"').predicate.name == predicate


def test_each_sentence_of_a_group_is_decided() -> None:
    parts = [f'"e:{one}" does not collide with "e:floor" {TIME}' for one in ("arm", "box")]
    found = stated_by_step("then", f"( {' or '.join(parts)} )", None, scene=SCENE)
    assert isinstance(found, Junction)
    names = [one.predicate.name for one in found.operands if isinstance(one, Fluent)]
    assert names == ["does-not-collide", "object-does-not-collide"]


def test_a_clause_of_the_manifest_keeps_its_predicate() -> None:
    sentence = f'"e:arm" does not collide with "e:floor" {TIME}'
    stated = read_clause(sentence)
    known = ClauseSpec(3, "t:c", "c", "then", sentence, stated)
    assert stated_by_step("then", sentence, known, scene=SCENE) is stated
