"""The run in progress: at most one per server."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.features.run_verdicts import JudgedScenario
    from robbdd_tools.lsp.run_options import RunOptions
    from robbdd_tools.workbench.run import Run


@dataclass
class ActiveRun:
    """A run from the moment it is requested.

    ``progress`` is the token of its progress, unique among runs. ``judged`` are its scenarios by their position in the
    manifest.
    """

    options: RunOptions
    progress: str
    run: Run | None = None
    cancelled: bool = False
    judged: dict[int, JudgedScenario] = field(default_factory=dict[int, "JudgedScenario"])

    @property
    def id(self) -> str:
        """The run's name in its messages."""
        return self.options.token or self.progress

    def execute(self, run: Run) -> None:
        """Set the prepared run; it may have been cancelled while it was prepared."""
        self.run = run
        if self.cancelled:
            run.cancel()

    def cancel(self) -> None:
        """End the run; one that is still being prepared ends as soon as it is."""
        self.cancelled = True
        if self.run is not None:
            self.run.cancel()
