"""Thread for work that must not delay keystrokes: graphs, features, the model of a run."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

from robbdd_tools.base.memory import collect_recent
from robbdd_tools.names.project import Project, Snapshot

Result = TypeVar("Result")


class Background:
    """Executes work in a thread on a project of its own, so that it shares no state with the analysis thread."""

    def __init__(self) -> None:
        self._project = Project()
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="background")

    async def work(
        self, texts: Mapping[str, tuple[int, str]], work: Callable[[Snapshot], Result], *unopened: str
    ) -> Result:
        """Call ``work`` with a snapshot of files on disk and of open files, and return its result.

        ``texts`` maps the URI of each open file to its version and text, which replace the file on disk. The snapshot
        contains the open files, the files ``unopened``, and the imports of all of them.
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
        """Start no further work."""
        self._thread.shutdown(wait=False, cancel_futures=True)
