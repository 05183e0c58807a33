"""``robbdd replay``: simulate a stored run again and check that the traces are bit-identical."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from robbdd_tools.commands import FINDINGS, OK, signal_code
from robbdd_tools.commands.execute import follow
from robbdd_tools.commands.output import print_line, print_note
from robbdd_tools.commands.run import Outputs, report_problems
from robbdd_tools.commands.runs import print_unfinished
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.workbench.replaying import Replay
from robbdd_tools.workbench.stored import kept_store


@dataclass(frozen=True, slots=True)
class ReplayOptions:
    """The options of ``robbdd replay``.

    - ``run``: the stored run, given as a number, as ``latest`` or as a folder.
    - ``policy``: the policy of the simulation.
    - ``names``: the names of the scenarios to replay.
    - ``store``: the store of runs.
    - ``force``: simulate with the current files, even if they have changed since the run.
    """

    run: str
    policy: Policy
    names: Sequence[str] = ()
    store: Path | None = None
    force: bool = False


def replay(options: ReplayOptions) -> int:
    """Simulate the scenarios again and print for each of them whether its trace is identical.

    Returns 0 if all traces are identical, otherwise 1.
    """
    return report_problems(Outputs(), viewer=False, work=lambda: _replay(options))


def _replay(options: ReplayOptions) -> int:
    place = kept_store(Path(), options.store).find(options.run)
    record, status = place.record(), place.status()
    with tempfile.TemporaryDirectory(prefix="robbdd-") as folder:
        replay = Replay(place, Path(folder), options.policy, options.names, force=options.force)
        print_unfinished(place, status)
        ended_by = follow(replay, replay.total)
        if ended_by:
            return signal_code(ended_by)
        simulator = status.simulator or record.simulator
        if simulator != replay.simulator:
            print_note(f"robbdd: the run was made with {simulator}, this is {replay.simulator}")
        for name in replay.without_trace:
            print_line(f"{name}: the run kept no trace of it")
        traces = replay.traces()
    for trace in traces:
        print_line(f"{trace.name}: {trace.difference or 'the same to the last bit'}")
    same = sum(not trace.difference for trace in traces)
    print_line(f"{same} of {len(traces)} traces are the same")
    return OK if same == len(traces) else FINDINGS
