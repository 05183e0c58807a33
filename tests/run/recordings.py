"""Runs that are recorded without an agent."""

from __future__ import annotations

from contextlib import closing

from kit import write_manifest
from robbdd_tools.protocol.messages import RunStarted
from robbdd_tools.protocol.specs import Manifest
from robbdd_tools.run.recording import Recording
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.run.store import RunStore, StoredRun
from run.recorded import RECORD, execution, spec

COUNT = 4
MANIFEST = Manifest("m.bdd", 1, tuple(map(spec, range(COUNT))), True)


def begun(place: StoredRun, policy: Policy | None = None) -> Recording:
    write_manifest(place.folder, MANIFEST)
    place.write_record(RECORD)
    recording = Recording(place, MANIFEST)
    recording.begin(RECORD, policy or Policy(), "prepared")
    recording.take(RunStarted(COUNT, "MuJoCo 4"))
    return recording


def leave(recording: Recording, place: StoredRun) -> None:
    """Let a run go as its process does when it is killed."""
    recording.close()
    assert not place.is_live


def run_whole(store: RunStore) -> StoredRun:
    place = store.begin()
    with closing(begun(place)) as recording:
        for index in range(COUNT):
            for message in execution(index):
                recording.take(message)
        recording.end("")
    return place
