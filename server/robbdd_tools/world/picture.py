"""Render a simulated world with its labelled workspaces."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.camera_aim import CORNERS, aim, corners_of
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.region_frames import along_edges
from robbdd_tools.world.scene import local_name

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from robbdd_tools.catalog.api import FloatArray, Region
    from robbdd_tools.world.simulation import Simulation

WIDTH, HEIGHT = 1280, 800
COLORS = ((0.10, 0.55, 0.90), (0.95, 0.55, 0.10), (0.25, 0.70, 0.30), (0.80, 0.25, 0.55), (0.55, 0.45, 0.85))
OPACITY = 0.20
THIN = 0.06
"""Opacity of a workspace that contains other workspaces, such as the workspace of a table."""
LABEL = 0.012
"""Radius (m) of a label's dot."""
OVERVIEW = (128.0, -36.0)
"""Azimuth and elevation (degrees) of the camera for a whole scene."""
CLOSE, DOWN = 1.1, -30.0
"""Distance (m) and elevation (degrees) of the camera for one object."""
AZIMUTHS = (128.0, 160.0, 96.0, -160.0, 64.0, -128.0, 32.0, -96.0, 0.0, -64.0, -32.0)
"""Camera directions (degrees) for one object, best first."""
DISTANT, SLIGHTLY_DOWN = 1.35, -28.0
"""Distance of the camera for one arm, as a multiple of the arm's size, and its elevation (degrees)."""
AXIS, THICK = 0.12, 0.006
"""Length and thickness (m) of the axes of a tool."""
LONGEST = 90
"""Maximum number of bytes of a label in the engine."""


class NoPicture(Exception):
    """No graphics back end works; the message lists those tried."""


def require_graphics() -> None:
    """Raise ``NoPicture`` if the chosen back end cannot render, which is known in less time than a world takes."""
    try:
        mujoco.Renderer(mujoco.MjModel.from_xml_string("<mujoco/>"), 8, 8).close()
    except Exception as error:  # back ends raise exceptions of their own, import errors included
        raise NoPicture(f"{type(error).__name__}: {error}") from error


