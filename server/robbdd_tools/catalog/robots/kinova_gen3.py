"""Kinova Gen3 with seven joints and an adaptive two-finger gripper."""

from math import pi

from robbdd_tools.catalog.api import RobotModel

KINOVA_GEN3 = RobotModel(
    name="kinova-gen3",
    prefixes=("kinova", "gen3"),
    mjcf="kinova_gen3.xml",
    joints=("joint1", "joint2", "joint3", "joint4", "joint5", "joint6", "joint7"),
    home=(0.002396, 0.4833, pi, -1.8629, 0.0, -0.7954, 0.002368),
    velocity_limits=(1.3963, 1.3963, 1.3963, 1.3963, 1.2218, 1.2218, 1.2218),
    torque_limits=(39.0, 39.0, 39.0, 39.0, 9.0, 9.0, 9.0),
    tool_site="tool",
    gripper_actuator="gripper",
    gripper_open=0.0425,
    gripper_closed=-0.002,
    pads=("left_pad", "right_pad"),
    mount=(0.15, 0.0, 0.24),
    stroke=0.085,
    doc="Kinova Gen3: seven axes, two-finger gripper with an opening of 85 mm and a friction grip of 20 N.",
    source=(
        "Kinematics (classic Denavit-Hartenberg), ranges of joints 2, 4 and 6 and the largest tool speed of 0.5 m/s: "
        "Kinova, 'KINOVA Gen3 Ultra lightweight robot User Guide'. Masses, centres of mass and "
        "inertias of the links (bracelet without camera), joint speeds and torques: Kinova, ros_kortex, "
        "kortex_description/arms/gen3/7dof/urdf/gen3_macro.xacro. Stroke, smallest gripping force and mass "
        "of the gripper: Robotiq, '2F-85 and 2F-140 Instruction Manual'; its linkage is ours: pads that slide in "
        "parallel. It stands on the table's edge, which is ours: its reach is the shortest of the catalog."
    ),
)
