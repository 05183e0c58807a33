"""Read logs that are tables (CSV or Parquet): one row for each time at which something was recorded.

The columns are ``time`` (s, or a date and a time); for a pose ``frame``, ``x``, ``y``, ``z`` (m), and optionally
``qx``, ``qy``, ``qz``, ``qw`` (or ``roll``, ``pitch``, ``yaw`` with their unit) and ``parent``; for an event ``event``.
Every other column with numbers may be a joint (rad, or m for a sliding joint). A title may end with another unit in
brackets: ``elbow [deg]``. A row may have one or several of these.
"""

from __future__ import annotations

import csv
from collections.abc import Collection, Mapping
from math import isfinite, isnan, nan
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.files import open_regular
from robbdd_tools.logs.joint_tracks import JointBuilder
from robbdd_tools.logs.log_contents import LogContents, TextStamp, UnreadableLog
from robbdd_tools.logs.parquet_table import PARQUET, parquet_rows, parquet_titles
from robbdd_tools.logs.table_cells import quaternion_of, read_date, read_number
from robbdd_tools.logs.table_columns import ANGLES, POSITION, TURN, Columns, columns_of
from robbdd_tools.logs.track_builder import TrackBuilder

if TYPE_CHECKING:
    from collections.abc import Iterator

WORLD = "world"
UNKNOWN_TURN = (nan, nan, nan, nan)
LATEST = 1e11
"""Later times, in s, are times in another unit: this is after the year 5000."""
MAX_LISTED = 8
DELIMITERS = (",", ";", "\t")


class Row:
    """A row of a table. Its cells are read by the names of known columns, or by the titles of joints."""

    def __init__(
        self, place: str, cells: Mapping[str, str | None], columns: Columns, *, has_commas: bool = False
    ) -> None:
        """``place`` is ``path:line``, for messages; ``cells`` maps titles to texts, which may have decimal commas."""
        self._place = place
        self._has_commas = has_commas
        self._cells = cells
        self._columns = columns

    def text(self, name: str) -> str:
        """Return the text of a known column; empty if there is none."""
        column = self._columns.known.get(name)
        return "" if column is None else self._cells.get(column.title) or ""

    def number(self, name: str) -> float:
        """Return the number in a known column, in the SI unit; NaN for an empty cell.

        Raises ``UnreadableLog`` if the text is not a number.
        """
        cell = self.text(name)
        if name in self._columns.known and not cell:
            return nan
        try:
            value = read_number(cell, self._has_commas)
        except ValueError:
            raise self._wrong(name, "must be a number") from None
        return value * self._columns.known[name].factor

    def time(self) -> int:
        """Return the time in ns. It is a number, or a date and a time by ISO 8601 (without a zone: UTC).

        Raises ``UnreadableLog``.
        """
        cell, column = self.text("time"), self._columns.known["time"]
        try:
            value = read_number(cell, self._has_commas) * column.factor
        except ValueError:
            try:
                return read_date(cell)
            except ValueError:
                raise self._wrong("time", "must be a number, or a date and a time") from None
        if not isfinite(value):
            raise self._wrong("time", "must be a number")
        if not column.unit and abs(value) > LATEST:
            unit = f"write its unit in the first line, or say --column 'time={column.title} [ns]'"
            raise self._wrong("time", f"is in s; {unit}: it would be after the year 5000")
        return round(value * 1e9)

    def turn(self) -> tuple[float, ...]:
        """Return the orientation (w, x, y, z) of a pose; four NaN if the row states none. Raises ``UnreadableLog``."""
        if any(self.text(name) for name in TURN):
            return tuple(self.number(name) for name in TURN)
        if any(self.text(name) for name in ANGLES):
            return quaternion_of(*(self.number(name) for name in ANGLES))
        return UNKNOWN_TURN

    def _wrong(self, name: str, words: str) -> UnreadableLog:
        shown = self._columns.known[name].title if name in self._columns.known else name
        return UnreadableLog(f"{self._place}: column '{shown}' {words}, but is '{self.text(name)}'")

    def joints(self) -> dict[str, float]:
        """Return the numbers of joints in the SI unit. Columns that have no number in this row are left out."""
        found: dict[str, float] = {}
        for name, column in self._columns.joints.items():
            try:
                found[name] = read_number(self._cells.get(column.title) or "", self._has_commas) * column.factor
            except ValueError:
                continue
        return found


