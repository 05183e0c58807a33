"""Acceptance tests of robots: load, check, plan, run and judge RobBDD models (docs/python.md).

The names in ``__all__`` are the public interface; everything else may change without notice. They are imported at first
use, so that importing the package stays cheap.
"""

from __future__ import annotations

import warnings
from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Severity
    from robbdd_tools.base.exceptions import RobbddError
    from robbdd_tools.campaign.compare_runs import compare
    from robbdd_tools.campaign.effects import MarginEffect, Rate, RateEffect
    from robbdd_tools.campaign.gate import NotAGate
    from robbdd_tools.campaign.matched_executions import MatchedRuns, NothingShared
    from robbdd_tools.campaign.rates import Interval, StatisticsNotInstalled, rate_interval
    from robbdd_tools.campaign.run_comparison import Change, ClauseEffect, Decision, RunComparison
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
    from robbdd_tools.workbench.model import Model, ModelErrors, NothingToRun, load
    from robbdd_tools.workbench.named_files import NotAModel
    from robbdd_tools.workbench.plan import Coverage, Plan
    from robbdd_tools.workbench.replaying import CannotReplay, Replayed, ReplayedTrace, replay
    from robbdd_tools.workbench.run import Run
    from robbdd_tools.workbench.stored import PastRun, find_run, runs
    from robbdd_tools.workbench.time_estimate import TimeEstimate

_HOMES = {
    "CannotReplay": "workbench.replaying",
    "Change": "campaign.run_comparison",
    "ClauseEffect": "campaign.run_comparison",
    "ClauseResult": "workbench.execution_rows",
    "Coverage": "workbench.plan",
    "Decision": "campaign.run_comparison",
    "EventStamp": "monitor.trace",
    "ExecutionResult": "workbench.execution_rows",
    "Finding": "workbench.diagnostics",
    "Interval": "campaign.rates",
    "Judged": "workbench.judging",
    "JudgedLog": "workbench.log_judging",
    "Keeping": "workbench.folder",
    "MarginEffect": "campaign.effects",
    "MatchedRuns": "campaign.matched_executions",
    "Model": "workbench.model",
    "ModelErrors": "workbench.model",
    "NoSuchRun": "run.store",
    "NotAGate": "campaign.gate",
    "NotAModel": "workbench.named_files",
    "NotOneScenario": "workbench.log_judging",
    "NothingShared": "campaign.matched_executions",
    "NothingToJudge": "workbench.judging",
    "NothingToRun": "workbench.model",
    "Outcome": "monitor.verdict",
    "PastRun": "workbench.stored",
    "Place": "workbench.diagnostics",
    "Plan": "workbench.plan",
    "QuickFix": "workbench.diagnostics",
    "Rate": "campaign.effects",
    "RateEffect": "campaign.effects",
    "RelatedPlace": "workbench.diagnostics",
    "Replayed": "workbench.replaying",
    "ReplayedTrace": "workbench.replaying",
    "RobbddError": "base.exceptions",
    "Run": "workbench.run",
    "RunComparison": "campaign.run_comparison",
    "RunRecord": "run.store",
    "RunStatus": "run.stored_results",
    "ScenarioSpec": "protocol.specs",
    "SelectionError": "gherkin.select",
    "Severity": "base.diagnostic",
    "StatisticsNotInstalled": "campaign.rates",
    "TextEdit": "workbench.diagnostics",
    "TimeEstimate": "workbench.time_estimate",
    "Trace": "monitor.trace",
    "UnreadableLog": "logs.log_contents",
    "UnreadableTrace": "traces.mcap_file",
    "UserCodeRefused": "run.user_code",
    "compare": "campaign.compare_runs",
    "find_run": "workbench.stored",
    "judge": "workbench.judging",
    "judge_log": "workbench.log_judging",
    "load": "workbench.model",
    "rate_interval": "campaign.rates",
    "replay": "workbench.replaying",
    "runs": "workbench.stored",
}

__all__ = [
    "CannotReplay",
    "Change",
    "ClauseEffect",
    "ClauseResult",
    "Coverage",
    "Decision",
    "EventStamp",
    "ExecutionResult",
    "Finding",
    "Interval",
    "Judged",
    "JudgedLog",
    "Keeping",
    "MarginEffect",
    "MatchedRuns",
    "Model",
    "ModelErrors",
    "NoSuchRun",
    "NotAGate",
    "NotAModel",
    "NotOneScenario",
    "NothingShared",
    "NothingToJudge",
    "NothingToRun",
    "Outcome",
    "PastRun",
    "Place",
    "Plan",
    "QuickFix",
    "Rate",
    "RateEffect",
    "RelatedPlace",
    "Replayed",
    "ReplayedTrace",
    "RobbddError",
    "Run",
    "RunComparison",
    "RunRecord",
    "RunStatus",
    "ScenarioSpec",
    "SelectionError",
    "Severity",
    "StatisticsNotInstalled",
    "TextEdit",
    "TimeEstimate",
    "Trace",
    "UnreadableLog",
    "UnreadableTrace",
    "UserCodeRefused",
    "compare",
    "find_run",
    "judge",
    "judge_log",
    "load",
    "rate_interval",
    "replay",
    "runs",
]


_REPLACED: dict[str, str] = {}
"""Each name that goes in the next version, and the name that replaces it."""


def __getattr__(name: str) -> Any:
    if (new := _REPLACED.get(name)) is not None:
        warnings.warn(f"{__name__}.{name} goes in the next version: write {new}", DeprecationWarning, stacklevel=2)
        name = new
    if name not in _HOMES:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
