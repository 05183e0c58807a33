"""The run in progress. A server has at most one."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.features.run_verdicts import JudgedScenario
    from robbdd_tools.lsp.run_options import RunOptions
    from robbdd_tools.workbench.run import Run


@dataclass
class ActiveRun:
    """A run from the time it is requested.

    ``progress`` is its progress token, which is unique among runs. ``judged`` maps positions in the manifest to the
    run's scenarios.
    """

    options: RunOptions
    progress: str
    run: Run | None = None
    cancelled: bool = False
    judged: dict[int, JudgedScenario] = field(default_factory=dict[int, "JudgedScenario"])

    @property
    def id(self) -> str:
        """The name of the run in the messages about it."""
        return self.options.token or self.progress

    def execute(self, run: Run) -> None:
        """Set the run after it is prepared. If it was cancelled during preparation, cancel it now."""
        self.run = run
        if self.cancelled:
            run.cancel()

    def cancel(self) -> None:
        """Cancel the run. A run that is still in preparation is cancelled as soon as it is prepared."""
        self.cancelled = True
        if self.run is not None:
            self.run.cancel()
