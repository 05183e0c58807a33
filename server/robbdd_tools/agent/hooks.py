"""The hooks of behave, which manage the simulated world while behave runs.

behave has no type information. Only this module and ``steps`` access its objects.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from robbdd_tools.agent.channel import current_channel
from robbdd_tools.agent.session import Session
from robbdd_tools.monitor.verdict import Cause, Outcome, Verdict, unknown
from robbdd_tools.protocol.fault_places import original
from robbdd_tools.protocol.manifest_file import MANIFEST, read_manifest
from robbdd_tools.user_code.calls import fault_of

__all__ = ["after_all", "after_scenario", "after_step", "before_all", "before_scenario", "before_step"]
EXECUTION = "robbdd.execution"
"""Key of behave's user data for the number in the manifest: several executions may share a feature's scenario."""


def before_all(context: Any) -> None:
    """Read the manifest in the parent folder of the features folder. Raises ``OSError`` or ``ValueError``."""
    folder = Path(context.config.base_dir).resolve().parent
    if not (folder / MANIFEST).is_file():
        raise OSError(f"there is no {MANIFEST} in {folder}: run a folder that 'robbdd run' has written")
    context.session = Session(folder, read_manifest(folder), current_channel())


def before_scenario(context: Any, scenario: Any) -> None:
    """Read the steps of the scenario in advance, so that its world knows which behaviours will follow."""
    # Execute the remaining steps after a failed one: each clause gets its own verdict.
    scenario.continue_after_failed_step = True
    texts = [(int(step.line), str(step.step_type), str(step.name)) for step in scenario.all_steps]
    handed_out = context.config.userdata.get(EXECUTION)
    index = None if handed_out is None else int(handed_out)
    context.session.start(Path(scenario.filename), int(scenario.line), texts, index)


def before_step(context: Any, step: Any) -> None:
    """Report that the judgement of a clause begins. The step may be a user's or ours."""
    context.session.step_started(int(step.line))


def after_step(context: Any, step: Any) -> None:
    """Report the outcome of a user-defined step. The steps of RobBDD have already reported their verdict."""
    sources = context.session.sources
    context.session.set_step_verdict(int(step.line), _verdict(step, sources))


def after_scenario(context: Any, _scenario: Any) -> None:
    """Report a verdict for each open clause."""
    context.session.finish()


def after_all(context: Any) -> None:
    """Report verdicts for an interrupted scenario."""
    session = getattr(context, "session", None)
    if session is not None:
        session.finish()


def _verdict(step: Any, sources: Mapping[str, str]) -> Verdict:
    """Return the verdict on a step's clause that follows from the step's outcome.

    A failed assertion violates the clause. ``sources`` maps copies of files of steps to the files that users edit.
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
