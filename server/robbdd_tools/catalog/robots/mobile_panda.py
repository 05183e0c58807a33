"""Franka Emika Panda on a mobile platform with two driven wheels."""

from math import pi

from robbdd_tools.catalog.api import RobotModel

MOBILE_PANDA = RobotModel(
    name="mobile-panda",
    prefixes=("mobile", "rover"),
    mjcf="mobile_panda.xml",
    joints=tuple(f"panda_joint{number}" for number in range(1, 8)),
    home=(0.0, -pi / 4, 0.0, -3 * pi / 4, 0.0, pi / 2, pi / 4),
    velocity_limits=(2.175, 2.175, 2.175, 2.175, 2.61, 2.61, 2.61),
    torque_limits=(87.0, 87.0, 87.0, 87.0, 12.0, 12.0, 12.0),
    tool_site="panda_tool",
    gripper_actuator="panda_gripper",
    gripper_open=0.04,
    gripper_closed=-0.002,
    pads=("panda_left_pad", "panda_right_pad"),
    mount=(-0.8, 0.0, -0.65),
    stroke=0.08,
    doc=(
        "A Panda on a round platform of 0.5 m diameter that drives at 0.8 m/s and turns at 1.5 rad/s at most; base of "
        "the arm 0.8 m above the floor."
    ),
    source=(
        "Arm and hand: those of the Panda of this catalog. The platform is ours: 75 kg with two driven wheels of "
        "150 mm diameter, 0.4 m apart. Its largest force of 300 N and torque of 60 N m are those of wheels that carry "
        "two thirds of the weight of platform and arm (90 kg) with a friction of 0.5."
    ),
)
