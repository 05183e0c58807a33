"""Check that a stored run's model and files are unchanged, so that it can be replayed or resumed."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.run.used_files import added, changed
from robbdd_tools.workbench.model import Model, load_all

if TYPE_CHECKING:
    from robbdd_tools.run.store import StoredRun


def model_now(place: StoredRun) -> Model | str:
    """Return the current model of a stored run, or the reason why it cannot be run. Raises ``NoSuchRun``."""
    shown, paths = place.record().path, place.models()
    if not all(path.exists() for path in paths):
        return f"the model of the run, {shown}, is gone"
    try:
        model = load_all(paths)
        _ = model.runnable
    except RobbddError as error:
        return (
            f"the model of the run, {shown}, cannot be run in its current state: {'; '.join(str(error).splitlines())}"
        )
    return model


def refusal(place: StoredRun, model: Model | str) -> str:
    """Return what has changed since the run and what to do; empty if nothing has changed. Raises ``NoSuchRun``."""
    record = place.record()
    for paths, deed in (
        (changed(record.files, place.folder), "changed"),
        (added(record.files, place.manifest(), place.folder), "added"),
    ):
        if paths:
            names = ", ".join(map(os.path.relpath, paths))
            return f"{names} {'was' if len(paths) == 1 else 'were'} {deed} since the run"
    if isinstance(model, str):
        return model
    if model.digest != record.digest:
        digests = f"its graph's digest is {model.digest[:12]}, the run's {record.digest[:12]}"
        return f"{record.path} was changed since the run ({digests})"
    return ""
