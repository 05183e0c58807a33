"""``robbdd study replay``: execute executions of a study again, with traces."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.campaign.study_file import load_study
from robbdd_tools.campaign.study_place import open_results, study_folder
from robbdd_tools.campaign.study_replay import StudyReplay
from robbdd_tools.commands import FAILED, FINDINGS, OK, signal_code
from robbdd_tools.commands.execute import follow_run
from robbdd_tools.commands.models import print_findings
from robbdd_tools.commands.output import print_line, print_note
from robbdd_tools.run.run_policy import Policy

if TYPE_CHECKING:
    from robbdd_tools.campaign.study_replay import Chosen


@dataclass(frozen=True, slots=True)
class ReplayOptions:
    """The options of ``robbdd study replay``. ``store`` is the folder of all studies."""

    path: Path
    chosen: Chosen
    store: Path | None = None
    jobs: int | None = None
    force: bool = False


def replay_study(options: ReplayOptions) -> int:
    """Execute the chosen executions again, and print their verdicts.

    Returns 0 if the verdicts equal those of the study, 1 if not, 2 if the executions could not be made. Raises
    ``RobbddError`` and ``OSError``.
    """
    study = load_study(options.path)
    print_findings((one for one in study.findings if one.is_error), print_note)
    if any(one.is_error for one in study.findings):
        return FAILED
    folder = study_folder(options.path, options.store)
    differ = False
    with open_results(folder) as store:
        executions = options.chosen.executions(store)
        replay = StudyReplay(study, store, folder, force=options.force)
        for begun, own in replay.runs(executions, Policy.of(jobs=options.jobs)):
            with begun as run:
                ended_by = follow_run(run)
            print_note(f"kept in {run.folder}, with traces")
            if ended_by or run.problem or run.ending:
                print_note(f"robbdd: {run.problem or run.ending}")
                return signal_code(ended_by) if ended_by else FAILED
            for number, words in replay.differences(run, own).items():
                differ = True
                print_line(f"execution {number} differs from the study: {words}")
    if not differ:
        print_line(f"{len(executions)} of {len(executions)} executions have the verdicts and margins of the study")
    return FINDINGS if differ else OK