class Camera:
    """Renders a simulation: the whole scene from the side of the table, or one object in close-up.

    ``size`` is width and height in pixels. A ``plain`` picture has no shadows and takes a tenth of the time. Raises
    ``NoPicture`` if no back end can render.
    """

    def __init__(self, simulation: Simulation, size: tuple[int, int] = (WIDTH, HEIGHT), *, plain: bool = False) -> None:
        self._simulation = simulation
        model = simulation.model
        model.vis.global_.offwidth, model.vis.global_.offheight = size
        model.vis.quality.shadowsize = 2048
        try:
            self._renderer: Any = mujoco.Renderer(model, size[1], size[0])
            if plain:
                self._renderer.scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = 0
                self._renderer.scene.flags[mujoco.mjtRndFlag.mjRND_REFLECTION] = 0
        except Exception as error:  # back ends raise exceptions of their own, import errors included
            raise NoPicture(f"{type(error).__name__}: {error}") from error
        self._view: Any = mujoco.MjvCamera()
        self._aspect = size[0] / size[1]
        self._overview: tuple[FloatArray, float] | None = None
        """Where the camera looks and from how far (m): set by the first picture, so that a recording does not shake."""

    def take(self, data: Any, focus: str | None = None) -> NDArray[np.uint8]:
        """Render a state as pixels (height, width, 3): the whole scene, or a close-up of one object."""
        if focus is not None and focus in self._simulation.world.cast.objects:
            self._look_at(data, focus)
        else:
            self._look_around(data)
        self._renderer.update_scene(data, self._view)
        scene = self._renderer.scene
        for index, (name, carrier, region) in enumerate(self._regions()):
            self._draw(scene, data, carrier, region, COLORS[index % len(COLORS)], local_name(name), index % 2 > 0)
        pixels: NDArray[np.uint8] = self._renderer.render()
        return pixels

    def take_state(self, state: Sequence[float] | FloatArray, focus: str | None = None) -> NDArray[np.uint8]:
        """Render stored joint positions of the engine: the whole scene, or a close-up of one object."""
        data = self._simulation.scratch
        data.qpos[:] = state
        mujoco.mj_forward(self._simulation.model, data)
        return self.take(data, focus)

    def take_arm(self, data: Any, name: str, azimuth: float) -> NDArray[np.uint8]:
        """Render one arm with the frame of its tool (x red, y green, z blue), from a direction (degrees)."""
        model, robot = self._simulation.model, self._simulation.robots[name]
        arm = {int(model.body_rootid[model.geom_bodyid[pad]]) for pad in robot.pads}
        own = [geom for geom in range(model.ngeom) if int(model.body_rootid[model.geom_bodyid[geom]]) in arm]
        places, around = data.geom_xpos[own], model.geom_rbound[own].reshape(-1, 1)
        low, high = (places - around).min(axis=0), (places + around).max(axis=0)
        self._view.lookat[:] = (low + high) / 2
        self._view.distance = DISTANT * float(np.linalg.norm(high - low))
        self._view.azimuth, self._view.elevation = azimuth, SLIGHTLY_DOWN
        self._renderer.update_scene(data, self._view)
        place, turn = data.site_xpos[robot.tool], data.site_xmat[robot.tool].reshape(3, 3)
        for axis in range(3):
            _add_arrow(self._renderer.scene, place, place + AXIS * turn[:, axis], axis)
        pixels: NDArray[np.uint8] = self._renderer.render()
        return pixels

    def close(self) -> None:
        """Free the graphics context."""
        self._renderer.close()

    def _look_around(self, data: Any) -> None:
        model, (azimuth, elevation) = self._simulation.model, OVERVIEW
        if self._overview is None:
            points = np.concatenate([corners_of(model, data), *self._starts(), *self._labelled(data)])
            self._overview = aim(points, azimuth, elevation, float(model.vis.global_.fovy), self._aspect)
        self._view.lookat[:], self._view.distance = self._overview
        self._view.azimuth, self._view.elevation = azimuth, elevation

    def _starts(self) -> Iterator[FloatArray]:
        """Yield the places (m) where mobile robots start, so that they are in view when the robots have left them."""
        for robot in self._simulation.robots.values():
            if robot.mobile is not None:
                yield np.array([robot.mobile.start.position])

    def _labelled(self, data: Any) -> Iterator[FloatArray]:
        """Yield the corners (8, 3) m of each workspace; one of these corners has the label."""
        for _, carrier, region in self._regions():
            body = data.body(carrier)
            place, turn = along_edges((body.xpos, body.xmat.reshape(3, 3)), region)
            local = np.array(region.center) + CORNERS * (np.array(region.half) + LABEL)
            yield place + local @ turn.T

    def _look_at(self, data: Any, name: str) -> None:
        """Choose the first direction with a free view of the object."""
        target = data.body(name).xpos.copy()
        self._view.lookat[:] = target
        self._view.distance, self._view.elevation = CLOSE, DOWN
        clear = (azimuth for azimuth in AZIMUTHS if self._sees(data, name, target, azimuth))
        self._view.azimuth = next(clear, AZIMUTHS[0])

    def _sees(self, data: Any, name: str, target: FloatArray, azimuth: float) -> bool:
        model = self._simulation.model
        turn, tilt = np.radians(azimuth), np.radians(DOWN)
        ahead = np.array([np.cos(tilt) * np.cos(turn), np.cos(tilt) * np.sin(turn), np.sin(tilt)])
        hit = np.full(1, -1, dtype=np.int32)
        mujoco.mj_ray(model, data, target - CLOSE * ahead, ahead, None, 1, -1, hit)
        return hit[0] >= 0 and int(model.geom_bodyid[hit[0]]) == int(model.body(name).id)

    def _regions(self) -> Iterator[tuple[str, str, Region]]:
        for name, boxes in self._simulation.world.cast.regions.items():
            for carrier, region in boxes:
                yield name, carrier, region

    def _draw(
        self,
        scene: Any,
        data: Any,
        carrier: str,
        region: Region,
        color: tuple[float, float, float],
        name: str,
        odd: bool,
    ) -> None:
        body = data.body(carrier)
        place, turn = along_edges((body.xpos, body.xmat.reshape(3, 3)), region)
        center: FloatArray = place + turn @ np.array(region.center)
        half = np.array(region.half)
        free = self._simulation.world.cast.objects[carrier].free
        opacity = OPACITY if free else THIN
        _add(scene, mujoco.mjtGeom.mjGEOM_BOX, half, center, turn, (*color, opacity), "")
        # Objects lie in the middle of a table, so a corner has its label; boards lie side by side.
        side = 0.0 if region.walled else -0.8 if odd else 0.8
        corner = np.array([0.0, side, 1.0]) if free else np.array([-1.0, 1.0, 1.0])
        above = center + turn @ (corner * half + np.array([0.0, 0.0, 2 * LABEL]))
        _add(scene, mujoco.mjtGeom.mjGEOM_SPHERE, np.full(3, LABEL), above, turn, (*color, 1.0), name)


def _add_arrow(scene: Any, start: FloatArray, end: FloatArray, axis: int) -> None:
    """Add an arrow in the colour of an axis: red, green or blue."""
    color = np.array([*np.eye(3)[axis], 1.0], dtype=np.float32)
    geom = scene.geoms[scene.ngeom]
    kind = mujoco.mjtGeom.mjGEOM_ARROW
    mujoco.mjv_initGeom(geom, kind, np.zeros(3), np.zeros(3), np.eye(3).ravel(), color)
    mujoco.mjv_connector(geom, kind, THICK, start, end)
    scene.ngeom += 1


def _add(
    scene: Any,
    kind: Any,
    size: FloatArray,
    position: FloatArray,
    turn: FloatArray,
    color: tuple[float, float, float, float],
    label: str,
) -> None:
    """Add a shape for drawing only; does nothing when the scene is full."""
    if scene.ngeom >= scene.maxgeom:
        return
    geom = scene.geoms[scene.ngeom]
    mujoco.mjv_initGeom(geom, kind, size, position, turn.flatten(), np.array(color, dtype=np.float32))
    geom.label = label.encode("ascii", "replace")[:LONGEST].decode("ascii")
    scene.ngeom += 1
