"""What a gripper holds follows from where its gripping faces touch an object."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from robbdd_tools.catalog.api import GripperKind
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.holding import Grips
from robbdd_tools.world.robot import Robot

CELL = """<mujoco><worldbody>
  <geom name="left" type="box" size=".005 .01 .01" pos="{left}"/>
  <geom name="right" type="box" size=".005 .01 .01" pos="{right}"/>
  {more}
  <body name="cube"><freejoint/>{shapes}</body>
</worldbody></mujoco>"""
CUBE = '<geom type="box" size=".02 .02 .02"/>'
DUMBBELL = '<geom type="sphere" size=".02" pos="-.03 0 0"/><geom type="sphere" size=".02" pos=".03 0 0"/>'


def holds(left: str, right: str, shapes: str = CUBE, third: str = "") -> bool:
    """Return whether two fingers at places (m) hold an object at the origin; ``third`` belongs to the right one."""
    more = f'<geom name="third" type="box" size=".005 .01 .01" pos="{third}"/>' if third else ""
    model: Any = mujoco.MjModel.from_xml_string(CELL.format(left=left, right=right, shapes=shapes, more=more))
    data: Any = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    faces = ((0,), (1, 2) if third else (1,))
    pads = tuple(pad for face in faces for pad in face)
    hand = SimpleNamespace(faces=faces, pads=pads, model=SimpleNamespace(gripper=GripperKind.PARALLEL))
    grips = Grips(model, {"arm": cast(Robot, hand)}, {"cube": 0}, ["cube"])
    grips.find(data)
    return bool(grips.held["arm"][0])


@pytest.mark.parametrize(
    ("left", "right", "shapes", "third", "held"),
    [
        ("-.0245 0 0", ".0245 0 0", CUBE, "", True),
        ("-.006 0 .0295", ".006 0 .0295", CUBE, "", False),
        ("-.0245 0 0", ".026 0 0", CUBE, "", False),
        ("-.0245 0 0", ".006 0 .0295", CUBE, "", False),
        ("-.006 0 .0295", ".006 0 .0295", CUBE, "0 0 -.0295", True),
        ("-.03 0 .0295", ".03 0 .0295", DUMBBELL, "", False),
        ("-.0545 0 0", ".0545 0 0", DUMBBELL, "", True),
    ],
    ids=["sides", "top", "one side", "side and top", "thumb", "two tops", "two ends"],
)
def test_an_object_is_held_between_faces_that_push_against_each_other(
    left: str, right: str, shapes: str, third: str, held: bool
) -> None:
    assert holds(left, right, shapes, third) is held
