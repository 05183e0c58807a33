"""Masses, centres of mass and inertias of the catalog's arms against what their makers publish, in their frames."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.world.arm_kinematics import arm_of
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.mobile_base import base_of
from robbdd_tools.world.robot_specs import load_robot
from world.test_kinematics import PUBLISHED

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

JOINTS = (0.3, -0.5, 0.7, -1.1, 0.9, 0.4, -0.6)
"""A posture, rad, in which no two frames are in line."""


@dataclass(frozen=True)
class Link:
    """Mass (kg), centre of mass (m) and inertia about it (kg m²: xx, yy, zz, xy, xz, yz) in the maker's link frame."""

    body: str
    mass: float
    center: tuple[float, float, float]
    inertia: tuple[float, float, float, float, float, float]


UR10 = (
    Link("shoulder", 7.1, (0.021, 0.0, 0.027), (0.03408, 0.03529, 0.02156, 0.00002, -0.00425, 0.00008)),
    Link("upper_arm", 12.7, (0.38, 0.0, 0.158), (0.02814, 0.77068, 0.76943, 0.00005, -0.01561, 0.00002)),
    Link("forearm", 4.27, (0.24, 0.0, 0.068), (0.01014, 0.30928, 0.30646, 0.00008, 0.00916, 0.0)),
    Link("wrist_1", 2.0, (0.0, 0.007, 0.018), (0.00296, 0.00222, 0.00258, -0.00001, 0.0, -0.00024)),
    Link("wrist_2", 2.0, (0.0, 0.007, 0.018), (0.00296, 0.00222, 0.00258, -0.00001, 0.0, -0.00024)),
    Link("wrist_3", 0.365, (0.0, 0.0, -0.026), (0.0004, 0.00041, 0.00034, 0.0, 0.0, 0.0)),
)
UR5E = (
    Link(
        "shoulder", 3.761, (0.0, -0.02561, 0.00193), (0.0070021, 0.00648091, 0.00657286, 7.3e-7, -1.053e-5, 0.00049994)
    ),
    Link("upper_arm", 8.058, (0.2125, 0.0, 0.11336), (0.01505885, 0.33388086, 0.33247207, -5.4e-5, 5.63e-6, -1.81e-6)),
    Link("forearm", 2.846, (0.15, 0.0, 0.0265), (0.00399632, 0.07879254, 0.0784851, -1.365e-5, 0.00137272, -6.6e-6)),
    Link(
        "wrist_1", 1.37, (0.0, -0.0018, 0.01634), (0.00165491, 0.00135962, 0.00126279, -2.82e-6, -4.38e-6, 0.00010157)
    ),
    Link("wrist_2", 1.3, (0.0, 0.0018, 0.01634), (0.00135617, 0.00127827, 0.00096614, -2.74e-6, 4.44e-6, -5.048e-5)),
    Link("wrist_3", 0.365, (0.0, 0.0, -0.001159), (0.00018694, 0.00018908, 0.00025756, 6e-8, -1.7e-7, -9.2e-7)),
)
PANDA = (
    Link(
        "link1", 2.7907, (0.00033, -0.02204, -0.04762), (0.0156478, 0.0143988, 0.0050044, 5.3e-6, -3.68e-5, -0.0024848)
    ),
    Link("link2", 2.5420, (0.00038, -0.09211, 0.01908), (0.0166243, 0.004625, 0.0154512, 3.09e-5, 8.4e-6, 0.003559)),
    Link(
        "link3", 2.2513, (0.05152, 0.01696, -0.02971), (0.0063174, 0.0086629, 0.006578, 0.0009731, 0.0029253, 0.0009347)
    ),
    Link(
        "link4",
        2.2037,
        (-0.05113, 0.05825, 0.01698),
        (0.0078459, 0.0064954, 0.0100308, -0.0033959, 0.001587, -0.0018148),
    ),
    Link(
        "link5", 2.2855, (-0.00005, 0.03730, -0.09280), (0.0229701, 0.0209506, 0.0043061, -9.5e-6, -2.06e-5, 0.0038235)
    ),
    Link(
        "link6", 1.353, (0.06572, -0.00371, 0.00153), (0.0008796, 0.002778, 0.002867, -0.0002149, -0.0001191, 1.27e-5)
    ),
    Link("link7", 0.35973, (0.00089, -0.00044, 0.05491), (0.0001954, 0.0001921, 0.0001794, 1.7e-6, 1.5e-6, -1.3e-6)),
)
GEN3 = (
    Link("shoulder", 1.3773, (-2.3e-5, -0.010364, -0.07336), (0.00457, 0.004831, 0.001409, 1e-6, 2e-6, 0.000448)),
    Link("half_arm_1", 1.1636, (-4.4e-5, -0.09958, -0.013278), (0.011088, 0.001072, 0.011255, 5e-6, 0.0, -0.000691)),
    Link("half_arm_2", 1.1636, (-4.4e-5, -0.006641, -0.117892), (0.010932, 0.011127, 0.001043, 0.0, -7e-6, 0.000606)),
    Link("forearm", 0.9302, (-1.8e-5, -0.075478, -0.015006), (0.008147, 0.000631, 0.008316, -1e-6, 0.0, -0.0005)),
    Link("wrist_1", 0.6781, (1e-6, -0.009432, -0.063883), (0.001596, 0.001607, 0.000399, 0.0, 0.0, 0.000256)),
    Link("wrist_2", 0.6781, (1e-6, -0.045483, -0.00965), (0.001641, 0.00041, 0.001641, 0.0, 0.0, -0.000278)),
    Link("bracelet", 0.364, (-9.3e-5, 0.000132, -0.022905), (0.000214, 0.000223, 0.00024, 0.0, 1e-6, -2e-6)),
)
GEN3_JOINTS = (
    ((0.0, 0.0, 0.15643), pi),
    ((0.0, 0.005375, -0.12838), pi / 2),
    ((0.0, -0.21038, -0.006375), -pi / 2),
    ((0.0, 0.006375, -0.21038), pi / 2),
    ((0.0, -0.20843, -0.006375), -pi / 2),
    ((0.0, 0.00017505, -0.10593), pi / 2),
    ((0.0, -0.10593, -0.00017505), -pi / 2),
)
"""Origin (m) and roll (rad) of each joint of Kinova's description in the link before it."""

