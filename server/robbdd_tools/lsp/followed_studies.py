"""Show the progress of studies that any process executes, as work-done progress of the protocol.

The command line executes a study, in a terminal or as a task of the editor. Its lock says that it is executed, and its
store has the results.
"""

from __future__ import annotations

import asyncio
import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import uri_to_path
from robbdd_tools.lsp.work_done import WorkDone
from robbdd_tools.run.store import FOLDER
from robbdd_tools.run.study_schema import NAME
from robbdd_tools.syntax.study_content import STUDY

if TYPE_CHECKING:
    from robbdd_tools.campaign.study_progress import Tally
    from robbdd_tools.lsp.server import RobbddServer

PAUSE = 2.0
"""Seconds between two looks at the studies. After a look that takes long, the pause is ``SHARE`` times as long."""
SHARE = 20
SUFFIX = f".{STUDY}"
STUDIES = FOLDER.parent / "studies"


@dataclass(slots=True)
class _Followed:
    """A study in progress: its progress in the editor, and when it was first seen (s) with how many executions."""

    shown: WorkDone
    since: float
    before: int
    words: str = ""


@dataclass(frozen=True, slots=True)
class _State:
    """The state of a study: its name, the number of its executions, and the verdicts so far."""

    name: str
    total: int
    tally: Tally


class FollowedStudies:
    """The studies in progress of the projects in the workspace folders and around open ``.study`` files."""

    def __init__(self, server: RobbddServer) -> None:
        self._server = server
        self._followed: dict[Path, _Followed] = {}
        self._number = 0

    async def follow(self) -> None:
        """Show the progress of studies for as long as the server runs, if the client shows progress."""
        window = self._server.client_capabilities.window
        while window is not None and window.work_done_progress:
            began = monotonic()
            await self.look()
            await asyncio.sleep(max(PAUSE, SHARE * (monotonic() - began)))

    async def look(self) -> None:
        """Read the state of all studies once, and show what has changed."""
        opened = filter(None, map(uri_to_path, self._server.opened()))
        paths = [path for path in opened if path.suffix == SUFFIX]
        folders = [folder / STUDIES for folder in self._server.folders()]
        states = await asyncio.to_thread(lambda: dict(_executed(folders, paths)))
        for folder, state in states.items():
            if folder not in self._followed:
                self._number += 1
                shown = WorkDone(self._server, f"robbdd-study-{self._number}")
                self._followed[folder] = _Followed(shown, monotonic(), state.tally.finished)
                await shown.begin(f"Study {state.name}")
            self._report(self._followed[folder], state)
        for folder in self._followed.keys() - states.keys():
            followed = self._followed.pop(folder)
            last = await asyncio.to_thread(_state, folder)
            followed.shown.end(followed.words if last is None else _words(last.tally, last.total, 0.0))

    def _report(self, followed: _Followed, state: _State) -> None:
        seconds = monotonic() - followed.since
        made = state.tally.finished - followed.before
        words = _words(state.tally, state.total, made / seconds if made > 0 and seconds > 0 else 0.0)
        if words != followed.words:
            followed.words = words
            followed.shown.report(words, state.tally.finished, max(state.total, 1))


def _executed(folders: Iterable[Path], paths: Iterable[Path]) -> Iterator[tuple[Path, _State]]:
    """Yield the studies that are executed now, each with the folder of its results.

    ``folders`` contain results of studies, and ``paths`` are files of studies.
    """
    from robbdd_tools.campaign.study_place import is_executed, study_folder

    found = chain((one for folder in folders for one in _stores(folder)), map(study_folder, paths))
    for place in dict.fromkeys(one.absolute() for one in found):
        state = _state(place) if is_executed(place) else None
        if state is not None:
            yield place, state


def _stores(folder: Path) -> Iterator[Path]:
    """Yield the folders of results below a folder. Their traces and batches are not searched."""
    for path, inner, files in os.walk(folder):
        if NAME in files:
            inner.clear()
            yield Path(path)


def _state(folder: Path) -> _State | None:
    """Return the state of a study; ``None`` if its results cannot be read, for example just after its begin."""
    from robbdd_tools.campaign.study_place import open_results, tally_so_far

    try:
        with open_results(folder) as store:
            return _State(store.fact("name") or "", int(store.fact("total") or 0), tally_so_far(folder, store))
    except (OSError, RobbddError):
        return None


def _words(tally: Tally, total: int, rate: float) -> str:
    """Return the progress in words. ``rate`` is in executions per s; 0 if unknown."""
    from robbdd_tools.campaign.study_clauses import clause_words
    from robbdd_tools.campaign.study_progress import StudyProgress

    parts = [StudyProgress(total, tally, rate).words]
    failed = tally.finished - tally.holding
    if tally.finished:
        parts.append(f"{tally.holding:,} hold ({tally.holding / tally.finished:.0%}), {failed:,} do not")
    worst = tally.worst()
    if worst is not None:
        parts.append(f"worst clause: {clause_words(worst[0])}")
    return "; ".join(parts)
