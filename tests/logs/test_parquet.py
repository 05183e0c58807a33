"""Tables in Parquet say the same as in CSV."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import duckdb
import numpy as np
import pytest

from robbdd_tools.logs.log_contents import UnreadableLog
from robbdd_tools.logs.log_files import is_log
from robbdd_tools.logs.log_table import read_events
from robbdd_tools.logs.open_log import read_log

ROWS = """time,frame,x [mm],y,z,event,elbow [deg]
100.0,cup,1000,0.1,0.30000000000000004,,90
100.1,cup,2000,0.1,0.3,pick-end,
100.2,,,,,place-end,45
"""


def parquet(folder: Path, rows: str = ROWS, change: str = "*") -> Path:
    """Write a table as Parquet; ``change`` chooses its columns."""
    (folder / "drive.csv").write_text(rows, encoding="utf-8")
    connection: Any = duckdb.connect(":memory:")
    source = f"SELECT {change} FROM read_csv('{folder / 'drive.csv'}')"
    connection.execute(f"COPY ({source}) TO '{folder / 'drive.parquet'}' (FORMAT parquet)")
    connection.close()
    return folder / "drive.parquet"


def test_a_table_in_parquet_says_the_same_as_in_csv(tmp_path: Path) -> None:
    path = parquet(tmp_path)
    assert is_log(path)
    found, expected = read_log(path), read_log(tmp_path / "drive.csv")
    assert found.tracks["cup"].positions.tolist() == [[1.0, 0.1, 0.30000000000000004], [2.0, 0.1, 0.3]]
    assert np.array_equal(found.tracks["cup"].positions, expected.tracks["cup"].positions)
    assert [(one.text, one.time) for one in found.texts] == [(one.text, one.time) for one in expected.texts]
    assert found.joints["drive.parquet"]["elbow"].positions.tolist() == [np.radians(90), np.radians(45)]
    assert [one.text for one in read_events(path)] == ["pick-end", "place-end"]


def test_points_in_time_are_times(tmp_path: Path) -> None:
    path = parquet(tmp_path, change="* REPLACE (make_timestamp((time * 1e6)::BIGINT) AS time)")
    assert read_log(path).tracks["cup"].times.tolist() == [0.0, 0.1]


def test_columns_with_other_titles_are_named(tmp_path: Path) -> None:
    path = parquet(tmp_path, ROWS.replace("time", "stamp").replace("frame", "body"))
    with pytest.raises(UnreadableLog, match=r"drive\.parquet: there is no column 'time'"):
        read_log(path)
    assert len(read_log(path, {"time": "stamp", "frame": "body"}).tracks["cup"].times) == 2


def test_a_cell_that_is_no_number_is_named_with_its_row(tmp_path: Path) -> None:
    path = parquet(tmp_path, ROWS.replace("2000,0.1", "2000,near"))
    with pytest.raises(UnreadableLog, match=r"drive\.parquet, row 2: column 'y' must be a number, but is 'near'"):
        read_log(path)


@pytest.mark.parametrize(("name", "words"), [("a.parquet", "cannot be read as Parquet"), ("a[1].parquet", "must not")])
def test_other_files_are_refused(name: str, words: str, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(b"PAR1 no table")
    with pytest.raises(UnreadableLog, match=words):
        read_log(tmp_path / name)
