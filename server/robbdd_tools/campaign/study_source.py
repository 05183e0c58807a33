"""Find the stored results of a study: by its ``.study`` file, or by the folder that they are in."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.campaign.study_file import SUFFIX
from robbdd_tools.campaign.study_place import has_results, open_results, study_folder

if TYPE_CHECKING:
    from robbdd_tools.run.study_reader import StudyReader


def names_study(word: str) -> bool:
    """Return whether a word of the command line names a study: its file, or a folder with its results."""
    return word.endswith(SUFFIX) or has_results(Path(word))


@contextmanager
def stored_study(word: str, store: Path | None) -> Generator[StudyReader]:
    """Open the results of the study that ``word`` names; ``store`` is another folder of results.

    Raises ``StudyProblem`` if there are none, and ``DatabaseProblem``.
    """
    with open_results(Path(word) if has_results(Path(word)) else study_folder(Path(word), store)) as results:
        yield results
