"""The database of results: full disks, damage, versions, copies."""

from __future__ import annotations

import shutil
import sqlite3
import subprocess
from contextlib import closing
from itertools import chain
from pathlib import Path

import pytest

from kit import fill_disk, small_disk
from robbdd_tools.protocol.messages import ScenarioFinished
from robbdd_tools.protocol.run_folder import trace_file
from robbdd_tools.run import database as databases
from robbdd_tools.run.database import DatabaseProblem, open_database, read_database
from robbdd_tools.run.missing_files import missing_parts
from robbdd_tools.run.recording import Recording, pending
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.run.store import KEPT, NoSuchRun, RunStore, begin_in, run_in
from robbdd_tools.run.stored_results import read_status
from run.recorded import RECORD, execution
from run.recordings import COUNT, MANIFEST, begun, leave, run_whole


def test_a_full_disk_in_mid_run_loses_nothing_that_was_finished(store: RunStore) -> None:
    mount = store.folder.parent
    mount.mkdir(parents=True)
    with small_disk(mount, 192):
        place = store.begin()
        recording, finished = begun(place), 0

        def take_all() -> None:
            nonlocal finished
            for message in chain.from_iterable(map(execution, range(COUNT))):
                recording.take(message)
                finished += isinstance(message, ScenarioFinished)

        filler = mount / "filler"
        fill_disk(filler)
        with pytest.raises(DatabaseProblem, match="full"):
            take_all()
        filler.unlink()
        recording.close()
        assert place.status().finished == finished < COUNT
        # With free space again, the run continues.
        with closing(Recording(place, MANIFEST)) as recording:
            for index in pending(recording.resume(Policy()), stops=False):
                for message in execution(index):
                    recording.take(message)
            recording.end("")
        assert place.results() == run_whole(RunStore(store.folder.parent.parent / "other")).results()


def test_a_store_that_can_only_be_read_is_read(store: RunStore) -> None:
    place = store.begin()
    recording = begun(place)
    for message in execution(0):
        recording.take(message)
    # A killed process leaves its log, and the file system becomes read-only.
    copy = store.folder.parent.with_name("copy")
    mount = store.folder.parent.with_name("readonly") / ".robbdd"
    shutil.copytree(store.folder.parent, copy)
    (copy / "results.sqlite-shm").unlink()
    recording.close()
    mount.mkdir(parents=True)
    done = subprocess.run(["mount", "--bind", str(copy), str(mount)], check=False)
    if done.returncode:
        pytest.skip("a file system can be mounted by root only")
    try:
        subprocess.run(["mount", "-o", "remount,bind,ro", str(mount)], check=True)
        (run,) = RunStore(mount / "runs").runs()
        assert run.status().words() == "died: 1 of 4 finished"
        assert run.results()["finished"] == 1
        with pytest.raises(OSError, match="Read-only"):
            RunStore(mount / "runs").begin()
    finally:
        subprocess.run(["umount", str(mount)], check=True)


def test_a_store_copied_without_its_log_says_what_it_lacks(store: RunStore, tmp_path: Path) -> None:
    place = store.begin()
    recording = begun(place, Policy(jobs=1))
    (place.folder / "traces").mkdir()
    for index in range(COUNT):
        for message in execution(index):
            recording.take(message)
        trace_file(place.folder, index).touch()
    copied = tmp_path / "copied"
    shutil.copytree(store.folder.parent, copied / ".robbdd", ignore=shutil.ignore_patterns("*-wal", "*-shm", "lock"))
    recording.close()
    (run,) = RunStore(copied / ".robbdd" / "runs").runs()
    with pytest.raises(NoSuchRun, match=r"has no record of run 1.*copy its write-ahead log results\.sqlite-wal"):
        run.status()

    # Now a log that had been written to the database in between.
    with closing(sqlite3.connect(store.database)) as connection:
        connection.execute("DELETE FROM execution WHERE idx > 1")
        connection.commit()
    assert missing_parts(place) == [
        f"{store.database} lacks the results of 2 executions (000002, 000003), whose traces exist: "
        "copy its write-ahead log results.sqlite-wal, too"
    ]


