"""Show one arm alone: ``python -m robbdd_tools.agent.show_robot ARM FILE.png [GRIPPER MOUNT]``.

ARM is an MJCF or URDF file, or a name of the catalog. GRIPPER is the file of a gripper, and MOUNT the body or site of
ARM that it is fixed to. The report goes to standard output; with ``-`` as FILE.png there is no picture. Exit codes: 0
done; 2 the arm cannot be used or a file cannot be written; 3 no graphics back end works.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.graphics import NO_GRAPHICS
from robbdd_tools.catalog.executable import ArmModel, ModelSource, MountedGripper, Realisation, SceneInstance
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.protocol.specs import SceneSpec
from robbdd_tools.world.errors import SceneError

if TYPE_CHECKING:
    from robbdd_tools.world.simulation import Simulation

FAILED = 2
NAME = "view:arm"
"""Name of the agent in the displayed world."""


def show(arm: str, output: str, gripper: str = "", mount: str = "") -> int:
    """Print the report on an arm and write its picture; return the exit code. ``gripper`` is a file, if it has one."""
    try:
        from robbdd_tools.world.picture import NoPicture, require_graphics
    except Exception as error:  # the engine selects its back end on import; each fails with its own exception type
        print(f"{type(error).__name__}: {error}", file=sys.stderr)
        return NO_GRAPHICS
    source = source_of(arm)
    if gripper:
        source = replace(source, arm=ArmModel(mounted=MountedGripper("file", gripper, mount)))
    try:
        if output != "-":
            require_graphics()
        simulation = _alone(source)
        _print_report(simulation, source)
        if output != "-":
            _draw(simulation, Path(output))
    except SceneError as error:
        print(error, file=sys.stderr)
        return FAILED
    except OSError as error:
        print(f"{error.filename or output}: {error.strerror or error}", file=sys.stderr)
        return FAILED
    except NoPicture as error:
        print(error, file=sys.stderr)
        return NO_GRAPHICS
    return 0


def source_of(arm: str) -> ModelSource:
    """Return the source of a model: a robot of the catalog by its name, else a file."""
    if arm in load_catalog().robots:
        return ModelSource(f"view:{arm}", "mjcf", "catalog", arm)
    kind = "urdf" if Path(arm).suffix == ".urdf" else "mjcf"
    return ModelSource("view:model", kind, "file", arm)


def _alone(source: ModelSource) -> Simulation:
    """Return a world with one arm in front of an empty table. Raises ``SceneError``."""
    from robbdd_tools.world.composition import build_world
    from robbdd_tools.world.simulation import Simulation

    instance = SceneInstance("view:scene", elements=(Realisation(NAME, (source,)),))
    return Simulation(build_world(SceneSpec((), (NAME,), {}), 1, NAME, instance))


def _print_report(simulation: Simulation, source: ModelSource) -> None:
    from robbdd_tools.world.robot_report import as_stated, report, slides, stated

    file = None if source.kind == "catalog" else source
    for line in report(simulation, NAME, file):
        print(line)
    if file is not None:
        robot = simulation.robots[NAME].model
        print("these lines in a scene instance (.scenex) state the same; change what is wrong:")
        for line in stated(as_stated(robot, NAME, file), file, any(slides(simulation.model, NAME, robot))):
            print(f"    {line}")


def _draw(simulation: Simulation, output: Path) -> None:
    import numpy as np

    from robbdd_tools.world.picture import Camera
    from robbdd_tools.world.png import write_png

    camera = Camera(simulation, (640, 800))
    try:
        write_png(output, np.hstack([camera.take_arm(simulation.data, NAME, azimuth) for azimuth in (128.0, -142.0)]))
    finally:
        camera.close()


if __name__ == "__main__":
    sys.exit(show(*sys.argv[1:5]))
