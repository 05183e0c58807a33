"""Arms as others write them: their axes, drives and grippers differ from those of every example."""

from __future__ import annotations

import re

_SOFT = 'friction="1 .01 .001" condim="4" solref=".005 1" solimp=".95 .99 .001"'

SCARA = f"""<mujoco model="scara">
<!-- Four axes, two of them torque-driven, one sliding, one without limits; an actuator for each finger. -->
<compiler angle="radian" autolimits="true"/>
<worldbody><body name="stand"><geom type="cylinder" size=".07 .2" pos="0 0 .2" mass="5"/>
<body name="arm1" pos="0 0 .42"><joint name="a1" axis="0 0 1" range="-2.8 2.8" armature=".1"/>
<geom type="capsule" size=".04" fromto="0 0 0 .45 0 0" mass="2"/>
<body name="arm2" pos=".45 0 .06"><joint name="a2" axis="0 0 1" range="-2.6 2.6" armature=".1"/>
<geom type="capsule" size=".035" fromto="0 0 0 .4 0 0" mass="1.5"/>
<body name="quill" pos=".4 0 0"><joint name="z" type="slide" axis="0 0 -1" range="0 .42" armature=".5"/>
<geom type="cylinder" size=".015 .15" mass=".5"/>
<body name="flange" pos="0 0 -.16"><joint name="rot" axis="0 0 1" armature=".02"/>
<geom type="box" size=".03 .05 .01" mass=".3"/>
<body name="fa" pos="0 .003 -.06"><joint name="ja" type="slide" axis="0 1 0" range="0 .035" armature=".1" damping="5"/>
<geom type="box" size=".01 .003 .02" pos="0 0 -.01" mass=".03" {_SOFT}/></body>
<body name="fb" pos="0 -.003 -.06">
<joint name="jb" type="slide" axis="0 1 0" range="-.035 0" armature=".1" damping="5"/>
<geom type="box" size=".01 .003 .02" pos="0 0 -.01" mass=".03" {_SOFT}/></body>
</body></body></body></body></body></worldbody>
<actuator><motor joint="a1" gear="60" ctrlrange="-1 1"/><motor joint="a2" gear="60" ctrlrange="-1 1"/>
<motor joint="z" ctrlrange="-300 300"/><velocity joint="rot" kv="5"/>
<position name="ga" joint="ja" kp="2000" kv="50" forcerange="-20 20" ctrlrange="0 .035"/>
<position name="gb" joint="jb" kp="2000" kv="50" forcerange="-20 20" ctrlrange="-.035 0"/></actuator></mujoco>"""


_SINGLE = SCARA[SCARA.index('<body name="fb"') : SCARA.index("</body></body></body></body></body></worldbody>")]


def _beside(number: int, aside: str) -> str:
    body = _SINGLE.replace('"fb"', f'"fb{number}"').replace('"jb"', f'"jb{number}"')
    return body.replace('pos="0 -.003 -.06"', f'pos="{aside} -.003 -.06"').replace('size=".01', 'size=".006')


THUMB = re.sub(
    '<position name="gb".*?/>',
    "".join(
        f'<position name="gb{number}" joint="jb{number}" kp="2000" kv="50" forcerange="-20 20" ctrlrange="-.035 0"/>'
        for number in (1, 2)
    ),
    SCARA.replace(_SINGLE, _beside(1, "-.009") + _beside(2, ".009")),
)
"""The same arm with a thumb and two fingers, each with an actuator."""


def _finger(side: str, sign: int) -> str:
    return (
        f'<body name="{side}f" pos="0 {sign * 0.02} .03"><joint name="j{side}" axis="{sign} 0 0" range="-40 25" '
        f'damping=".1" armature=".005"/><geom type="capsule" size=".006" fromto="0 0 0 0 {sign * 0.015} .06" '
        'mass=".02"/>'
        f'<geom name="{side}pad" type="box" size=".01 .004 .02" pos="0 {sign * 0.012} .08" mass=".02" {_SOFT}/></body>'
    )


