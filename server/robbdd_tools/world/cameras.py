"""Cameras of a simulated world, for users' behaviours.

Another process, started for the first picture, renders them: graphics drivers are slow to load, and a broken one must
not end the execution.
"""

from __future__ import annotations

import json
import weakref
from base64 import b64decode
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.base.graphics import CHOICE, back_ends, nothing_renders
from robbdd_tools.base.interpreter import Module, start, working_folder
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SimulationError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from robbdd_tools.catalog.api import FloatArray

LARGEST = 4096
"""Maximum width and height of a picture in pixels."""
RENDERS = "robbdd_tools.agent.render_views"


class Cameras:
    """The cameras of one simulation."""

    def __init__(self, model: Any, data: Any) -> None:
        self._model = model
        self._data = data
        self._process: Module | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the cameras in the files of arms and scenes."""
        return tuple(self._model.camera(index).name for index in range(self._model.ncam))

    def take(self, camera: str | tuple[FloatArray, FloatArray], size: tuple[int, int]) -> NDArray[np.uint8]:
        """Return the pixels (height, width, 3) that a camera sees now; ``size`` is width and height.

        Raises ``KeyError`` for an unknown camera, ``ValueError`` for an invalid aim or size, ``SimulationError`` if
        nothing can render.
        """
        request = {"camera": self._checked(camera), "size": _checked_size(size), "state": self._data.qpos.tolist()}
        if self._process is None or self._process.poll() is not None:
            self._process = self._start()
        answer = _asked(self._process, request)
        if answer is None or "pixels" not in answer:
            raise SimulationError(f"the picture cannot be rendered: {_reason(answer)}")
        width, height = size
        return np.frombuffer(b64decode(answer["pixels"]), dtype=np.uint8).reshape(height, width, 3)

    def _checked(self, camera: str | tuple[FloatArray, FloatArray]) -> str | list[list[float]]:
        if isinstance(camera, str):
            if camera not in self.names:
                known = ", ".join(self.names) or "none: its files define no camera"
                raise KeyError(f"there is no camera '{camera}' in the scene; it has {known}")
            return camera
        aim = np.asarray(camera, dtype=float)
        if aim.shape != (2, 3) or not np.all(np.isfinite(aim)) or np.array_equal(*aim):
            raise ValueError(f"camera must be a name, or a position and another point to look at, not {camera!r:.200}")
        return aim.tolist()

    def _start(self) -> Module:
        """Start rendering with the first back end that works; raises ``SimulationError``."""
        folder = working_folder()
        model = folder / "views.mjb"
        mujoco.mj_saveModel(self._model, str(model))
        tried: list[str] = []
        for back_end in back_ends():
            process = start(RENDERS, str(model), folder=folder, log=None, more={CHOICE: back_end})
            said = _line(process)
            if said == {}:
                weakref.finalize(self, _end, process)
                return process
            _end(process)
            tried.append(f"{back_end}: {_reason(said)}")
        raise SimulationError(nothing_renders(tried))


def _checked_size(size: Sequence[int]) -> list[int]:
    found = [int(one) for one in size]
    if len(found) != 2 or not all(0 < one <= LARGEST for one in found):
        raise ValueError(f"size must be width and height in pixels, at most {LARGEST}, not {size!r:.200}")
    return found


def _asked(process: Module, request: dict[str, Any]) -> dict[str, str] | None:
    """Return the answer to a request, ``None`` if the process has ended."""
    assert process.stdin is not None, "the renderer has pipes"
    try:
        process.stdin.write(json.dumps(request) + "\n")
        process.stdin.flush()
    except OSError:
        return None
    return _line(process)


def _line(process: Module) -> dict[str, str] | None:
    """Return the next answer of a process, ``None`` if it has ended."""
    assert process.stdout is not None, "the renderer has pipes"
    line = process.stdout.readline()
    return json.loads(line) if line else None


def _reason(answer: dict[str, str] | None) -> str:
    return "the rendering process has ended" if answer is None else answer["error"]


def _end(process: Module) -> None:
    process.kill()
    process.communicate()
