"""``robbdd view``: a picture of a scenario's initial scene, with its workspaces labelled."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.files import path_to_uri
from robbdd_tools.commands import FAILED, OK
from robbdd_tools.commands.models import sound_model
from robbdd_tools.run.prepare import RunRequest, prepare

if TYPE_CHECKING:
    from robbdd_tools.run.protocol import Manifest

BACK_ENDS = ("egl", "osmesa")
"""Ways to render without a display, best first."""
NO_GRAPHICS = 3
"""Exit code of the rendering process when a back end does not work."""
ADVICE = (
    "nothing here can render without a display: install EGL (libegl1 and libgl1) or OSMesa (libosmesa6), "
    "or set MUJOCO_GL=glfw where there is a display"
)


def view(path: Path, name: str | None, seed: int | None, output: Path | None) -> int:
    """Write the picture of the first scenario, or of that called ``name``; returns the exit code."""
    from robbdd_tools.graph.build import build_graph
    from robbdd_tools.graph.read import read_model

    snapshot = sound_model(path)
    if snapshot is None:
        return FAILED
    model = read_model(build_graph(snapshot, path_to_uri(path)).graph)
    target = output or Path(f"{path.stem}.png")
    with tempfile.TemporaryDirectory(prefix="robbdd-") as folder:
        request = RunRequest(model, str(path)) if seed is None else RunRequest(model, str(path), seed)
        manifest = prepare(request, Path(folder))
        index = _index(manifest, name)
        if index is None:
            known = dict.fromkeys(_variant(scenario.name) for scenario in manifest.scenarios)
            wanted = "no scenario" if name is None else f"no scenario '{name}'; the model has {', '.join(known)}"
            print(f"robbdd: there is {wanted}", file=sys.stderr)
            return FAILED
        problem = _render(Path(folder), index, target)
    if problem:
        print(f"robbdd: {problem}", file=sys.stderr)
        return FAILED
    print(f"{target}: {manifest.scenarios[index].name}")
    return OK


def _index(manifest: Manifest, name: str | None) -> int | None:
    """Return the first scenario of a name: the whole one, or that of its variant."""
    for index, scenario in enumerate(manifest.scenarios):
        if name is None or name in (scenario.name, _variant(scenario.name)):
            return index
    return None


def _variant(scenario: str) -> str:
    return scenario.rpartition(" -- ")[0].rpartition(":")[2]


def _render(folder: Path, index: int, output: Path) -> str:
    """Let the agent's side render with the first back end that works; returns what went wrong, if anything."""
    chosen = os.environ.get("MUJOCO_GL")
    command = [sys.executable, "-m", "robbdd_tools.agent.render", str(folder), str(index), str(output.absolute())]
    tried: list[str] = []
    for back_end in (chosen,) if chosen else BACK_ENDS:
        environment = {**os.environ, "MUJOCO_GL": back_end}
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
        said = (done.stderr.strip().splitlines() or [f"the rendering process ended with code {done.returncode}"])[-1]
        if done.returncode != NO_GRAPHICS:
            return "" if done.returncode == 0 else said
        tried.append(f"{back_end}: {said}")
    return f"{ADVICE} ({'; '.join(tried)})"