_DRIVES = "".join(
    f'<general joint="q{axis}" gainprm="{gain}" biastype="affine" biasprm="0 -{gain} -{gain // 10}"/>'
    for axis, gain in enumerate((3000, 3000, 2000, 500, 500, 500), start=1)
)
SIX = f"""<mujoco model="six">
<!-- Six axes in degrees, the first one downwards, two without limits; rotating fingers that a tendon closes at 255. -->
<compiler angle="degree" autolimits="true"/><default><joint armature=".1" damping="1"/><geom mass=".5"/></default>
<worldbody><light pos="0 0 3"/><geom type="plane" size="1 1 .1" pos="0 0 -0.2"/>
<body name="b0"><geom type="cylinder" size=".08 .05" pos="0 0 .05"/>
<body name="b1" pos="0 0 .1"><joint name="q1" axis="0 0 -1" range="-170 170"/>
<geom type="cylinder" size=".06 .08" pos="0 0 .08"/>
<body name="b2" pos="0 0 .2"><joint name="q2" axis="0 1 0" range="-110 110"/>
<geom type="capsule" size=".05" fromto="0 0 0 0 0 .35"/>
<body name="b3" pos="0 0 .38"><joint name="q3" axis="0 1 0" range="-150 150"/>
<geom type="capsule" size=".04" fromto="0 0 0 0 0 .3"/>
<body name="b4" pos="0 0 .34"><joint name="q4" axis="0 0 1"/><geom type="cylinder" size=".035 .03"/>
<body name="b5" pos="0 0 .06"><joint name="q5" axis="0 1 0" range="-120 120"/><geom type="cylinder" size=".03 .03"/>
<body name="b6" pos="0 0 .06"><joint name="q6" axis="0 0 1"/><geom type="box" size=".03 .06 .015" pos="0 0 .015"/>
{_finger("l", 1)}{_finger("r", -1)}</body></body></body></body></body></body></body></worldbody>
<tendon><fixed name="split"><joint joint="jl" coef=".5"/><joint joint="jr" coef=".5"/></fixed></tendon>
<equality><joint joint1="jl" joint2="jr"/></equality>
<actuator>{_DRIVES}<general name="fingers" tendon="split" ctrlrange="0 255" gainprm=".05" biastype="affine"
 biasprm="-6 -12 -.2" forcerange="-4 4"/></actuator></mujoco>"""

_JAWS = "".join(
    f'<body euler="0 0 {120 * number}">{_finger(side, 1)}</body>'.replace('size=".01 .004', 'size=".006 .004')
    for number, side in enumerate("abc")
)
JAWS = (
    SIX.replace(_finger("l", 1) + _finger("r", -1), _JAWS)
    .replace('<joint joint="jl" coef=".5"/><joint joint="jr" coef=".5"/>', '<joint joint="ja" coef="1"/>')
    .replace('<joint joint1="jl" joint2="jr"/>', '<joint joint1="jb" joint2="ja"/><joint joint1="jc" joint2="ja"/>')
)
"""The same arm with three rotating fingers around the hand."""


def _jaw(number: int) -> str:
    return (
        f'<body name="knuckle{number}" euler="0 0 {120 * number}"><body pos=".035 0 .03">'
        f'<joint name="fj{number}" axis="0 -1 0" range="-30 40" damping=".2" armature=".01"/>'
        '<geom type="capsule" size=".007" fromto="0 0 0 .02 0 .04" mass=".03"/><body pos=".02 0 .04">'
        f'<geom name="pad{number}" type="box" size=".005 .009 .02" pos="-.004 0 .02" mass=".02" {_SOFT}/>'
        "</body></body></body>"
    )


RAIL = f"""<mujoco model="rail">
<!-- Torque-driven arm on a rail, redundant; three fingers around the hand that swing from far outside. -->
<compiler angle="degree" autolimits="true"/><default><joint armature=".1"/><motor ctrlrange="-150 150"/></default>
<worldbody><body name="rail"><geom type="box" size=".05 .6 .03" mass="8"/>
<body name="cart" pos="0 0 .06"><joint name="slide" type="slide" axis="0 1 0" range="-.5 .5"/>
<geom type="box" size=".07 .07 .03" mass="3"/>
<body name="l1" pos="0 0 .1"><joint name="j1" axis="0 0 1" range="-170 170"/>
<geom type="cylinder" size=".05 .06" mass="2"/>
<body name="l2" pos="0 0 .12"><joint name="j2" axis="0 1 0" range="-120 120"/>
<geom type="capsule" size=".04" fromto="0 0 0 0 0 .35" mass="2"/>
<body name="l3" pos="0 0 .35"><joint name="j3" axis="0 1 0" range="-150 150"/>
<geom type="capsule" size=".035" fromto="0 0 .05 0 0 .3" mass="1.5"/>
<body name="l4" pos="0 0 .34"><joint name="j4" axis="0 1 0" range="-120 120"/>
<geom type="capsule" size=".03" fromto="0 0 .03 0 0 .06" mass="1"/>
<body name="hand" pos="0 0 .1"><joint name="j5" axis="0 0 1" range="-180 180"/>
<geom type="box" size=".05 .03 .015" mass=".4"/>{_jaw(0)}{_jaw(1)}{_jaw(2)}
</body></body></body></body></body></body></body></worldbody>
<equality><joint joint1="fj1" joint2="fj0"/><joint joint1="fj2" joint2="fj0"/></equality>
<actuator><motor joint="slide" ctrlrange="-400 400"/><motor joint="j1"/><motor joint="j2"/><motor joint="j3"/>
<motor joint="j4" ctrlrange="-50 50"/><motor joint="j5" ctrlrange="-20 20"/>
<position name="grip" joint="fj0" kp="20" kv="1" ctrlrange="-.5 .7" forcerange="-3 3"/></actuator></mujoco>"""