def test_a_run_folder_that_was_not_copied_is_missed(store: RunStore) -> None:
    place = run_whole(store)
    named = "000000, 000001, 000002 and 1 more"
    assert missing_parts(place) == [f"the folder of the run lacks the traces of 4 executions ({named})"]
    (place.folder / "manifest.json").unlink()
    assert "lacks manifest.json" in missing_parts(place)[1]
    with pytest.raises(NoSuchRun, match=r"holds no run: .*manifest\.json"):
        place.results()
    shutil.rmtree(place.folder)
    (run,) = store.runs()
    with pytest.raises(NoSuchRun, match="is gone"):
        run.record()


@pytest.mark.parametrize(
    "damage",
    [
        "UPDATE clause SET ranges = '[[1, 2], ['",
        "UPDATE clause SET ranges = 'null'",
        "UPDATE clause SET verdict = 'perhaps'",
        "UPDATE execution SET contacts = '{\"at\": 1}'",
        "UPDATE execution SET contacts = 'x'",
        "UPDATE clause SET robustness = 'large'",
        "INSERT INTO fault (run, id, shared, content) VALUES (1, 'f', 0, '{}')",
    ],
)
def test_a_damaged_value_makes_its_run_unreadable_and_no_other_one(store: RunStore, damage: str) -> None:
    place = store.begin()
    with closing(begun(place)) as recording:
        for message in execution(0):
            recording.take(message)
        leave(recording, place)
    with closing(sqlite3.connect(store.database)) as connection, connection:
        connection.execute(damage)
    with pytest.raises(NoSuchRun, match=r"results\.sqlite: is damaged: run 1 cannot be read: "):
        place.results()
    assert run_whole(store).results()["scenarios"]


@pytest.mark.parametrize("damage", ["header", "middle"])
def test_a_damaged_database_is_moved_aside_and_older_results_are_read(store: RunStore, damage: str) -> None:
    whole, died = run_whole(store), store.begin()
    leave(begun(died), died)
    document = whole.results()
    data = bytearray(store.database.read_bytes())
    start = 0 if damage == "header" else 4096
    data[start : start + 3 * 4096] = b"\xa5" * (3 * 4096)
    store.database.write_bytes(data)
    with pytest.raises(NoSuchRun, match=r"results\.sqlite: is damaged"):
        died.results()
    assert whole.results() == document, "its results.json is there"
    again = store.begin()
    assert "is damaged" in again.remark
    assert "it is kept as results.sqlite.damaged-1, and a new one was created" in again.remark
    assert store.database.with_name("results.sqlite.damaged-1").read_bytes() == data
    with closing(begun(again)) as recording:
        for message in execution(0):
            recording.take(message)
    assert again.status().finished == 1
    assert whole.results() == document


def test_a_damaged_database_is_left_alone_while_a_run_writes_to_it(store: RunStore) -> None:
    live = store.begin()
    recording = begun(live)
    store.database.write_bytes(b"\xa5" * 8192)
    Path(f"{store.database}-wal").unlink()
    with pytest.raises(DatabaseProblem, match="is damaged"):
        store.begin()
    recording.close()


def test_what_a_newer_version_wrote_is_refused(store: RunStore) -> None:
    run_whole(store)
    with closing(sqlite3.connect(store.database)) as connection:
        connection.execute("PRAGMA user_version = 999")
    with pytest.raises(DatabaseProblem, match=r"written by a newer version of RobBDD \(schema 999; .*update RobBDD"):
        store.begin()
    with pytest.raises(DatabaseProblem, match="newer version"):
        read_database(store.database)


def test_a_database_of_something_else_is_refused_and_left_as_it_is(store: RunStore) -> None:
    store.folder.mkdir(parents=True)
    with closing(sqlite3.connect(store.database)) as connection:
        connection.execute("CREATE TABLE stamps (country TEXT)")
    before = store.database.read_bytes()
    with pytest.raises(DatabaseProblem, match="is a database of another program"):
        store.begin()
    assert store.database.read_bytes() == before


