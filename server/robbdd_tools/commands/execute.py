"""Show a run, a replay or a judgement on the terminal while it executes. A signal ends it cleanly."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Protocol

from robbdd_tools.base.processes import end_requests
from robbdd_tools.commands.progress import Display
from robbdd_tools.commands.rate_lines import MANY

if TYPE_CHECKING:
    from robbdd_tools.protocol.messages import RunMessage
    from robbdd_tools.run.results import RunResults
    from robbdd_tools.workbench.run import Run

INTERRUPTED = "the run was interrupted"


class Followed(Protocol):
    """Common interface of a run, a replay and a judgement."""

    progress: RunResults
    ending: str

    def messages(self) -> Iterator[RunMessage]:
        """Yield the messages in the order of the manifest."""
        ...

    def cancel(self, reason: str) -> None:
        """End the work early for the given reason."""
        ...


def follow_run(run: Run, *, every_clause: bool = False) -> int:
    """Execute a run and show its progress. Return the number of the signal that ended the run, or 0.

    If there are more than ``MANY`` scenarios, only failures and pass rates are shown, unless ``every_clause`` is true.
    """

    def watching(display: Display) -> None:
        run.listen(display.watch)

    brief = not every_clause and len(run.progress.scenarios) > MANY
    return _follow(run, Display(run.progress, brief=brief), watching)


def follow(work: Followed, total: int | None = None, made: str = "simulated in", *, live: bool = False) -> int:
    """Show the progress of a replay or a judgement of ``total`` scenarios; ``made`` and ``live`` are as in ``Display``.

    Raises ``OSError``. Returns the number of the signal that ended it, or 0.
    """
    return _follow(work, Display(work.progress, total, made, live=live), None)


def _follow(work: Followed, showing: Display, watching: Callable[[Display], None] | None) -> int:
    ended_by = 0

    def cancel(number: int) -> None:
        nonlocal ended_by
        ended_by = number
        work.cancel(INTERRUPTED)

    with showing as display:
        if watching is not None:
            watching(display)
        with end_requests(cancel):
            for message in work.messages():
                if watching is None:
                    display.watch(message)
                display.show(message)
        if not work.progress.complete:
            work.progress.close(work.ending)
            display.broken(work.progress.ending)
        display.summary(work.progress)
    return ended_by
