"""Universal Robots UR10 with one suction cup."""

from math import pi

from robbdd_tools.catalog.api import GripperKind, RobotModel

UR10 = RobotModel(
    name="ur10",
    prefixes=("ur10", "ur_10"),
    mjcf="ur10.xml",
    joints=("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3"),
    home=(-0.422267, -2.122151, 2.028399, -1.477044, -pi / 2, -1.993063),
    velocity_limits=(2 * pi / 3, 2 * pi / 3, pi, pi, pi, pi),
    torque_limits=(330.0, 330.0, 150.0, 56.0, 56.0, 56.0),
    tool_site="tool",
    gripper_actuator="gripper",
    gripper_open=0.0,
    gripper_closed=1.0,
    pads=("cup",),
    mount=(0.0, 0.0, 0.20),
    stroke=0.030,
    doc="Universal Robots UR10: six axes, a suction cup of 30 mm that releases at 42 N and grips only what it touches.",
    source=(
        "Denavit-Hartenberg parameters, masses, centres of mass and inertias of the links: Universal Robots, 'DH "
        "Parameters for calculations of kinematics and dynamics', and with five digits config/ur10/"
        "physical_parameters.yaml of its Universal_Robots_ROS2_Description. "
        "Joint ranges and speeds: Universal Robots, UR10 technical specifications. Joint "
        "torques: Universal Robots, 'Max. joint torques' (joint sizes 4, 4, 3, 2, 2, 2). Height of the base above the "
        "world's origin: the scene of the RobBDD experiment. The cup and its tube are ours: 60 kPa below ambient "
        "pressure on a disc with a radius of 15 mm."
    ),
    tool_speed=1.0,
    gripper=GripperKind.SUCTION,
)
