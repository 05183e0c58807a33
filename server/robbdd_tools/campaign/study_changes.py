"""Find what changed since a study began, so that results of different models or files are not mixed."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools import __version__
from robbdd_tools.base.files import load_bytes
from robbdd_tools.run.prepare import FEATURES

if TYPE_CHECKING:
    from robbdd_tools.campaign.study_file import Study
    from robbdd_tools.run.store import StoredRun
    from robbdd_tools.run.study_reader import StudyReader


def changed_study(study: Study, store: StudyReader) -> str:
    """Return what changed since a study began, with a request to undo it; empty if nothing did."""
    version = store.fact("version")
    if store.fact("digest") != study.digest:
        return "the study or one of its models was changed since it began: undo that"
    if version != __version__:
        return f"RobBDD {version} began the study, and this is {__version__}: use that version"
    return ""


def used_files(place: StoredRun) -> Mapping[str, str]:
    """Return digests of the users' files that a run uses, by their paths. Raises ``OSError`` and ``NoSuchRun``."""
    steps = sorted((place.folder / FEATURES / "steps").glob("model*_steps.py"))
    own = {path.name: hashlib.sha256(load_bytes(path)).hexdigest() for path in steps}
    return dict(place.record().files) | own


def resolved_files(files: Mapping[str, str], folder: Path) -> Mapping[str, str]:
    """Return digests of files by absolute paths, for comparing runs of different folders.

    The names of files outside of the run are relative to its ``folder``; copies inside of it have a bare name.
    """
    return {str((folder / name).resolve()) if "/" in name else name: digest for name, digest in files.items()}


def changed_files(before: Mapping[str, str], now: Mapping[str, str]) -> str:
    """Return which files changed since a study began, with a request to undo it; empty if none did."""
    differing = sorted(one for one in {*before, *now} if before.get(one) != now.get(one))
    shown = ", ".join(Path(one).name for one in differing)
    return f"{shown} changed since the study began: undo that" if differing else ""
