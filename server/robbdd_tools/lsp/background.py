"""A thread for work that takes longer than a keystroke may wait: graphs, features, the model of a run."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

from robbdd_tools.base.memory import collect_recent
from robbdd_tools.names.project import Project, Snapshot

Result = TypeVar("Result")


class Background:
    """Works on a project of its own, so that it shares no state with the analysis of keystrokes."""

    def __init__(self) -> None:
        self._project = Project()
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="background")

    async def work(
        self, texts: Mapping[str, tuple[int, str]], work: Callable[[Snapshot], Result], *unopened: str
    ) -> Result:
        """Run ``work`` on the files on disk under the open ``texts`` (version and text by URI).

        The snapshot knows the open files, the ``unopened`` ones that are named, and what these import.
        """

        def on_snapshot() -> Result:
            self._project.replace(texts)
            for uri in unopened:
                self._project.load(uri)
            try:
                return work(self._project.snapshot())
            finally:
                collect_recent()

        return await asyncio.get_running_loop().run_in_executor(self._thread, on_snapshot)

    def stop(self) -> None:
        """Begin nothing more."""
        self._thread.shutdown(wait=False, cancel_futures=True)
