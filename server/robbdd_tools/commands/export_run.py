"""``robbdd export``: write the traces of a stored run as bags of ROS 2."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from robbdd_tools.commands import OK
from robbdd_tools.commands.output import print_line
from robbdd_tools.commands.run import Outputs, report_problems
from robbdd_tools.workbench.bag_export import export_bags
from robbdd_tools.workbench.stored import store_at


@dataclass(frozen=True, slots=True)
class ExportOptions:
    """The options of ``robbdd export``: the run, the folder of the bags, and their storage."""

    run: str
    output: Path
    names: Sequence[str] = ()
    store: Path | None = None
    mcap: bool = False


def export_run(options: ExportOptions) -> int:
    """Write the bags and print their folders. Return the exit code."""
    return report_problems(Outputs(), viewer=False, work=lambda: _export(options))


def _export(options: ExportOptions) -> int:
    place = store_at(Path(), options.store).find(options.run)
    for folder in export_bags(place, options.output, options.names, mcap=options.mcap):
        print_line(str(folder))
    return OK
