"""Results in the database: each finished execution immediately, without loss or silent overwriting."""

from __future__ import annotations

import json
from contextlib import closing
from dataclasses import replace

import pytest

from kit import schema_errors
from robbdd_tools.catalog.coordination import TreeSpec
from robbdd_tools.protocol.messages import RunFinished, RunStarted
from robbdd_tools.run.recording import OtherSimulator, Recording, pending
from robbdd_tools.run.results import RunResults
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.run.scheduler import STOPPED as STOPPED_ENDING
from robbdd_tools.run.store import RunStore
from run.recorded import execution, rows, spec
from run.recordings import COUNT, MANIFEST, begun, leave, run_whole


def test_results_made_from_the_database_are_those_that_were_heard(store: RunStore) -> None:
    place, heard = store.begin(), RunResults(MANIFEST)
    with closing(begun(place)) as recording:
        for index in (2, 0, 3, 1):
            for message in execution(index, ("holds", "violated", "unknown", "holds")[index]):
                recording.take(message)
                heard.apply(message)
        assert place.status().words() == "running: 4 of 4 finished"
        ended = recording.end("")
    heard.apply(RunFinished(True))
    assert ended.as_json() == heard.as_json() == place.results()
    assert json.loads((place.folder / "results.json").read_text(encoding="utf-8")) == place.results()
    assert schema_errors("run.schema.json", place.results()) == []
    assert ended.vacuous() == heard.vacuous() != {}
    assert place.record().simulator == "MuJoCo 4"
    assert (place.status().counts, place.status().words()) == ({"holds": 2, "violated": 1, "unknown": 1}, "")


def test_an_execution_is_committed_when_its_end_has_been_taken(store: RunStore) -> None:
    place = store.begin()
    with closing(begun(place)) as recording:
        *before, end = execution(2)
        for message in before:
            recording.take(message)
        assert place.status().finished == 0
        recording.take(end)
        # Another process sees it before it is reported.
        assert place.status().finished == 1


def test_a_run_that_died_keeps_what_was_finished_and_says_so(store: RunStore) -> None:
    place = store.begin()
    recording = begun(place)
    for message in (*execution(0), *execution(2), *list(execution(1))[:4]):
        recording.take(message)
    assert place.status().state == "running"
    leave(recording, place)
    status = place.status()
    assert (status.state, status.words()) == ("died", "died: 2 of 4 finished")
    document = place.results()
    assert schema_errors("run.schema.json", document) == []
    assert [entry["duration"] is not None for entry in document["scenarios"]] == [True, False, True, False]
    assert {one["reason"] for one in document["scenarios"][1]["clauses"]} == {"the run ended without notice"}
    assert (document["complete"], document["finished"]) == (False, 2)


def test_a_resumed_run_has_the_rows_of_one_that_was_not_interrupted(store: RunStore) -> None:
    whole, place = run_whole(store), store.begin()
    recording = begun(place)
    for message in (*execution(0), *execution(2)):
        recording.take(message)
    leave(recording, place)
    with closing(Recording(place, MANIFEST)) as recording:
        results = recording.resume(Policy(jobs=7))
        indices = pending(results, stops=False)
        assert indices == [1, 3]
        recording.take(RunStarted(COUNT, "MuJoCo 4"))
        for index in indices:
            for message in execution(index):
                assert recording.take(message)
        recording.end("")
    assert rows(store.database, whole.number) == rows(store.database, place.number)
    assert place.results() == whole.results()


def test_what_was_finished_is_neither_written_nor_shown_again(store: RunStore) -> None:
    place = store.begin()
    recording = begun(place)
    for message in execution(0, "violated"):
        recording.take(message)
    leave(recording, place)
    with closing(Recording(place, MANIFEST)) as recording:
        recording.resume(Policy())
        assert not any(recording.take(message) for message in execution(0))
        assert recording.is_new(RunStarted(COUNT, "MuJoCo 4"))
        recording.end("cancelled", interrupted=True)
    assert place.results()["scenarios"][0]["verdict"] == "violated"


def test_another_simulator_does_not_go_on_with_a_run(store: RunStore) -> None:
    place = store.begin()
    leave(begun(place), place)
    with closing(Recording(place, MANIFEST)) as recording:
        recording.resume(Policy())
        with pytest.raises(OtherSimulator, match="was made with MuJoCo 4, and this is MuJoCo 5"):
            recording.take(RunStarted(COUNT, "MuJoCo 5"))


def test_scenarios_of_one_execution_are_executed_together_again() -> None:
    tree = TreeSpec("t 1", "https://x/t", (), 0.5, 0.0)
    manifest = replace(MANIFEST, scenarios=(spec(0, tree), spec(1), spec(2, tree), spec(3)))
    results = RunResults(manifest)
    for message in (*execution(0), *execution(1)):
        results.apply(message)
    assert pending(results, stops=False) == [0, 2, 3]
    for message in execution(2):
        results.apply(message)
    assert pending(results, stops=False) == [3]


def test_nothing_beyond_the_first_failure_is_kept_of_a_run_that_stops_there(store: RunStore) -> None:
    place, policy = store.begin(), Policy(stop_on_failure=True)
    with closing(begun(place, policy)) as recording:
        for message in (*execution(3), *execution(0), *execution(1, "violated")):
            recording.take(message)
        recording.end(STOPPED_ENDING)
    status = place.status()
    assert (status.state, status.is_whole, status.finished) == ("stopped", True, 2)
    assert status.words() == "stopped at the first failure: 2 of 4 finished"


def test_a_run_that_stops_at_a_failure_goes_on_before_it_only(store: RunStore) -> None:
    place, policy = store.begin(), Policy(stop_on_failure=True)
    recording = begun(place, policy)
    for message in (*execution(3), *execution(2, "violated")):
        recording.take(message)
    leave(recording, place)
    with closing(Recording(place, MANIFEST)) as recording:
        assert pending(recording.resume(policy), stops=True) == [0, 1]
        assert pending(recording.resume(policy), stops=False) == [0, 1]
        for message in (*execution(0), *execution(1)):
            recording.take(message)
        recording.end(STOPPED_ENDING)
    assert (place.status().state, place.status().finished) == ("stopped", 3)
