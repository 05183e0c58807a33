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
    """A run, from its request on.

    ``progress`` is its progress token, unique among runs. ``judged`` are its scenarios by their position in the
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
        """Set the prepared run; cancel it if a cancellation arrived during preparation."""
        self.run = run
        if self.cancelled:
            run.cancel()

    def cancel(self) -> None:
        """Cancel the run; during preparation, cancel it as soon as it is prepared."""
        self.cancelled = True
        if self.run is not None:
            self.run.cancel()