_CUP = '<body name="cup" pos="0 0 .06"><geom type="cylinder" size=".012 .03" mass=".05"/></body>'
_BARE = re.sub(r"<tendon>.*</equality>|<general name=.fingers.*?/>", "", SIX, flags=re.DOTALL)
CUP_ONLY = re.sub(r'<body name="lf".*?</body><body name="rf".*?</body>', _CUP, _BARE, flags=re.DOTALL)
"""The same arm with the shape of a suction cup, but without a vacuum."""
VACUUM = CUP_ONLY.replace("</actuator>", '<adhesion body="cup" ctrlrange="0 1" gain="30"/></actuator>')


def _link(name: str, mass: float, shapes: str = "", at: str = "0 0 0", moment: float = 0.01) -> str:
    inertia = f'<inertia ixx="{moment}" iyy="{moment}" izz="{moment}" ixy="0" ixz="0" iyz="0"/>'
    inertial = f'<inertial><origin xyz="{at}"/><mass value="{mass}"/>{inertia}</inertial>'
    return f'<link name="{name}">{inertial}{shapes}</link>'


def _box(size: str, at: str = "0 0 0") -> str:
    return f'<collision><origin xyz="{at}"/><geometry><box size="{size}"/></geometry></collision>'


def _joint(name: str, ends: str, kind: str, axis: str, at: str, limit: str, more: str = "") -> str:
    parent, child = ends.split()
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/><origin xyz="{at}"/>'
        f'<axis xyz="{axis}"/><limit {limit} effort="400"/>{more}</joint>'
    )


MESH = '<visual><geometry><mesh filename="package://gantry_description/meshes/carriage.obj"/></geometry></visual>'
GANTRY = "".join(
    [
        '<robot name="gantry">',
        _link("rail", 20, _box("0.06 0.06 0.9", "-0.1 0 0.45")),
        _link("bridge", 6, _box("0.1 1.3 0.06") + MESH),
        _link("carriage", 3, _box("0.08 0.08 0.08")),
        _link("column", 2, _box("0.04 0.04 0.5", "0 0 0.1")),
        _link("hand", 0.5, _box("0.04 0.12 0.03")),
        _link("thumb", 0.05, _box("0.02 0.008 0.03")),
        _link("finger", 0.05, _box("0.02 0.008 0.03")),
        _joint("x", "rail bridge", "prismatic", "1 0 0", "0.1 0 0.75", 'lower="0" upper="0.8" velocity="0.8"'),
        _joint("y", "bridge carriage", "prismatic", "0 1 0", "0 0 0", 'lower="-0.7" upper="0.7" velocity="0.8"'),
        _joint("z", "carriage column", "prismatic", "0 0 -1", "0 0 -0.2", 'lower="0" upper="0.5" velocity="0.5"'),
        _joint("turn", "column hand", "continuous", "0 0 1", "0 0 -0.17", 'velocity="2.5"'),
        _joint("grip", "hand thumb", "prismatic", "0 1 0", "0 0.004 -0.08", 'lower="0" upper="0.04" velocity="0.1"'),
        _joint(
            "follow",
            "hand finger",
            "prismatic",
            "0 -1 0",
            "0 -0.004 -0.08",
            'lower="0" upper="0.04" velocity="0.1"',
            '<mimic joint="grip"/>',
        ),
        "</robot>",
    ]
)
"""Three sliding axes and a wrist in URDF, with a mimic joint and a visual mesh of a package that is not here."""


