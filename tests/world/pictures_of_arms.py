"""Write the pictures of docs/robots.md, after ``make arms``.

``MUJOCO_GL=egl PYTHONPATH=tests python tests/world/pictures_of_arms.py``
(without a display, EGL or OSMesa has to be installed).
"""

from __future__ import annotations

import warnings
from pathlib import Path

from robbdd_tools.world.picture import Camera
from robbdd_tools.world.png import write_png
from world.arms_of_others import ARMS, OWN, Arm, picking

TARGET = Path(__file__).parents[2] / "docs" / "images" / "arms"
SIZE = 200, 240
"""Width and height of a picture, in pixels."""
AZIMUTH = 128.0
"""Direction (degrees) from which an arm is seen."""


def draw(arm: Arm, target: Path) -> None:
    """Write the picture of an arm at home, at the table where it was tried."""
    simulation = picking(arm, 1).simulation
    camera = Camera(simulation, SIZE)
    try:
        write_png(target, camera.take_arm(simulation.data, OWN, AZIMUTH))
    finally:
        camera.close()


if __name__ == "__main__":
    warnings.filterwarnings("ignore", ".*obj_decoder")
    TARGET.mkdir(parents=True, exist_ok=True)
    for one in ARMS:
        draw(one, TARGET / f"{one.name}.png")
