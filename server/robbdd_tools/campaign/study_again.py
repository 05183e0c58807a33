"""Execute some executions of a study again, with traces, for a page that shows them."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.campaign.study_file import load_study
from robbdd_tools.campaign.study_replay import StudyReplay
from robbdd_tools.workbench.model import ModelErrors
from robbdd_tools.workbench.stored import PastRun

if TYPE_CHECKING:
    from pathlib import Path

    from robbdd_tools.run.run_policy import Policy
    from robbdd_tools.run.study_reader import StudyReader


class NotAgain(RobbddError):
    """Repeated executions of a study ended early, or their verdicts or margins differ from the study's."""


@dataclass(frozen=True, slots=True)
class Again:
    """A run of some executions of a study. ``indices`` maps the index of each in the study to its index in the run."""

    run: PastRun
    indices: Mapping[int, int]


def execute_again(
    path: Path, store: StudyReader, chosen: Collection[int], folder: Path, policy: Policy, *, force: bool = False
) -> list[Again]:
    """Execute some executions of the study at ``path`` again, in run folders within ``folder``.

    ``store`` has the results of the study, and ``chosen`` are the indices of the executions. With ``force``, the caller
    has compared the study and its files with those of the results.

    Raises ``StudyProblem`` if the study or one of its files was changed, ``NotAgain`` if a verdict or margin differs,
    ``ModelErrors``, ``UserCodeRefused`` and ``OSError``.
    """
    study = load_study(path)
    if any(finding.is_error for finding in study.findings):
        raise ModelErrors(study.findings)
    replay = StudyReplay(study, store, folder, force=force)
    executions = [one for one in store.executions() if one.number - 1 in chosen]
    found: list[Again] = []
    for begun, own in replay.runs(executions, policy):
        with begun as run:
            for _ in run.messages():
                pass
        if run.problem or run.ending:
            raise NotAgain(run.problem or run.ending)
        for number, words in replay.differences(run, own).items():
            raise NotAgain(f"execution {number} differs from the study: {words}")
        known = {one.key: one.number - 1 for one in own}
        past = PastRun(run.place)
        keys = [(one.variant, one.variation, one.execution, one.repetition) for one in past.results]
        found.append(Again(past, {known[key]: index for index, key in enumerate(keys)}))
    return found