PALLETIZER = "".join(
    [
        '<robot name="palletizer">',
        _link("base", 20, _box("0.16 0.16 0.2", "0 0 0.1")),
        _link("turret", 8, _box("0.14 0.14 0.1", "0 0 0.05")),
        _link("upper", 4, _box("0.06 0.06 0.5", "0 0.1 0.25")),
        _link("elbow", 1, _box("0.04 0.04 0.04")),
        _link("fore", 3, _box("0.58 0.05 0.05", "0.29 0 0")),
        _link("wrist", 1, _box("0.05 0.05 0.05")),
        _link("hand", 0.8, _box("0.06 0.14 0.04", "0 0 -0.04")),
        _link("thumb", 0.1, _box("0.02 0.01 0.06", "0 0 -0.03")),
        _link("finger", 0.1, _box("0.02 0.01 0.06", "0 0 -0.03")),
        _joint("j1", "base turret", "revolute", "0 0 1", "0 0 0.2", 'lower="-3" upper="3" velocity="1.5"'),
        _joint("j2", "turret upper", "revolute", "0 1 0", "0 0 0.1", 'lower="-0.9" upper="1.2" velocity="1.5"'),
        _joint(
            "rod2",
            "upper elbow",
            "revolute",
            "0 1 0",
            "0 0 0.5",
            'lower="-1.1" upper="0.9" velocity="1.2"',
            '<mimic joint="j2" multiplier="-1"/>',
        ),
        _joint("j3", "elbow fore", "revolute", "0 1 0", "0 0 0", 'lower="-0.8" upper="1.5" velocity="1.5"'),
        _joint(
            "rod3",
            "fore wrist",
            "revolute",
            "0 1 0",
            "0.58 0 0",
            'lower="-1.5" upper="0.8" velocity="1.5"',
            '<mimic joint="j3" multiplier="-1"/>',
        ),
        _joint("j4", "wrist hand", "continuous", "0 0 -1", "0 0 -0.03", 'velocity="3"'),
        _joint("grip", "hand thumb", "prismatic", "0 1 0", "0 0.005 -0.06", 'lower="0" upper="0.04" velocity="0.1"'),
        _joint(
            "follow",
            "hand finger",
            "prismatic",
            "0 -1 0",
            "0 -0.005 -0.06",
            'lower="0" upper="0.04" velocity="0.1"',
            '<mimic joint="grip"/>',
        ),
        "</robot>",
    ]
)
"""Four driven joints; two others follow them like the rods of a palletizer, so that the tool stays vertical."""


def _wheel(side: int) -> str:
    return (
        f'<body name="wheel{side}" pos="0 {0.2 * side} .08"><joint name="axle{side}" axis="0 1 0" damping=".1"/>'
        '<geom type="cylinder" size=".07 .02" euler="90 0 0" mass="1" contype="0" conaffinity="0"/></body>'
    )


_STANDING = SIX[SIX.index('<body name="b0"') : SIX.index("</worldbody>")]
_PLATFORM = (
    '<body name="platform"><joint name="east" type="slide" axis="1 0 0"/>'
    '<joint name="north" type="slide" axis="0 1 0"/><joint name="heading" axis="0 0 1"/>'
    '<geom type="box" size=".22 .2 .15" pos="0 0 .2" mass="40"/>'
    + _wheel(1)
    + _wheel(-1)
    + '<body name="mount" pos="0 0 .7"><geom type="cylinder" size=".07 .18" pos="0 0 -.18" mass="8"/>'
    + f"{_STANDING}</body></body>"
)
ROVER = SIX.replace(_STANDING, _PLATFORM)
"""The same arm with two fingers on a platform that drives, with two wheels that only show it."""


def _light(name: str, mass: float, size: str, at: str) -> str:
    return _link(name, mass, _box(size, at), at, mass / 1000)


def _servo(name: str, ends: str, axis: str, at: str, low: float, high: float) -> str:
    return _joint(name, ends, "revolute", axis, at, f'lower="{low}" upper="{high}" velocity="4"')


DESK = "".join(
    [
        '<robot name="desk">',
        _light("base", 0.4, "0.1 0.08 0.05", "0 0 0.025"),
        _light("shoulder", 0.15, "0.05 0.05 0.05", "0 0 0.025"),
        _light("upper", 0.15, "0.14 0.03 0.03", "0.06 0 0"),
        _light("lower", 0.12, "0.13 0.026 0.026", "0.06 0 0"),
        _light("wrist", 0.08, "0.05 0.03 0.03", "0.025 0 0"),
        _light("gripper", 0.09, "0.03 0.04 0.03", "0.015 0 0"),
        _light("fixed_jaw", 0.02, "0.09 0.008 0.02", "0.045 0 0"),
        _light("moving_jaw", 0.02, "0.09 0.008 0.02", "0.045 0 0"),
        _servo("pan", "base shoulder", "0 0 1", "0 0 0.05", -1.9, 1.9),
        _servo("lift", "shoulder upper", "0 1 0", "0 0 0.05", -2, 1.8),
        _servo("elbow", "upper lower", "0 1 0", "0.135 0 0", -1.7, 2.6),
        _servo("pitch", "lower wrist", "0 1 0", "0.125 0 0", -1.7, 1.9),
        _servo("roll", "wrist gripper", "1 0 0", "0.05 0 0", -2.8, 2.8),
        '<joint name="mount" type="fixed"><parent link="gripper"/><child link="fixed_jaw"/>'
        '<origin xyz="0.03 -0.012 0"/></joint>',
        _servo("grip", "gripper moving_jaw", "0 0 1", "0.03 0.012 0", -0.2, 1.6),
        "</robot>",
    ]
)
"""A desktop arm of 1 kg in URDF that reaches 0.4 m. One jaw closes on the other one, 16 mm beside its root."""
