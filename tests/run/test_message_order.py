"""Messages of parallel scenarios are delivered in the manifest's order."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from robbdd_tools.protocol.messages import RunMessage, ScenarioFinished, ScenarioStarted
from robbdd_tools.run.message_order import OrderedMessages


def story(index: int) -> list[RunMessage]:
    return [ScenarioStarted(index), ScenarioFinished(index, 1.0, 1.0, 1.0)]


@given(st.permutations([0, 1, 2, 3] * 2))
def test_any_interleaving_becomes_the_order_of_the_manifest(turns: list[int]) -> None:
    order, stories = OrderedMessages(range(4)), {index: iter(story(index)) for index in range(4)}
    found = [due for index in turns for due in order.take(index, next(stories[index]))]
    assert found == [message for index in range(4) for message in story(index)]


def test_the_scenario_whose_turn_it_is_is_heard_at_once() -> None:
    order = OrderedMessages(range(4))
    assert list(order.take(0, ScenarioStarted(0))) == [ScenarioStarted(0)]
    assert list(order.take(1, ScenarioStarted(1))) == []


def test_what_is_finished_is_not_lost_when_its_turn_never_comes() -> None:
    order = OrderedMessages(range(4))
    for message in (*story(2), ScenarioStarted(1)):
        assert list(order.take(2 if message in story(2) else 1, message)) == []
    assert list(order.finished()) == story(2)
    order.forget(2)
    assert list(order.finished()) == []


def test_forgotten_scenarios_are_those_from_a_number_on() -> None:
    order = OrderedMessages([0, 3, 5])
    for index in (3, 5):
        assert [due for message in story(index) for due in order.take(index, message)] == []
    order.forget(5)
    assert [due for message in story(0) for due in order.take(0, message)] == [*story(0), *story(3)]
    assert list(order.finished()) == []


def test_after_the_last_turn_nothing_is_due() -> None:
    order = OrderedMessages([2])
    assert [due for message in story(2) for due in order.take(2, message)] == story(2)
    assert list(order.take(2, ScenarioStarted(2))) == []
