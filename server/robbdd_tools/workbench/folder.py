"""Storage of a run: the project's store, another store, a separate folder, or none."""

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
    """Storage of a run.

    ``folder`` is a separate folder. Without it, the run goes to ``store`` (by default the project's), or to a temporary
    folder if ``keep`` is false.
    """

    folder: Path | None = None
    store: Path | None = None
    keep: bool = True


@dataclass(frozen=True, slots=True)
class RunFolder:
    """A fresh run folder; ``remark`` is a note for the user, ``remove`` deletes a temporary folder."""

    place: StoredRun
    remark: str = ""
    remove: Callable[[], None] = lambda: None


def new_folder(model: Path, keeping: Keeping) -> RunFolder:
    """Create the folder of a new run of a model; a temporary one if the store cannot be written.

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
