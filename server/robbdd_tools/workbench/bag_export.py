"""Write the traces of a stored run as bags of ROS 2."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.interpreter import run as run_module
from robbdd_tools.protocol.run_folder import trace_file
from robbdd_tools.run.user_code import refuse_user_code

if TYPE_CHECKING:
    from robbdd_tools.run.store import StoredRun

EXPORT = "robbdd_tools.agent.export_bag"


class NothingExported(RobbddError):
    """A run cannot be written as bags; the message gives the reason."""


def export_bags(place: StoredRun, out: Path, names: Collection[str] = (), *, mcap: bool = False) -> Iterator[Path]:
    """Write each execution of a run as a rosbag2, and yield its folder.

    The folder is ``out`` for a single execution, else a subfolder with the number of the execution, from 1. ``names``
    selects scenarios by name; without names, all executions with a trace are written. Raises ``NothingExported`` and
    ``UserCodeRefused``.
    """
    manifest = place.manifest()
    refuse_user_code(manifest, place.folder)
    wanted = [
        index
        for index, spec in enumerate(manifest.scenarios)
        if trace_file(place.folder, index).is_file() and (not names or not {spec.name, spec.variant}.isdisjoint(names))
    ]
    if not wanted:
        known = ", ".join(sorted({spec.name for spec in manifest.scenarios}))
        raise NothingExported(
            f"the run has no trace of {', '.join(names) or 'any scenario'}; its scenarios are {known}"
        )
    for index in wanted:
        folder = out if len(wanted) == 1 else out / str(index + 1)
        arguments = (str(place.folder.absolute()), str(index), str(folder.absolute()), "mcap" if mcap else "sqlite")
        folder.parent.mkdir(parents=True, exist_ok=True)
        done = run_module(EXPORT, *arguments)
        if done.returncode:
            raise NothingExported((done.stderr.strip().splitlines() or ["the trace cannot be exported"])[-1])
        yield folder
