"""``python -m robbdd_tools.logs.summarize``: write the summary of the log on standard input as JSON."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable, Iterator
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.limits import SCENE_MEMORY
from robbdd_tools.base.processes import limit_memory, lower_priority
from robbdd_tools.logs.log_summary import FrameSummary, LogSummary
from robbdd_tools.logs.log_topics import topics_of
from robbdd_tools.logs.open_log import read_log

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.logs.log_contents import LogContents

MAX_TEXTS = 1000
"""Maximum number of different texts that a summary lists."""
MAX_LENGTH = 200
"""Longer texts are no names of events."""


def summarize(path: Path) -> LogSummary:
    """Read a log and return its summary. If the log cannot be judged, the summary has the reason."""
    try:
        topics = topics_of(path)
        return replace(_of_contents(read_log(path)), topics=topics)
    except (RobbddError, OSError) as error:
        return LogSummary(problem=str(error))


def _of_contents(contents: LogContents) -> LogSummary:
    frames = {
        name: FrameSummary(track.parent, len(track.times), *_bounds(track.times), track.static)
        for name, track in sorted(contents.tracks.items())
    }
    joints = {topic: tuple(sorted(found)) for topic, found in sorted(contents.joints.items())}
    texts = tuple(sorted(set(_short(one.text for one in contents.texts))))
    return LogSummary({}, frames, joints, texts[:MAX_TEXTS], contents.end)


def _bounds(times: FloatArray) -> tuple[float, float]:
    return float(times[0]), float(times[-1])


def _short(texts: Iterable[str]) -> Iterator[str]:
    """Yield the texts that may be names of events."""
    return (text for text in texts if len(text) <= MAX_LENGTH)


def main() -> None:
    """Answer the request on standard input."""
    lower_priority()
    # A file in an opened folder may demand any amount of memory.
    limit_memory(SCENE_MEMORY.value())
    json.dump(asdict(summarize(Path(sys.stdin.read()))), sys.stdout)


if __name__ == "__main__":
    main()
