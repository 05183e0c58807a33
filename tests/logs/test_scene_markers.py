"""Markers of a stored scene, computed by hand."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from robbdd_tools.logs.scene_markers import CUBE, CYLINDER, SPHERE, TRIANGLES, Drawn, scene_markers
from robbdd_tools.world.arrays import array

QUARTER = [2**-0.5, 0.0, 2**-0.5, 0.0]
"""A quarter turn about y: z becomes x."""


def drawn(kind: str, size: list[float], turn: list[float] | None = None, **more: Any) -> list[Drawn]:
    shape = {"body": "env:part", "kind": kind, "size": size, "position": [1.0, 2.0, 3.0], "color": [1, 0, 0, 1]}
    shape |= {"orientation": turn or [1.0, 0.0, 0.0, 0.0], **more}
    triangle = {
        "vertices": array(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]), "float32"),
        "faces": array(np.array([[0, 1, 2], [3, 2, 1]]), "uint32"),
    }
    geometry = {"shapes": [shape], "meshes": [triangle], "workspaces": []}
    return list(scene_markers(geometry, {"env:part": (0.0, 0.0, -0.5)}))


@pytest.mark.parametrize(
    ("kind", "size", "expected"),
    [
        ("box", [0.1, 0.2, 0.3], [(CUBE, (0.2, 0.4, 0.6), (1, 2, 3.5))]),
        ("sphere", [0.1, 0, 0], [(SPHERE, (0.2, 0.2, 0.2), (1, 2, 3.5))]),
        ("ellipsoid", [0.1, 0.2, 0.3], [(SPHERE, (0.2, 0.4, 0.6), (1, 2, 3.5))]),
        ("cylinder", [0.1, 0.3, 0], [(CYLINDER, (0.2, 0.2, 0.6), (1, 2, 3.5))]),
        ("plane", [0, 0, 0], [(CUBE, (4, 4, 0.001), (1, 2, 3.4995))]),
        (
            "capsule",
            [0.1, 0.3, 0],
            [
                (CYLINDER, (0.2, 0.2, 0.6), (1, 2, 3.5)),
                (SPHERE, (0.2, 0.2, 0.2), (1, 2, 3.8)),
                (SPHERE, (0.2, 0.2, 0.2), (1, 2, 3.2)),
            ],
        ),
    ],
)
def test_each_shape_is_drawn_in_the_frame_of_its_model(kind: str, size: list[float], expected: list[Any]) -> None:
    found = drawn(kind, size)
    assert [(one.frame, one.group) for one in found] == [("part", "part")] * len(expected)
    for one, (kind_of_marker, scale, place) in zip(found, expected, strict=True):
        assert one.type == kind_of_marker
        assert list(one.scale) == pytest.approx(scale)
        assert list(one.position) == pytest.approx(place)


def test_the_caps_of_a_turned_capsule_are_on_its_axis() -> None:
    _, upper, lower = drawn("capsule", [0.1, 0.3, 0.0], QUARTER)
    assert list(upper.position) == pytest.approx([1.3, 2.0, 3.5])
    assert list(lower.position) == pytest.approx([0.7, 2.0, 3.5])


def test_a_mesh_is_a_list_of_triangles() -> None:
    (one,) = drawn("mesh", [0.0, 0.0, 0.0], mesh=0)
    assert one.type == TRIANGLES
    corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 1, 0], [1, 0, 0]]
    assert [list(point) for point in one.points] == corners


def test_the_marker_of_a_workspace_turns_with_its_box() -> None:
    space = {"name": "env:bin_ws", "body": "env:part", "center": [1.0, 2.0, 3.0], "half": [0.1, 0.2, 0.3]}
    every = [space, space | {"orientation": QUARTER}]
    plain, turned = scene_markers({"shapes": [], "meshes": [], "workspaces": every}, {"env:part": (0.0, 0.0, -0.5)})
    assert (plain.orientation, turned.orientation) == ((1.0, 0.0, 0.0, 0.0), QUARTER)
    assert plain.position == turned.position == [1.0, 2.0, 3.5]