ARMS = (("ur10", UR10, 1e-6), ("ur5e", UR5E, 1e-6), ("franka-panda", PANDA, 1e-6), ("kinova-gen3", GEN3, 5e-4))


def frames(name: str) -> list[FloatArray]:
    """Return the makers' link frames (4, 4) of an arm in the posture."""
    published = PUBLISHED[name]
    frame, found = (np.eye(4) if name == "kinova-gen3" else published.base), list[Any]()
    for index, angle in enumerate(JOINTS[: len(published.rows)]):
        if name == "kinova-gen3":
            place, roll = GEN3_JOINTS[index]
            turned = np.eye(4)
            turned[:3, 3] = place
            turned[1:3, 1:3] = [[cos(roll), -sin(roll)], [sin(roll), cos(roll)]]
            about = np.eye(4)
            about[:2, :2] = [[cos(angle), -sin(angle)], [sin(angle), cos(angle)]]
            frame = frame @ turned @ about
        else:
            d, offset, a, alpha = published.rows[index]
            frame = frame @ published.link(d, angle + offset, a, alpha)
        found.append(frame)
    return found


def test_every_arm_of_the_catalog_has_published_masses() -> None:
    fixed = {name for name, robot in load_catalog().robots.items() if base_of(robot) is None}
    assert {name for name, _, _ in ARMS} == fixed


def test_the_mobile_panda_carries_the_same_arm_as_the_fixed_one() -> None:
    fixed, mobile = (load_catalog().robots[name] for name in ("franka-panda", "mobile-panda"))
    assert (mobile.home, mobile.velocity_limits, mobile.torque_limits, mobile.stroke) == (
        *(fixed.home, fixed.velocity_limits, fixed.torque_limits),
        fixed.stroke,
    )
    one, other = (load_robot(robot).compile() for robot in (fixed, mobile))
    for body in range(1, one.nbody):
        name = one.body(body).name
        assert one.body(name).mass == other.body(f"panda_{name}").mass
        assert (one.body(name).inertia == other.body(f"panda_{name}").inertia).all()
    lower = arm_of(mobile).forward(np.array(JOINTS))[0] - arm_of(fixed).forward(np.array(JOINTS))[0]
    assert lower == pytest.approx([0.0, 0.0, 0.8])


@pytest.mark.parametrize(("name", "links", "reach"), ARMS)
def test_links_have_the_published_masses_and_inertias(name: str, links: tuple[Link, ...], reach: float) -> None:
    """``reach`` (m): Kinova's description and its user guide, which the kinematics is from, differ by so much."""
    robot = load_catalog().robots[name]
    model = load_robot(robot).compile()
    data = mujoco.MjData(model)
    for joint, angle in zip(robot.joints, JOINTS, strict=False):
        data.qpos[model.joint(joint).qposadr[0]] = angle
    mujoco.mj_kinematics(model, data)
    for link, frame in zip(links, frames(name), strict=True):
        body, turn = model.body(link.body), frame[:3, :3]
        assert body.mass[0] == link.mass
        assert data.body(link.body).xipos == pytest.approx(frame[:3, 3] + turn @ link.center, abs=reach)
        principal = data.body(link.body).ximat.reshape(3, 3)
        xx, yy, zz, xy, xz, yz = link.inertia
        tensor = turn @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ turn.T
        # The published link 4 of the Panda is physically impossible: its largest moment is corrected by 9 %.
        tolerance = 0.0012 if link.body == "link4" else 2e-6
        assert principal @ np.diag(body.inertia) @ principal.T == pytest.approx(tensor, abs=tolerance)
