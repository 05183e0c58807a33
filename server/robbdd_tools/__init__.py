"""Acceptance tests of robots: load, check, plan, run and judge RobBDD models (docs/python.md).

The names in ``__all__`` are the public interface; everything else may change without notice. They are imported at first
use, so that importing the package stays cheap.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Severity
    from robbdd_tools.base.exceptions import RobbddError
    from robbdd_tools.gherkin.select import SelectionError
    from robbdd_tools.logs.log_contents import UnreadableLog
    from robbdd_tools.monitor.trace import EventStamp, Trace
    from robbdd_tools.monitor.verdict import Outcome
    from robbdd_tools.protocol.specs import ScenarioSpec
    from robbdd_tools.run.store import NoSuchRun, RunRecord
    from robbdd_tools.run.stored_results import RunStatus
    from robbdd_tools.run.user_code import UserCodeRefused
    from robbdd_tools.traces.mcap_file import UnreadableTrace
    from robbdd_tools.workbench.diagnostics import Finding, Place, QuickFix, RelatedPlace, TextEdit
    from robbdd_tools.workbench.execution_rows import ClauseResult, ExecutionResult
    from robbdd_tools.workbench.folder import Keeping
    from robbdd_tools.workbench.judging import Judged, NothingToJudge, judge
    from robbdd_tools.workbench.log_judging import JudgedLog, NotOneScenario, judge_log
    from robbdd_tools.workbench.model import Model, ModelErrors, NotAModel, NothingToRun, load
    from robbdd_tools.workbench.plan import Coverage, Plan
    from robbdd_tools.workbench.replaying import CannotReplay, Replayed, ReplayedTrace, replay
    from robbdd_tools.workbench.run import Run
    from robbdd_tools.workbench.stored import PastRun, find_run, runs
    from robbdd_tools.workbench.time_estimate import TimeEstimate

_HOMES = {
    "CannotReplay": "workbench.replaying",
    "ClauseResult": "workbench.execution_rows",
    "Coverage": "workbench.plan",
    "EventStamp": "monitor.trace",
    "ExecutionResult": "workbench.execution_rows",
    "Finding": "workbench.diagnostics",
    "Judged": "workbench.judging",
    "JudgedLog": "workbench.log_judging",
    "Keeping": "workbench.folder",
    "Model": "workbench.model",
    "ModelErrors": "workbench.model",
    "NoSuchRun": "run.store",
    "NotAModel": "workbench.model",
    "NotOneScenario": "workbench.log_judging",
    "NothingToJudge": "workbench.judging",
    "NothingToRun": "workbench.model",
    "Outcome": "monitor.verdict",
    "PastRun": "workbench.stored",
    "Place": "workbench.diagnostics",
    "Plan": "workbench.plan",
    "QuickFix": "workbench.diagnostics",
    "RelatedPlace": "workbench.diagnostics",
    "Replayed": "workbench.replaying",
    "ReplayedTrace": "workbench.replaying",
    "RobbddError": "base.exceptions",
    "Run": "workbench.run",
    "RunRecord": "run.store",
    "RunStatus": "run.stored_results",
    "ScenarioSpec": "protocol.specs",
    "SelectionError": "gherkin.select",
    "Severity": "base.diagnostic",
    "TextEdit": "workbench.diagnostics",
    "TimeEstimate": "workbench.time_estimate",
    "Trace": "monitor.trace",
    "UnreadableLog": "logs.log_contents",
    "UnreadableTrace": "traces.mcap_file",
    "UserCodeRefused": "run.user_code",
    "find_run": "workbench.stored",
    "judge": "workbench.judging",
    "judge_log": "workbench.log_judging",
    "load": "workbench.model",
    "replay": "workbench.replaying",
    "runs": "workbench.stored",
}

__all__ = [
    "CannotReplay",
    "ClauseResult",
    "Coverage",
    "EventStamp",
    "ExecutionResult",
    "Finding",
    "Judged",
    "JudgedLog",
    "Keeping",
    "Model",
    "ModelErrors",
    "NoSuchRun",
    "NotAModel",
    "NotOneScenario",
    "NothingToJudge",
    "NothingToRun",
    "Outcome",
    "PastRun",
    "Place",
    "Plan",
    "QuickFix",
    "RelatedPlace",
    "Replayed",
    "ReplayedTrace",
    "RobbddError",
    "Run",
    "RunRecord",
    "RunStatus",
    "ScenarioSpec",
    "SelectionError",
    "Severity",
    "TextEdit",
    "TimeEstimate",
    "Trace",
    "UnreadableLog",
    "UnreadableTrace",
    "UserCodeRefused",
    "find_run",
    "judge",
    "judge_log",
    "load",
    "replay",
    "runs",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
