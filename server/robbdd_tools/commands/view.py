"""``robbdd view``: render the initial scene of a scenario with labelled workspaces, or one arm."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.commands import OK
from robbdd_tools.commands.output import fail, print_line
from robbdd_tools.commands.run import Outputs, report_problems
from robbdd_tools.run.pictures import NoPictures, render_robot, render_scene
from robbdd_tools.run.user_code import refuse_user_code
from robbdd_tools.workbench.model import load, read_instances
from robbdd_tools.workbench.plan import Plan, Selection

if TYPE_CHECKING:
    from robbdd_tools.protocol.specs import Manifest


def view(path: Path, name: str | None, seed: int | None, output: Path | None, scenex: Sequence[Path]) -> int:
    """Write the picture of the scenario called ``name``, or of the first scenario. Return the exit code.

    ``scenex`` are files with scene instances for scenarios without an execution.
    """
    return report_problems(Outputs(), viewer=False, work=lambda: _view(path, name, seed, output, scenex))


def view_robot(arm: str, output: Path | None, gripper: Path | None, mount: str | None) -> int:
    """Print a report on an arm, given by its model file or its name in the catalog, and draw it; return the exit code.

    ``gripper`` is the file of a gripper that is fixed to the body or site ``mount`` of the arm's file. Without
    graphics, the report is printed all the same.
    """
    if (gripper is None) != (mount is None):
        return fail("a gripper needs both --gripper FILE and --on NAME, a body or site of the arm's file")
    mounted = () if gripper is None or mount is None else (str(gripper.expanduser().absolute()), mount)
    file = Path(arm).expanduser()
    target = output or Path(f"{file.stem}.png")
    try:
        lines, problem = render_robot(str(file.absolute()) if file.is_file() else arm, target, mounted)
    except NoPictures as error:
        return fail(str(error))
    print_line(f"{target}: {arm}" if not problem else arm)
    for line in lines:
        print_line(line)
    return fail(problem) if problem else OK


def _view(path: Path, name: str | None, seed: int | None, output: Path | None, scenex: Sequence[Path]) -> int:
    target = output or Path(f"{path.stem}.png")
    plan = Plan.of(load(path), Selection(seed=seed, instances=read_instances(scenex)))
    with tempfile.TemporaryDirectory(prefix="robbdd-") as folder:
        manifest = plan.prepare(Path(folder))
        index = _index(manifest, name)
        if index is None:
            known = dict.fromkeys(_variant(scenario.name) for scenario in manifest.scenarios)
            return fail(f"there is no scenario '{name}'; the model has {', '.join(known)}")
        refuse_user_code(replace(manifest, scenarios=(manifest.scenarios[index],)), Path(folder), judges=False)
        try:
            render_scene(Path(folder), index, target)
        except NoPictures as error:
            return fail(str(error))
    print_line(f"{target}: {manifest.scenarios[index].name}")
    return OK


def _index(manifest: Manifest, name: str | None) -> int | None:
    """Return the number of the first scenario with this name, or with a variant of this name."""
    for index, scenario in enumerate(manifest.scenarios):
        if name is None or name in (scenario.name, _variant(scenario.name)):
            return index
    return None


def _variant(scenario: str) -> str:
    return scenario.rpartition(" -- ")[0].rpartition(":")[2]
