"""Hooks of behave: they hold the simulated world while behave goes through the scenarios.

behave has no types; this module and ``steps`` are the only ones that see its objects.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from robbdd_tools.agent.channel import current_channel
from robbdd_tools.agent.session import Session
from robbdd_tools.monitor.verdict import Cause, Outcome, Verdict, unknown
from robbdd_tools.protocol.manifest_file import MANIFEST, read_manifest
from robbdd_tools.user_code.calls import fault_of, original

__all__ = ["after_all", "after_scenario", "after_step", "before_all", "before_scenario"]
EXECUTION = "robbdd.execution"
"""Where behave's user data holds which scenario of the manifest is being executed: several may share a feature's."""


def before_all(context: Any) -> None:
    """Read the manifest that lies beside the features folder; raises ``OSError`` or ``ValueError``."""
    folder = Path(context.config.base_dir).resolve().parent
    if not (folder / MANIFEST).is_file():
        raise OSError(f"there is no {MANIFEST} in {folder}: run a folder that 'robbdd run' has written")
    context.session = Session(folder, read_manifest(folder), current_channel())


def before_scenario(context: Any, scenario: Any) -> None:
    """Read the scenario's steps ahead, so that its world knows which behaviours are to come."""
    # A failed clause says nothing about the others: each gets its verdict.
    scenario.continue_after_failed_step = True
    texts = [(int(step.line), str(step.step_type), str(step.name)) for step in scenario.all_steps]
    handed_out = context.config.userdata.get(EXECUTION)
    index = None if handed_out is None else int(handed_out)
    context.session.start(Path(scenario.filename), int(scenario.line), texts, index)


def after_step(context: Any, step: Any) -> None:
    """Tell the outcome of a step that a user's own function carried out; ours have reported their verdict already."""
    sources = context.session.sources
    context.session.take_verdict(int(step.line), _verdict(step, sources))


def after_scenario(context: Any, _scenario: Any) -> None:
    """Give the clauses that are still open their verdict."""
    context.session.finish()


def after_all(context: Any) -> None:
    """Give a scenario that was broken off its verdict."""
    session = getattr(context, "session", None)
    if session is not None:
        session.finish()


def _verdict(step: Any, sources: Mapping[str, str]) -> Verdict:
    """Return what the outcome of a step says of its clause: a failed assertion violates it.

    ``sources`` maps copies of files of steps to the files that users edit.
    """
    error: BaseException | None = step.exception
    said = " ".join(str(error or "").split())
    match str(step.status.name):
        case "passed":
            return Verdict(Outcome.HOLDS)
        case "failed":
            return Verdict(Outcome.VIOLATED, reason=said)
        case status if error is None:
            return unknown(f"behave calls the step {status}", Cause.NO_STEP if status == "undefined" else Cause.SKIPPED)
        case _:
            fault = original(fault_of(error.with_traceback(step.exc_traceback), str(step.name)), sources)
            words = f"the step failed: {type(error).__name__}" + (f": {said}" if said else "")
            return unknown(words, Cause.USER_CODE, fault=fault)