def test_an_older_schema_is_migrated_by_writers_and_read_by_readers(
    store: RunStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    place = run_whole(store)
    document = place.results()
    more = (*databases.MIGRATIONS, ("ALTER TABLE run ADD COLUMN study TEXT", "CREATE TABLE factor (name TEXT)"))
    monkeypatch.setattr(databases, "MIGRATIONS", more)
    old = store.database.read_bytes()
    assert place.results() == document
    reader = read_database(store.database)
    assert reader is not None
    with closing(reader):
        assert reader.execute("SELECT study FROM run").fetchall() == [(None,)]
    assert store.database.read_bytes() == old, "reading does not change it"
    open_database(store.database).close()
    with closing(sqlite3.connect(store.database)) as connection:
        assert connection.execute("PRAGMA user_version").fetchone() == (len(more),)
        assert connection.execute("SELECT count(*) FROM factor").fetchone() == (0,)
    assert place.results() == document


def test_a_migration_that_fails_changes_nothing(store: RunStore, monkeypatch: pytest.MonkeyPatch) -> None:
    run_whole(store)
    broken = (*databases.MIGRATIONS, ("CREATE TABLE factor (name TEXT)", "CREATE TABLE run (number INTEGER)"))
    monkeypatch.setattr(databases, "MIGRATIONS", broken)
    with pytest.raises(DatabaseProblem, match="table run already exists"):
        open_database(store.database)
    monkeypatch.undo()
    with closing(sqlite3.connect(store.database)) as connection:
        assert connection.execute("SELECT count(*) FROM sqlite_master WHERE name = 'factor'").fetchone() == (0,)
        assert connection.execute("PRAGMA user_version").fetchone() == (len(databases.MIGRATIONS),)


def test_two_runs_at_once_keep_their_results_apart(store: RunStore) -> None:
    first, second = store.begin(), store.begin()
    one, other = begun(first), begun(second)
    for index in range(COUNT):
        for message in execution(index):
            one.take(message)
        for message in execution(index, "violated"):
            other.take(message)
    assert (first.status().counts, second.status().counts) == ({"holds": 4}, {"violated": 4})
    one.end("")
    other.end("")
    one.close()
    other.close()
    assert first.results()["complete"]
    assert second.results()["complete"]


def test_unfinished_runs_do_not_push_out_finished_ones_and_live_ones_stay(store: RunStore) -> None:
    whole, live = run_whole(store), store.begin()
    recording = begun(live)
    for _ in range(KEPT + 3):
        place = store.begin()
        leave(begun(place), place)
    numbers = [run.number for run in store.runs()]
    assert numbers[:2] == [whole.number, live.number]
    assert len(numbers) == KEPT + 1 + 2, "the newest is not counted"
    assert store.find("1").results()["complete"]
    recording.close()
    with closing(sqlite3.connect(store.database)) as connection:
        assert [number for (number,) in connection.execute("SELECT number FROM run ORDER BY number")] == numbers


def test_a_run_in_a_folder_of_its_own_has_its_database_there(tmp_path: Path) -> None:
    place = begin_in(tmp_path / "own")
    with closing(begun(place)) as recording:
        for index in range(COUNT):
            for message in execution(index):
                recording.take(message)
        with pytest.raises(OSError, match="another run is writing to it"):
            begin_in(tmp_path / "own")
        recording.end("")
    document = place.results()
    (tmp_path / "own").rename(tmp_path / "moved")
    assert run_in(tmp_path / "moved").results() == document
    assert RunStore(tmp_path).find(str(tmp_path / "moved")).results() == document
    trace_file(tmp_path / "moved", 3).parent.mkdir()
    trace_file(tmp_path / "moved", 3).touch()
    again = begin_in(tmp_path / "moved")
    assert not trace_file(again.folder, 3).exists(), "it is no evidence for what is run now"


def test_status_is_that_of_results_json_where_the_database_knows_nothing(store: RunStore) -> None:
    place = store.begin()
    place.write_record(RECORD)
    entries = [{"verdict": "holds", "duration": 1.0}, {"verdict": "unknown", "duration": None}]
    place.write_results({"complete": False, "scenarios": entries})
    assert place.status().words() == "interrupted: 1 of 2 finished"
    assert read_status(store.database, place.number) is None
