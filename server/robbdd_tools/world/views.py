"""Render pictures of a compiled model by its cameras, or from any point."""

from __future__ import annotations

from math import asin, atan2, degrees
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.engine import mujoco

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

SHADOWS = 1024
"""Resolution of shadows: without a graphics card, larger ones take most of a picture's time."""


class Views:
    """Renders a model that was saved to a file, in any state. The constructor raises if no back end works."""

    def __init__(self, path: str) -> None:
        self._model: Any = mujoco.MjModel.from_binary_path(path)
        shown = self._model.vis
        # The room's lamp is enough: a lamp at the camera and its highlights would hide the colours.
        shown.headlight.diffuse[:] = shown.headlight.specular[:] = self._model.light_specular[:] = 0.0
        shown.quality.shadowsize = SHADOWS
        self._data: Any = mujoco.MjData(self._model)
        self._renderers: dict[tuple[int, int], Any] = {}
        self._renderer((16, 16))

    def render(
        self, camera: str | Sequence[Sequence[float]], state: Sequence[float], size: tuple[int, int]
    ) -> NDArray[np.uint8]:
        """Return the pixels (height, width, 3) that a camera sees at joint positions ``state`` of the engine.

        ``camera`` is the name of a camera of the model, or a position and the point to look at, (3,) m each.
        ``size`` is width and height.
        """
        self._data.qpos[:] = state
        mujoco.mj_forward(self._model, self._data)
        renderer = self._renderer(size)
        renderer.update_scene(self._data, camera if isinstance(camera, str) else _free(*camera))
        pixels: NDArray[np.uint8] = renderer.render()
        return pixels

    def _renderer(self, size: tuple[int, int]) -> Any:
        if size not in self._renderers:
            shown = self._model.vis.global_
            shown.offwidth, shown.offheight = max(shown.offwidth, size[0]), max(shown.offheight, size[1])
            self._renderers[size] = mujoco.Renderer(self._model, size[1], size[0])
        return self._renderers[size]


def _free(position: Sequence[float], point: Sequence[float]) -> Any:
    """Return a camera at a position that looks at a point."""
    ahead = np.subtract(point, position)
    view = mujoco.MjvCamera()
    view.lookat[:] = point
    view.distance = distance = float(np.linalg.norm(ahead))
    view.azimuth = degrees(atan2(ahead[1], ahead[0]))
    view.elevation = degrees(asin(ahead[2] / distance))
    return view
