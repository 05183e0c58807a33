"""Show the progress of a study: drawn in place on a terminal, elsewhere as a line from time to time."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from time import monotonic
from types import TracebackType
from typing import TYPE_CHECKING, Self

from rich.console import Group
from rich.live import Live
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from robbdd_tools.campaign.study_progress import StudyProgress
from robbdd_tools.commands.output import print_note
from robbdd_tools.commands.study_standing import measured_words, standing
from robbdd_tools.commands.terminal import plain, terminal

if TYPE_CHECKING:
    from rich.console import RenderableType

    from robbdd_tools.campaign.study_progress import WorkerState
    from robbdd_tools.campaign.study_run import StudyRun

PAUSE = 10.0
"""Seconds between two lines of progress."""
REDRAWN = 2
"""How many times per second the progress is redrawn."""
MOST_WORKERS = 16
"""Maximum number of workers that are listed."""
MOST_WARNINGS = 10
"""Maximum number of warnings of agents that are printed."""
MEASURED = 10
"""Maximum number of executions after which the duration of the study is stated."""
BAR = 40
"""Columns of the bar."""


class StudyDisplay:
    """Shows the progress of a study on standard error. Use it as a context manager.

    If the terminal can move its cursor, the progress is redrawn in place. Otherwise, a line without the workers is
    printed every ``PAUSE`` seconds.

    ``measures`` is true if no earlier execution gives the time of the study, which is then stated after its first
    executions. ``jobs`` is the number of executions at a time.
    """

    def __init__(self, run: StudyRun, *, jobs: int = 1, measures: bool = False) -> None:
        self._run = run
        self._measured = max(jobs, min(MEASURED, run.total // MEASURED)) if measures else None
        self._warnings = 0
        self._latest: StudyProgress | None = None
        self._note = ""
        self._printed = monotonic()
        console = terminal(stderr=True)
        self._live: Live | None = None
        if console.is_terminal and not console.is_dumb_terminal:
            self._live = Live(
                console=console, get_renderable=self.drawn, refresh_per_second=REDRAWN, transient=True,
                redirect_stdout=False,
            )  # fmt: skip

    def __enter__(self) -> Self:
        if self._live is not None:
            self._live.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None):
        if self._live is not None:
            self._live.stop()

    def update(self, progress: StudyProgress) -> None:
        """Show the latest progress."""
        self._latest = progress
        if self._measured is not None and progress.made >= self._measured:
            self._measured = None
            print_note(f"robbdd: {measured_words(progress)}")
        if self._live is None and monotonic() - self._printed >= PAUSE:
            self._printed = monotonic()
            print_note("; ".join((progress.words, *standing(progress.tally))))

    def warn(self, text: str) -> None:
        """Print a warning of an agent. Only the first ``MOST_WARNINGS`` are printed."""
        self._warnings += 1
        if self._warnings <= MOST_WARNINGS:
            print_note(f"robbdd: {text}")
        elif self._warnings == MOST_WARNINGS + 1:
            print_note("robbdd: further warnings are not printed")

    def note(self, text: str) -> None:
        """Show a remark on how the study ends. A signal handler may call it."""
        self._note = text
        if self._live is None:
            # The handler may interrupt ``print`` itself.
            with suppress(OSError, ValueError):
                os.write(sys.stderr.fileno(), f"robbdd: {text}\n".encode())

    def drawn(self) -> RenderableType:
        """Return the drawing for a terminal: the progress, the verdicts so far, and the work of each worker."""
        progress = self._latest or StudyProgress(self._run.total, self._run.tally)
        bar = Table.grid(padding=(0, 1))
        bar.add_row(ProgressBar(progress.total, progress.finished, width=BAR), Text(progress.words))
        lines: list[RenderableType] = [bar, *map(plain, standing(progress.tally))]
        workers = self._run.workers()
        lines += map(_worker_line, workers[:MOST_WORKERS])
        if len(workers) > MOST_WORKERS:
            lines.append(Text(f"  … and {len(workers) - MOST_WORKERS} more workers"))
        return Group(*lines, *([plain(self._note, "yellow")] if self._note else []))


def _worker_line(worker: WorkerState) -> Text:
    since = "" if worker.seconds is None else f"  {worker.seconds:.0f} s"
    line = plain(f"  {worker.name}: {worker.work}{since}")
    line.no_wrap, line.overflow = True, "ellipsis"
    return line
