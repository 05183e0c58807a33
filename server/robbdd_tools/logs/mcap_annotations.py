"""Events that somebody has added to an MCAP file by hand, as metadata records."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from mcap.reader import make_reader

from robbdd_tools.base.files import open_regular
from robbdd_tools.logs.log_contents import LogContents, TextStamp, UnreadableLog

EVENT, SINCE_BEGIN, LOG_TIME = "event", "time", "log_time"
"""Keys of a record: the event, and its time in s since the begin of the log or in ns by the clock of reception."""


@dataclass(frozen=True, slots=True)
class Annotations:
    """The events in the metadata of files, and sentences on what is not read.

    - ``received``: (time of the clock of reception, ns; name of the record; event).
    - ``since_begin``: (time since the begin of the log, s; name of the record; event).
    """

    received: tuple[tuple[int, str, str], ...] = ()
    since_begin: tuple[tuple[float, str, str], ...] = ()
    remarks: tuple[str, ...] = ()


def read_annotations(paths: Iterable[Path]) -> Annotations:
    """Return the events in the metadata of complete MCAP files. Raises ``UnreadableLog``."""
    received: list[tuple[int, str, str]] = []
    since_begin: list[tuple[float, str, str]] = []
    attached: list[str] = []
    for path in paths:
        try:
            with open_regular(path) as file:
                reader = make_reader(file)
                records = [(one.name, dict(one.metadata)) for one in reader.iter_metadata()]
                summary = reader.get_summary()
                attached += [] if summary is None else [one.name for one in summary.attachment_indexes]
        except Exception as error:  # On damaged bytes the decoder raises exceptions of several types.
            raise UnreadableLog(f"{path} cannot be read as MCAP: {error or type(error).__name__}") from error
        for name, entries in records:
            if LOG_TIME in entries and EVENT in entries:
                received.append((round(_number(path, name, entries, LOG_TIME)), name, entries[EVENT]))
            elif SINCE_BEGIN in entries and EVENT in entries:
                since_begin.append((_number(path, name, entries, SINCE_BEGIN), name, entries[EVENT]))
    listed = ", ".join(f"'{name}'" for name in attached)
    remarks = (f"attachments are not read: {listed}",) if attached else ()
    return Annotations(tuple(received), tuple(since_begin), remarks)


def annotated(contents: LogContents, found: Annotations) -> LogContents:
    """Return the contents of a log with the events whose times count from its begin."""
    texts = [*contents.texts, *(TextStamp(name, event, time, declared=True) for time, name, event in found.since_begin)]
    ordered = tuple(sorted(texts, key=lambda stamp: stamp.time))
    end = max([contents.end, *(time for time, _, _ in found.since_begin)])
    return replace(contents, texts=ordered, end=end, remarks=(*contents.remarks, *found.remarks))


def _number(path: Path, name: str, entries: Mapping[str, str], key: str) -> float:
    try:
        value = float(entries[key]) if key == SINCE_BEGIN else int(entries[key])
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        unit = "a time in s since the begin of the log" if key == SINCE_BEGIN else "a time in ns"
        raise UnreadableLog(f"{path}: '{key}' of the metadata record '{name}' must be {unit}, but is '{entries[key]}'")
    return value
