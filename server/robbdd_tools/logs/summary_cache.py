"""Keep the summaries of logs in the user's cache folder, by the size and modification time of the log's files.

A background process writes them (``obtain``); an editor's requests only read them (``known_summary``), which takes less
than a millisecond however long the log is.
"""

from __future__ import annotations

import hashlib
import json
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path

from robbdd_tools.base.cache_folder import cache_folder
from robbdd_tools.base.files import UnreadableFile, load_text
from robbdd_tools.base.interpreter import run_for
from robbdd_tools.base.limits import LOG_SECONDS, RESULT_SIZE
from robbdd_tools.base.plain import from_plain
from robbdd_tools.base.processes import describe_exit
from robbdd_tools.base.writing import replace_file
from robbdd_tools.logs.log_files import METADATA, bag_files
from robbdd_tools.logs.log_summary import LogSummary

SUMMARIZE = "robbdd_tools.logs.summarize"
FORM = 1
"""Version of the form of a summary. One of another version is made again."""
_READ: dict[Path, tuple[str, LogSummary]] = {}
MAX_READ = 32
"""Maximum number of summaries that are kept in memory."""


def known_summary(path: Path) -> LogSummary | None:
    """Return the summary of a log in its current state, or ``None`` if none has been made."""
    state = _state(path)
    if path in _READ and _READ[path][0] == state:
        return _READ[path][1]
    try:
        stored = json.loads(load_text(_place(path), RESULT_SIZE))
        if stored["state"] != state:
            return None
        found = from_plain(LogSummary, stored["summary"])
    except (UnreadableFile, OSError, ValueError, KeyError, TypeError):
        return None
    _remember(path, state, found)
    return found


def obtain(path: Path) -> LogSummary:
    """Return the summary of a log. If it is not known, another process makes it, within ``LOG_SECONDS``.

    If that fails, the summary has the reason.
    """
    known = known_summary(path)
    if known is not None:
        return known
    state, seconds = _state(path), LOG_SECONDS.value()
    try:
        ending = run_for(seconds, SUMMARIZE, sent=str(path))
    except OSError as error:
        return LogSummary(problem=str(error))
    if ending.code is None:
        reason = f"reading it took longer than {seconds} seconds (the limit {LOG_SECONDS.name})"
        found = LogSummary(problem=reason)
    elif ending.code:
        lines = ending.errors.strip().splitlines()
        return LogSummary(problem=lines[-1] if lines else f"its reader ended with {describe_exit(ending.code)}")
    else:
        found = from_plain(LogSummary, json.loads(ending.output))
    _remember(path, state, found)
    with suppress(OSError):
        place = _place(path)
        place.parent.mkdir(parents=True, exist_ok=True)
        replace_file(place, json.dumps({"state": state, "summary": asdict(found)}))
    return found


def _remember(path: Path, state: str, summary: LogSummary) -> None:
    _READ.pop(path, None)
    _READ[path] = (state, summary)
    if len(_READ) > MAX_READ:
        del _READ[next(iter(_READ))]


def _place(path: Path) -> Path:
    return cache_folder() / "logs" / f"{hashlib.sha256(str(path.absolute()).encode('utf-8')).hexdigest()}.json"


def _state(path: Path) -> str:
    """Return the names, sizes and modification times of the files of a log."""
    try:
        files = [*bag_files(path), path / METADATA] if path.is_dir() else [path]
        found = [(one.name, one.stat().st_size, one.stat().st_mtime_ns) for one in files if one.is_file()]
    except OSError:
        found = []
    return f"{FORM} {found}"
