"""A five-axis arm with two fingers that the catalog does not have, as MJCF and as URDF."""

MJCF = """<mujoco model="five">
  <compiler angle="radian" autolimits="true"/>
  <default>
    <joint armature="0.1" damping="1"/>
    <geom contype="1" conaffinity="1" mass="0.5"/>
    <default class="finger">
      <joint type="slide" range="0 0.04" armature="0.1" damping="10"/>
    </default>
    <default class="pad">
      <geom type="box" size="0.009 0.004 0.015" mass="0.01" condim="4" friction="0.9 0.01 0.001"
            solref="0.005 1" solimp="0.95 0.99 0.001"/>
    </default>
  </default>
  <worldbody>
    <body name="foot">
      <geom type="cylinder" size="0.08 0.02" pos="0 0 0.02"/>
      <body name="column">
        <joint name="yaw" axis="0 0 1" range="-3 3"/>
        <geom type="cylinder" size="0.05" fromto="0 0 0.05 0 0 0.25"/>
        <body name="upper" pos="0 0 0.3">
          <joint name="shoulder" axis="0 1 0" range="-2 2"/>
          <geom type="capsule" size="0.04" fromto="0 0 0 0 0 0.4"/>
          <body name="fore" pos="0 0 0.45">
            <joint name="elbow" axis="0 1 0" range="-2.8 2.8"/>
            <geom type="capsule" size="0.03" fromto="0 0 0.03 0 0 0.4"/>
            <body name="wrist" pos="0 0 0.45">
              <joint name="pitch" axis="0 1 0" range="-3 3"/>
              <geom type="cylinder" size="0.03" fromto="0 0 0.02 0 0 0.08"/>
              <body name="hand" pos="0 0 0.08">
                <joint name="roll" axis="0 0 1" range="-3 3"/>
                <geom type="box" size="0.02 0.06 0.015" pos="0 0 0.015"/>
                <site name="tcp" pos="0 0 0.1" quat="0 0 0 1"/>
                <body name="left" pos="0 0.004 0.1">
                  <joint name="left_slide" class="finger" axis="0 1 0"/>
                  <geom name="left_pad" class="pad"/>
                </body>
                <body name="right" pos="0 -0.004 0.1">
                  <joint name="right_slide" class="finger" axis="0 -1 0"/>
                  <geom name="right_pad" class="pad"/>
                </body>
              </body>
            </body>
          </body>
        </body>
      </body>
    </body>
  </worldbody>
  <equality><joint joint1="left_slide" joint2="right_slide"/></equality>
  <actuator>
    <position name="yaw_servo" joint="yaw" kp="2000" kv="100"/>
    <position name="shoulder_servo" joint="shoulder" kp="2000" kv="100"/>
    <position name="elbow_servo" joint="elbow" kp="2000" kv="100"/>
    <position name="pitch_servo" joint="pitch" kp="1000" kv="50"/>
    <position name="roll_servo" joint="roll" kp="500" kv="25"/>
    <position name="grip" joint="left_slide" kp="6000" kv="120" forcerange="-30 30" ctrlrange="-0.002 0.04"/>
  </actuator>
</mujoco>
"""


def _link(name: str, mass: float, shape: str = "", at: str = "0 0 0") -> str:
    inertia = '<inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/>'
    body = f'<inertial><origin xyz="{at}"/><mass value="{mass}"/>{inertia}</inertial>'
    geometry = f'<collision><origin xyz="{at}"/><geometry>{shape}</geometry></collision>' if shape else ""
    return f'<link name="{name}">{body}{geometry}</link>'


def joint(name: str, ends: tuple[str, str], axis: str, at: str, kind: str = "revolute", high: float = 3.0) -> str:
    parent, child = ends
    low = 0.0 if kind == "prismatic" else -high
    mimic = '<mimic joint="left_slide"/>' if name == "right_slide" else ""
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/><origin xyz="{at}"/>'
        f'<axis xyz="{axis}"/><limit lower="{low}" upper="{high}" effort="100" velocity="2"/>{mimic}'
        f'<dynamics damping="1"/></joint>'
    )


URDF = "".join(
    [
        '<robot name="five">',
        _link("foot", 2, '<cylinder radius="0.08" length="0.04"/>', "0 0 0.02"),
        _link("column", 1, '<cylinder radius="0.05" length="0.2"/>', "0 0 0.15"),
        _link("upper", 1, '<cylinder radius="0.04" length="0.25"/>', "0 0 0.15"),
        _link("fore", 1, '<cylinder radius="0.03" length="0.25"/>', "0 0 0.17"),
        _link("wrist", 0.5, '<cylinder radius="0.03" length="0.05"/>', "0 0 0.05"),
        _link("hand", 0.5, '<box size="0.04 0.12 0.03"/>', "0 0 0.015"),
        _link("left", 0.05, '<box size="0.018 0.008 0.03"/>'),
        _link("right", 0.05, '<box size="0.018 0.008 0.03"/>'),
        joint("yaw", ("foot", "column"), "0 0 1", "0 0 0"),
        joint("shoulder", ("column", "upper"), "0 1 0", "0 0 0.3", high=2),
        joint("elbow", ("upper", "fore"), "0 1 0", "0 0 0.45", high=2.8),
        joint("pitch", ("fore", "wrist"), "0 1 0", "0 0 0.45"),
        joint("roll", ("wrist", "hand"), "0 0 1", "0 0 0.08"),
        joint("left_slide", ("hand", "left"), "0 1 0", "0 0.004 0.1", "prismatic", 0.04),
        joint("right_slide", ("hand", "right"), "0 -1 0", "0 -0.004 0.1", "prismatic", 0.04),
        _link("tcp", 0.01),
        '<joint name="tool" type="fixed"><parent link="hand"/><child link="tcp"/>'
        '<origin xyz="0 0 0.1" rpy="0 0 3.14159265"/></joint>',
        "</robot>",
    ]
)

_shears = MJCF
for _old, _new in (
    ('<joint type="slide" range="0 0.04" armature="0.1" damping="10"/>', '<joint armature="0.002" damping="0.2"/>'),
    ('size="0.009 0.004 0.015" mass="0.01"', 'size="0.009 0.004 0.0425" pos="0 0 0.0425" mass="0.02"'),
    ('name="left" pos="0 0.004 0.1"', 'name="left" pos="0 0.012 0.03"'),
    ('name="right" pos="0 -0.004 0.1"', 'name="right" pos="0 -0.012 0.03"'),
    (
        'name="left_slide" class="finger" axis="0 1 0"',
        'name="left_slide" class="finger" axis="-1 0 0" range="-0.3 0.6"',
    ),
    (
        'name="right_slide" class="finger" axis="0 -1 0"',
        'name="right_slide" class="finger" axis="1 0 0" range="-0.3 0.6"',
    ),
    (
        'kp="6000" kv="120" forcerange="-30 30" ctrlrange="-0.002 0.04"',
        'kp="40" kv="1" forcerange="-2 2" ctrlrange="-0.3 0.6"',
    ),
):
    assert _old in _shears
    _shears = _shears.replace(_old, _new)
SHEARS = _shears
"""The same arm with straight fingers of 85 mm that rotate about their roots, 16 mm apart there."""
