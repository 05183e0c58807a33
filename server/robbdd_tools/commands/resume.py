"""``robbdd run --resume``: continue an unfinished run as if it had never been interrupted."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.commands.execute import follow_run
from robbdd_tools.commands.output import print_note
from robbdd_tools.commands.run import Outputs, conclude, report_problems, viewed_policy
from robbdd_tools.workbench.resuming import resume as resumed
from robbdd_tools.workbench.resuming import stored_policy, unfinished_run
from robbdd_tools.workbench.stored import kept_store

if TYPE_CHECKING:
    from robbdd_tools.run.run_policy import Policy
    from robbdd_tools.run.stored_results import RunStatus


@dataclass(frozen=True, slots=True)
class ResumeOptions:
    """The options of ``robbdd run --resume``.

    They are the run (a number, ``latest`` or a folder), the model if it is given, and the settings with which to
    continue. If ``jobs``, ``timeout`` (s) or ``stop_on_failure`` is given, it replaces the setting of the run.
    """

    run: str
    path: Path | None
    outputs: Outputs
    jobs: int | None = None
    timeout: float | None = None
    stop_on_failure: bool = False
    viewer: bool = False


def resume(options: ResumeOptions) -> int:
    """Execute the open scenarios of a run; return the same exit code as ``robbdd run``."""
    return report_problems(options.outputs, viewer=options.viewer, work=lambda: _resume(options))


def _resume(options: ResumeOptions) -> int:
    store = kept_store(options.path or Path(), options.outputs.keeping.store)
    place = unfinished_run(store, options.run, options.path)
    path, status = place.record().path, place.status()
    with resumed(place, lambda stored: _policy(options, stored)) as run:
        print_note(f"robbdd: resuming run {place.number or place.folder} of {path}; {status.words()}")
        ended_by = follow_run(run, every_clause=options.outputs.every_clause)
        return conclude(run, options.outputs, ended_by)


def _policy(options: ResumeOptions, status: RunStatus) -> Policy:
    policy = stored_policy(status)
    policy = replace(policy, stop_on_failure=options.stop_on_failure or policy.stop_on_failure)
    policy = policy if options.timeout is None else replace(policy, timeout=options.timeout)
    return viewed_policy(policy if options.jobs is None else replace(policy, jobs=options.jobs), viewer=options.viewer)