def read_table(path: Path, columns: Mapping[str, str] | None = None) -> LogContents:
    """Return the contents of a table. ``columns`` maps names of columns to titles in the file.

    Raises ``UnreadableLog`` with the line of a cell that is not a number.
    """
    builder, joints, texts = TrackBuilder(), JointBuilder(), list[tuple[int, str, str]]()
    unturned: dict[str, None] = {}
    try:
        for row in _rows(path, columns or {}):
            time = row.time()
            if row.text("event"):
                texts.append((time, path.name, row.text("event")))
            if row.text("frame"):
                x, y, z = (row.number(name) for name in POSITION)
                w, a, b, c = row.turn()
                unturned |= {row.text("frame"): None} if isnan(w) else {}
                builder.add(row.text("frame"), row.text("parent") or WORLD, time, (x, y, z), (w, a, b, c))
            known = row.joints()
            joints.add(path.name, time, list(known), list(known.values()))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise UnreadableLog(f"{path} cannot be read as a table: {error}") from error
    stamps = [*builder.bounds(), *joints.bounds(), *(time for time, _, _ in texts)]
    begin, end = min(stamps, default=0), max(stamps, default=0)
    found = tuple(TextStamp(topic, text, (time - begin) / 1e9) for time, topic, text in sorted(texts))
    remarks = _without_turn(unturned)
    tracks = builder.tracks(begin, remarks)
    return LogContents(tracks, found, (end - begin) / 1e9, (*remarks, *joints.remarks), joints=joints.tracks(begin))


def _without_turn(frames: Collection[str]) -> list[str]:
    """Return the remark on frames of which at least one row has no orientation."""
    if not frames:
        return []
    named = [f"'{one}'" for one in frames]
    listed = ", ".join(named[:MAX_LISTED]) + (f" and {len(named) - MAX_LISTED} more" if named[MAX_LISTED:] else "")
    return [
        f"the table has no orientation of {listed}: clauses that depend on it are unknown; qw, qx, qy and qz state it, "
        "or roll, pitch and yaw with their unit: 'roll [deg]'"
    ]


def read_events(path: Path) -> tuple[TextStamp, ...]:
    """Return the events of a table. Their times count from the begin of the log, in s. Raises ``UnreadableLog``."""
    try:
        rows = [(row.time() / 1e9, row.text("event")) for row in _rows(path, {}) if row.text("event")]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise UnreadableLog(f"{path} cannot be read as a table: {error}") from error
    if not rows:
        raise UnreadableLog(f"{path} has no event: name each in a column 'event'")
    return tuple(TextStamp(path.name, name, time, declared=True) for time, name in sorted(rows))


def _rows(path: Path, stated: Mapping[str, str]) -> Iterator[Row]:
    if path.suffix.lower() == PARQUET:
        columns = columns_of(str(path), parquet_titles(path), stated)
        for number, cells in enumerate(parquet_rows(path), 1):
            yield Row(f"{path}, row {number}", cells, columns)
        return
    with open_regular(path) as file:
        lines = (line.decode("utf-8-sig" if number == 0 else "utf-8") for number, line in enumerate(file))
        first = next(lines, "")
        # Some recorders separate columns by spaces.
        delimiter = next((one for one in DELIMITERS if one in first), " " if len(first.split()) > 1 else ",")
        head = csv.DictReader([first], delimiter=delimiter, skipinitialspace=True).fieldnames or ()
        titles = [title.strip() for title in head]
        columns = columns_of(f"{path}:1", titles, stated)
        table = csv.DictReader(lines, titles, delimiter=delimiter, skipinitialspace=True)
        for row in table:
            yield Row(f"{path}:{table.line_num + 1}", row, columns, has_commas=delimiter != ",")
