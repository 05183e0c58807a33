"""Franka Emika Panda (also sold as Franka Emika Robot) with its parallel hand."""

from math import pi

from robbdd_tools.catalog.api import RobotModel

PANDA = RobotModel(
    name="franka-panda",
    prefixes=("panda", "franka"),
    mjcf="panda.xml",
    joints=("joint1", "joint2", "joint3", "joint4", "joint5", "joint6", "joint7"),
    home=(0.0, -pi / 4, 0.0, -3 * pi / 4, 0.0, pi / 2, pi / 4),
    velocity_limits=(2.175, 2.175, 2.175, 2.175, 2.61, 2.61, 2.61),
    torque_limits=(87.0, 87.0, 87.0, 87.0, 12.0, 12.0, 12.0),
    tool_site="tool",
    gripper_actuator="gripper",
    gripper_open=0.04,
    gripper_closed=-0.002,
    pads=("left_pad", "right_pad"),
    mount=(0.0, 0.0, 0.15),
    stroke=0.08,
    doc="Franka Emika Panda: seven axes, parallel gripper with an opening of 80 mm and a friction grip of 15 N.",
    source=(
        "Kinematics (modified Denavit-Hartenberg), joint position, velocity and torque limits, hand and tool centre "
        "point: Franka Emika, Robot and interface specifications of the Franka Control Interface documentation. "
        "Masses, centres of mass and inertias of links and hand: Franka Robotics, franka_description, "
        "robots/fer/inertials.yaml. There the largest moment of link 4 exceeds the sum of the two others by 9 %, "
        "which no body has; here it is that sum. Height of the base above the world's origin: "
        "the scene of the RobBDD experiment."
    ),
)
