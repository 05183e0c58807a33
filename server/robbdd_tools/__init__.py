"""Acceptance tests of robots: load, check, plan, run and judge RobBDD models (docs/python.md).

The names in ``__all__`` are the public interface; everything else may change without notice. They are imported when
they are first used, so that importing the package stays cheap.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Severity
    from robbdd_tools.base.exceptions import RobbddError
    from robbdd_tools.gherkin.select import SelectionError
    from robbdd_tools.monitor.trace import Trace
    from robbdd_tools.monitor.verdict import Outcome
    from robbdd_tools.run.store import NoSuchRun
    from robbdd_tools.workbench.executions import ClauseResult, ExecutionResult
    from robbdd_tools.workbench.findings import Finding
    from robbdd_tools.workbench.folder import Keeping
    from robbdd_tools.workbench.model import Model, ModelErrors, NotAModel, NothingToRun, load
    from robbdd_tools.workbench.plan import Plan
    from robbdd_tools.workbench.run import Run
    from robbdd_tools.workbench.stored import PastRun, find_run, runs

_HOMES = {
    "ClauseResult": "workbench.executions",
    "ExecutionResult": "workbench.executions",
    "Finding": "workbench.findings",
    "Keeping": "workbench.folder",
    "Model": "workbench.model",
    "ModelErrors": "workbench.model",
    "NoSuchRun": "run.store",
    "NotAModel": "workbench.model",
    "NothingToRun": "workbench.model",
    "Outcome": "monitor.verdict",
    "PastRun": "workbench.stored",
    "Plan": "workbench.plan",
    "RobbddError": "base.exceptions",
    "Run": "workbench.run",
    "SelectionError": "gherkin.select",
    "Severity": "base.diagnostic",
    "Trace": "monitor.trace",
    "find_run": "workbench.stored",
    "load": "workbench.model",
    "runs": "workbench.stored",
}

__all__ = [
    "ClauseResult",
    "ExecutionResult",
    "Finding",
    "Keeping",
    "Model",
    "ModelErrors",
    "NoSuchRun",
    "NotAModel",
    "NothingToRun",
    "Outcome",
    "PastRun",
    "Plan",
    "RobbddError",
    "Run",
    "SelectionError",
    "Severity",
    "Trace",
    "find_run",
    "load",
    "runs",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
