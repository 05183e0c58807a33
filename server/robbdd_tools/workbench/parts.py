"""The work of one worker of a cluster: execute a part of a batch, and return the messages of its agents."""

from __future__ import annotations

import os
import platform
import shutil
import tempfile
import threading
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from time import monotonic

from robbdd_tools.base.files import load_bytes
from robbdd_tools.base.isolation import NO_USER_CODE, OWNER_FORBIDS, WORKER_USER_CODE
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.protocol.manifest_file import read_manifest
from robbdd_tools.protocol.messages import ClauseJudged, RunFinished, RunMessage, encode
from robbdd_tools.protocol.run_folder import trace_file
from robbdd_tools.run.parcels import Moved, Parcel, unpack
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.run.scheduler import Scheduler
from robbdd_tools.run.user_code import refusal
from robbdd_tools.syntax.study_content import ALL
from robbdd_tools.workbench.deciding_versions import differences, versions

_POLL = 0.5
"""Seconds between two checks whether the work is still wanted."""


@dataclass(frozen=True, slots=True)
class Part:
    """Some scenarios of a batch, which one worker executes one after the other.

    - ``batch``: the number of the batch in the study.
    - ``indices``: the numbers of the scenarios in the batch's manifest, increasing.
    - ``origin``: the run folder of the batch on the machine that began the study.
    - ``versions``: the versions that the worker must have.
    - ``timeout``: the limit of wall time for one scenario in s.
    - ``traces``: which traces to return: of ``failures``, or of ``all`` executions; empty for none.
    """

    batch: int
    indices: tuple[int, ...]
    origin: str
    versions: Mapping[str, str]
    timeout: float
    traces: str = ""


@dataclass(frozen=True, slots=True)
class PartResult:
    """The messages of a part as lines of JSON, in the order of its scenarios.

    - ``refused``: why the worker did not execute the part; else empty.
    - ``ending``: why scenarios of the part are open; else empty.
    - ``seconds``: the wall time in s.
    - ``host``: the name of the worker's machine.
    - ``traces``: the contents of wanted traces by the numbers of their scenarios.
    """

    lines: tuple[str, ...] = ()
    refused: str = ""
    ending: str = ""
    seconds: float = 0.0
    host: str = ""
    traces: Mapping[int, bytes] = field(default_factory=dict[int, bytes])


def execute_part(part: Part, used: Parcel, prepared: Parcel, folder: Path, wanted: Callable[[], bool]) -> PartResult:
    """Execute a part in the worker's own ``folder``. The work ends early when ``wanted`` returns false.

    ``used`` is unpacked once and kept for other parts. A worker that cannot store files refuses the part.
    """
    try:
        return _executed(part, used, prepared, folder, wanted)
    except OSError as error:
        where = f"{error.filename}: " if error.filename else ""
        return PartResult(refused=f"cannot execute the study: {where}{error.strerror or error}", host=platform.node())


def _executed(part: Part, used: Parcel, prepared: Parcel, folder: Path, wanted: Callable[[], bool]) -> PartResult:
    began, host = monotonic(), platform.node()
    found = list(differences(part.versions, versions()))
    if found:
        return PartResult(refused=f"has {', '.join(found)}", host=host)
    folder.mkdir(parents=True, exist_ok=True)
    root = unpack(used, folder / "files")
    work = Path(tempfile.mkdtemp(prefix="part-", dir=folder))
    try:
        run_folder = unpack(prepared, work)
        moved = Moved(run_folder, root, part.origin, used.roots)
        moved.move_manifest()
        manifest = read_manifest(run_folder)
        own = replace(manifest, scenarios=tuple(manifest.scenarios[index] for index in part.indices))
        _forbid_user_code()
        problem = refusal(own, run_folder)
        if problem:
            return PartResult(refused=f"refuses the study: {moved.restored(problem)}", host=host)
        policy = Policy(jobs=1, timeout=part.timeout)
        scheduler = Scheduler(run_folder, manifest, policy, indices=part.indices)
        with _cancelling(scheduler, wanted):
            messages = [message for message in scheduler.messages() if not isinstance(message, RunFinished)]
        lines, ending = map(encode, messages), moved.restored(scheduler.ending)
        traces = dict(_traces(part, messages, run_folder))
        return PartResult(tuple(map(moved.restored, lines)), "", ending, monotonic() - began, host, traces)
    finally:
        shutil.rmtree(work, ignore_errors=True)


def _traces(part: Part, messages: Iterable[RunMessage], folder: Path) -> Iterator[tuple[int, bytes]]:
    """Yield the wanted traces of a part with the numbers of their scenarios."""
    judged = (message for message in messages if isinstance(message, ClauseJudged))
    failing = {message.index for message in judged if message.verdict != Outcome.HOLDS}
    for index in part.indices if part.traces else ():
        trace = trace_file(folder, index)
        if trace.is_file() and (part.traces == ALL or index in failing):
            yield index, load_bytes(trace, RESULT_SIZE)


def _forbid_user_code() -> None:
    """Forbid users' code in this process and its agents, unless the worker's owner allows it."""
    if os.environ.get(WORKER_USER_CODE) != "allow":
        os.environ[NO_USER_CODE] = OWNER_FORBIDS


@contextmanager
def _cancelling(scheduler: Scheduler, wanted: Callable[[], bool]) -> Generator[None]:
    """Cancel the execution as soon as ``wanted`` returns false."""
    ended = threading.Event()

    def watch() -> None:
        while not ended.wait(_POLL):
            if not wanted():
                scheduler.cancel()
                return

    threading.Thread(target=watch, daemon=True).start()
    try:
        yield
    finally:
        ended.set()
