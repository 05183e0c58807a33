"""Universal Robots UR5e with an adaptive two-finger gripper."""

from math import pi

from robbdd_tools.catalog.api import RobotModel

UR5E = RobotModel(
    name="ur5e",
    prefixes=("ur5e", "ur_5e"),
    mjcf="ur5e.xml",
    joints=("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3"),
    home=(-0.339749, -1.837295, 1.716906, -1.450407, -pi / 2, -1.910545),
    velocity_limits=(pi, pi, pi, pi, pi, pi),
    torque_limits=(150.0, 150.0, 150.0, 28.0, 28.0, 28.0),
    tool_site="tool",
    gripper_actuator="gripper",
    gripper_open=0.0425,
    gripper_closed=-0.002,
    pads=("left_pad", "right_pad"),
    mount=(0.0, 0.0, 0.15),
    stroke=0.085,
    doc="Universal Robots UR5e: six axes, two-finger gripper with an opening of 85 mm and a friction grip of 20 N.",
    source=(
        "Denavit-Hartenberg parameters: Universal Robots, 'DH Parameters for calculations of kinematics and dynamics'. "
        "Masses, centres of mass and inertias of the links: the same page, and config/ur5e/physical_parameters.yaml of "
        "Universal_Robots_ROS2_Description. Joint ranges and speeds: Universal Robots, UR5e user manual. Joint "
        "torques: Universal Robots, 'Max. joint torques' (joint sizes 3, 3, 3, 1, 1, 1). Stroke, smallest gripping "
        "force and mass of the gripper: Robotiq, '2F-85 and 2F-140 Instruction Manual'; its linkage is ours: pads that "
        "slide in parallel. Height of the base above the world's origin: as the Panda's."
    ),
)
