"""Read logs that are tables (CSV): one row for each pose, or for each event.

Columns: ``time`` (s); of a pose ``frame``, ``x``, ``y``, ``z`` (m), and optionally ``qx``, ``qy``, ``qz``, ``qw`` and
``parent``; of an event ``event``. Other columns are ignored. A row may be a pose, an event or both.
"""

from __future__ import annotations

import csv
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.files import open_regular
from robbdd_tools.logs.foxglove_mcap import contents_of
from robbdd_tools.logs.log_contents import LogContents, TextStamp, TrackBuilder, UnreadableLog

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

WORLD = "world"
POSITION, TURN = ("x", "y", "z"), ("qw", "qx", "qy", "qz")


def read_table(path: Path) -> LogContents:
    """Return the contents of a CSV file. Raises ``UnreadableLog`` with the line of a cell that is not a number."""
    builder, texts = TrackBuilder(), list[tuple[int, str, str]]()
    try:
        for line, row in _rows(path):
            time = round(_number(path, line, row, "time") * 1e9)
            if row.get("event"):
                texts.append((time, path.name, row["event"]))
            if row.get("frame"):
                x, y, z = (_number(path, line, row, name) for name in POSITION)
                turned = any(row.get(name) for name in TURN)
                w, a, b, c = (_number(path, line, row, name) for name in TURN) if turned else (1.0, 0.0, 0.0, 0.0)
                builder.add(row["frame"], row.get("parent") or WORLD, time, (x, y, z), (w, a, b, c))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise UnreadableLog(f"{path} cannot be read as a table: {error}") from error
    return contents_of(builder, texts)


def read_events(path: Path) -> tuple[TextStamp, ...]:
    """Return the events of a CSV file whose times count from the begin of a log, in s. Raises ``UnreadableLog``."""
    try:
        rows = [(_number(path, line, row, "time"), row["event"]) for line, row in _rows(path) if row.get("event")]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise UnreadableLog(f"{path} cannot be read as a table: {error}") from error
    if not rows:
        raise UnreadableLog(f"{path} has no event: name each in a column 'event'")
    return tuple(TextStamp(path.name, name, time) for time, name in sorted(rows))


def _rows(path: Path) -> Iterator[tuple[int, Mapping[str, str]]]:
    with open_regular(path) as file:
        lines = (line.decode("utf-8-sig" if number == 0 else "utf-8") for number, line in enumerate(file))
        table = csv.DictReader(lines, skipinitialspace=True)
        if "time" not in (table.fieldnames or ()):
            raise UnreadableLog(f"{path}:1: there is no column 'time': name the columns in the first line")
        for row in table:
            yield table.line_num, row


def _number(path: Path, line: int, row: Mapping[str, str], column: str) -> float:
    cell = row.get(column)
    try:
        return float(cell or "")
    except ValueError:
        raise UnreadableLog(f"{path}:{line}: column '{column}' must be a number, but is '{cell or ''}'") from None
