"""Choose where a run is stored: in the project's store, in another store, in a separate folder, or not at all."""

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
    """Where a run is stored.

    If ``folder`` is given, the run is stored there. Otherwise it is stored in ``store``, which is the project's store
    by default. If ``keep`` is false, a temporary folder is used instead.
    """

    folder: Path | None = None
    store: Path | None = None
    keep: bool = True


@dataclass(frozen=True, slots=True)
class RunFolder:
    """A new run folder. ``remark`` is a note for the user, and ``remove`` deletes a temporary folder."""

    place: StoredRun
    remark: str = ""
    remove: Callable[[], None] = lambda: None


def new_folder(model: Path, keeping: Keeping) -> RunFolder:
    """Create the folder of a new run of a model. Raises ``OSError``.

    If the store cannot be written, the folder is a temporary one.
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
