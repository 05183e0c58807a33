"""Find the stored results of a study: by its ``.study`` file, or by the folder that they are in."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.campaign.study_file import SUFFIX
from robbdd_tools.campaign.study_run import open_results, study_folder
from robbdd_tools.run.study_store import NAME

if TYPE_CHECKING:
    from robbdd_tools.run.study_store import StudyStore


def names_study(word: str) -> bool:
    """Return whether a word of the command line names a study: its file, or a folder with its results."""
    return word.endswith(SUFFIX) or _has_results(word)


@contextmanager
def stored_study(word: str, store: Path | None) -> Generator[StudyStore]:
    """Open the results of the study that ``word`` names; ``store`` is another folder of results.

    Raises ``StudyProblem`` if there are none, and ``DatabaseProblem``.
    """
    with open_results(Path(word) if _has_results(word) else study_folder(Path(word), store)) as results:
        yield results


def _has_results(word: str) -> bool:
    return (Path(word) / NAME).is_file()
