"""``python -m robbdd_tools.agent.render RUN_FOLDER INDEX FILE.png``: a picture of a scenario's initial scene.

Exit codes: 0 done; 2 the scene cannot be set up or the file not be written; 3 nothing here can render (the
environment variable ``MUJOCO_GL`` chooses among ``egl``, ``osmesa`` and ``glfw``). Messages are on standard error.
"""

from __future__ import annotations

import sys
from pathlib import Path

from robbdd_tools.agent.errors import SceneError
from robbdd_tools.run.protocol import read_manifest

FAILED, NO_GRAPHICS = 2, 3


def render(folder: Path, index: int, output: Path) -> int:
    """Write the picture of scenario number ``index`` of a run folder; returns the exit code."""
    try:
        from robbdd_tools.agent.picture import Camera, NoPicture
    except Exception as error:  # the engine chooses its back end when it is imported; each fails in its own way
        print(f"{type(error).__name__}: {error}", file=sys.stderr)
        return NO_GRAPHICS
    from robbdd_tools.agent.execution import Execution
    from robbdd_tools.agent.png import write_png

    try:
        simulation = Execution(read_manifest(folder).scenarios[index], ()).simulation
        camera = Camera(simulation)
        write_png(output, camera.take(simulation.data))
        camera.close()
    except (SceneError, OSError) as error:
        print(error, file=sys.stderr)
        return FAILED
    except NoPicture as error:
        print(error, file=sys.stderr)
        return NO_GRAPHICS
    return 0


def _main() -> int:
    try:
        folder, index, output = sys.argv[1:]
        return render(Path(folder), int(index), Path(output))
    except ValueError:
        print("usage: python -m robbdd_tools.agent.render RUN_FOLDER INDEX FILE.png", file=sys.stderr)
        return FAILED


if __name__ == "__main__":
    sys.exit(_main())
