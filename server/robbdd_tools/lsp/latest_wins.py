"""Run tasks if only the latest one matters. A running task is replaced at most ``MAX_REPLACED`` times in a row."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from typing import Any

Work = Callable[[], Coroutine[Any, Any, None]]
MAX_REPLACED = 8
"""After this many replacements in a row, about a second of fast typing, a task may finish and show its findings."""


class LatestWins:
    """Runs one task at a time for each key.

    A newer task replaces the running one. After ``MAX_REPLACED`` replacements, the newer task waits until the running
    one ends. ``spawn`` starts a coroutine as a task.
    """

    def __init__(self, spawn: Callable[[Coroutine[Any, Any, None]], asyncio.Task[None]]) -> None:
        self._spawn = spawn
        self._running: dict[str, asyncio.Task[None]] = {}
        self._replaced: dict[str, int] = {}
        self._waiting: dict[str, Work] = {}

    def begin(self, key: str, work: Work) -> None:
        """Run ``work`` as the latest task of this key; see the class for the task that is running."""
        running = self._running.get(key)
        if running is not None:
            replaced = self._replaced.get(key, 0)
            if replaced == MAX_REPLACED:
                self._waiting[key] = work
                return
            self._replaced[key] = replaced + 1
            running.cancel()
        self._start(key, work)

    def end(self, key: str) -> None:
        """Cancel the running task and the waiting task of a key."""
        self._waiting.pop(key, None)
        self._replaced.pop(key, None)
        running = self._running.pop(key, None)
        if running is not None:
            running.cancel()

    def _start(self, key: str, work: Work) -> None:
        task = self._spawn(work())
        self._running[key] = task
        task.add_done_callback(lambda done: self._ended(key, done))

    def _ended(self, key: str, done: asyncio.Task[None]) -> None:
        if self._running.get(key) is not done:
            return
        del self._running[key]
        self._replaced.pop(key, None)
        waiting = self._waiting.pop(key, None)
        if waiting is not None:
            self._start(key, waiting)
