"""The moments at which clauses are violated, for a page: a picture, and the poses shortly before and after."""

from __future__ import annotations

import json
import struct
import tempfile
from base64 import b64decode, b64encode
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.files import UnreadableFile, load_bytes
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.protocol.run_folder import thumbnail_file, trace_file
from robbdd_tools.run.json_documents import NoTrace, trace_document
from robbdd_tools.run.pictures import NoPictures, render_thumbnails
from robbdd_tools.run.readable import title

if TYPE_CHECKING:
    from robbdd_tools.run.store import StoredRun
    from robbdd_tools.workbench.execution_rows import ClauseResult, ExecutionResult

BEFORE, AFTER = 3.0, 1.0
"""A replay begins and ends this long (s) before and after the moment."""
MOST_MOMENTS = 10
"""At most this many executions of a page have a picture and a replay."""
MOST_BYTES = 3_500_000
"""Limit of all replays and pictures of a page in bytes; those of later executions are left out."""


@dataclass(frozen=True, slots=True)
class Moment:
    """The moment of an execution: a picture as a ``data:`` URI, and the number of its replay in the page.

    Either may be missing.
    """

    words: str
    picture: str = ""
    replay: int | None = None


class Moments:
    """Collects the moments of a page. ``problem`` is the reason why pictures are missing; empty if none are."""

    def __init__(self) -> None:
        self.problem = ""
        self._room = MOST_BYTES
        self._scenes: dict[str, int] = {}
        self._replays: list[str] = []

    def add(self, run: StoredRun, results: Iterable[ExecutionResult], label: str = "") -> Mapping[int, Moment]:
        """Return the moment of each execution that has a trace and a violated clause, by the index of the execution.

        ``label`` says which run it is. Raises ``NoSuchRun``.
        """
        found = {one.index: first_violation(one) for one in results if trace_file(run.folder, one.index).is_file()}
        chosen = {index: clause for index, clause in found.items() if clause is not None}
        chosen = dict(list(chosen.items())[:MOST_MOMENTS])
        pictures = self._pictures(run, chosen)
        moments: dict[int, Moment] = {}
        for index, (_, clause) in chosen.items():
            what = f"{title(clause.name, clause.sentence)} is violated"
            words = what if clause.at is None else f"{what} at {clause.at:.2f} s"
            replay = self.add_replay(run, index, instant_of(clause), what, label)
            moments[index] = Moment(words, pictures.get(index, ""), replay)
        return moments

    def add_replay(self, run: StoredRun, index: int, at: float | None, what: str, label: str = "") -> int | None:
        """Add the replay of an execution around an instant (s; ``None``: its end) at which ``what`` happens.

        Returns the number of the replay in the page, or ``None`` if there is no trace or no room for a replay. Raises
        ``NoSuchRun``.
        """
        try:
            seen = trace_document(run, index)
        except NoTrace:
            return None
        if not seen["frames"]["bodies"]:
            return None
        at = float(seen["duration"]) if at is None else at
        scene = json.dumps({name: seen[name] for name in ("shapes", "meshes", "workspaces")})
        moment = {
            "name": f"{label}: {seen['scenario']['name']}" if label else seen["scenario"]["name"],
            "what": what,
            "at": at,
            "bodies": seen["bodies"],
            "moving": seen["frames"]["bodies"],
            **_around(seen["frames"], at),
        }
        written = json.dumps(moment)
        if not self._fits(len(written) + (0 if scene in self._scenes else len(scene))):
            return None
        number = self._scenes.setdefault(scene, len(self._scenes))
        self._replays.append(f'{{"scene":{number},{written[1:]}')
        return len(self._replays) - 1

    def picture(self, run: StoredRun, result: ExecutionResult) -> str:
        """Return the picture of the first violation of an execution as a ``data:`` URI; empty if there is none."""
        found = first_violation(result)
        if found is None or not trace_file(run.folder, result.index).is_file():
            return ""
        return self._pictures(run, {result.index: found}).get(result.index, "")

    def document(self) -> str:
        """Return scenes and replays as JSON for ``report_replay.js``; empty if there is no replay."""
        if not self._replays:
            return ""
        return f'{{"scenes":[{",".join(self._scenes)}],"moments":[{",".join(self._replays)}]}}'

    def _pictures(self, run: StoredRun, chosen: Mapping[int, tuple[int, ClauseResult]]) -> Mapping[int, str]:
        if not chosen or self.problem:
            return {}
        scenarios = run.manifest().scenarios
        lines = {index: scenarios[index].clauses[place].line for index, (place, _) in chosen.items()}
        found: dict[int, str] = {}
        with tempfile.TemporaryDirectory(prefix="robbdd-") as folder:
            try:
                render_thumbnails(run.folder, Path(folder), lines.items())
            except NoPictures as error:
                self.problem = str(error)
            for index, line in lines.items():
                try:
                    data = load_bytes(thumbnail_file(Path(folder), index, line), RESULT_SIZE)
                except (OSError, UnreadableFile):
                    continue
                picture = f"data:image/png;base64,{b64encode(data).decode('ascii')}"
                if self._fits(len(picture)):
                    found[index] = picture
        return found

    def _fits(self, size: int) -> bool:
        if size > self._room:
            return False
        self._room -= size
        return True


def instant_of(clause: ClauseResult) -> float | None:
    """Return when a clause was violated or, if it was not, nearest to violation (s, simulated); ``None`` if unknown."""
    return next((time for time in (clause.at, clause.worst_at) if time is not None), None)


def first_violation(result: ExecutionResult) -> tuple[int, ClauseResult] | None:
    """Return the clause that is violated earliest, with its position. Other violations often follow from it."""
    found = [(place, one) for place, one in enumerate(result.clauses) if one.verdict is Outcome.VIOLATED]
    return min(found, key=lambda one: inf if one[1].at is None else one[1].at, default=None)


def _around(frames: Mapping[str, Any], at: float) -> Mapping[str, Any]:
    """Return the frames from ``BEFORE`` an instant until ``AFTER`` it or, if there are none, the last frame."""
    data = b64decode(frames["times"]["data"])
    times = struct.unpack(f"<{len(data) // 4}f", data)
    inside = [row for row, time in enumerate(times) if at - BEFORE <= time <= at + AFTER] or [len(times) - 1]
    return {name: _rows(frames[name], inside) for name in ("times", "poses")}


def _rows(packed: Mapping[str, Any], rows: Sequence[int]) -> Mapping[str, Any]:
    """Return adjacent rows of an array of 32-bit numbers (``docs/schemas/trace.schema.json``)."""
    count, *rest = packed["shape"]
    data = b64decode(packed["data"])
    size = len(data) // count
    cut = data[rows[0] * size : (rows[-1] + 1) * size]
    return {**packed, "shape": [len(rows), *rest], "data": b64encode(cut).decode("ascii")}
