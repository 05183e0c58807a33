"""Where a run is kept: the project's store, another store, a folder of its own, or nowhere."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.run.store import begin_in
from robbdd_tools.workbench.stored import store_at

if TYPE_CHECKING:
    from robbdd_tools.run.store import StoredRun


@dataclass(frozen=True, slots=True)
class Keeping:
    """Where to keep a run.

    ``folder`` is a folder of its own; else it goes to ``store`` (the project's without one), unless ``keep`` is false:
    then its folder is temporary.
    """

    folder: Path | None = None
    store: Path | None = None
    keep: bool = True


@dataclass(frozen=True, slots=True)
class RunFolder:
    """A fresh run folder; ``remark`` is what the user should know of it, ``remove`` deletes a temporary one."""

    place: StoredRun
    remark: str = ""
    remove: Callable[[], None] = lambda: None


def new_folder(model: Path, keeping: Keeping) -> RunFolder:
    """Make the folder of a new run of a model; a temporary one where the store cannot be written.

    Raises ``OSError``.
    """
    if keeping.folder is not None:
        place = begin_in(keeping.folder)
        return RunFolder(place, place.remark)
    remark = ""
    if keeping.keep:
        store = store_at(model, keeping.store)
        try:
            place = store.begin()
            return RunFolder(place, place.remark)
        except OSError as error:
            remark = f"this run is not kept: {store.folder} cannot be written: {error.strerror or error}"
    folder = tempfile.mkdtemp(prefix="robbdd-")
    return RunFolder(begin_in(Path(folder), kept=False), remark, lambda: shutil.rmtree(folder, ignore_errors=True))
