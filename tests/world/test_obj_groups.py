"""An OBJ file whose groups are closed surfaces collides as the convex hulls of its groups."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from robbdd_tools.world.model_meshes import hollow_files, read_model, whole_meshes
from robbdd_tools.world.obj_groups import closed_groups, read_groups

BOX = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
SIDES = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]


def boxes(*places: float, group: str = "o") -> str:
    """Return an OBJ text with a cube of 1 m at each place (m) along x."""
    lines: list[str] = []
    for number, place in enumerate(places):
        lines.append(f"{group} box{number}")
        lines += [f"v {x + place} {y} {z}" for x, y, z in BOX]
        lines += ["f " + " ".join(str(corner + 8 * number) for corner in side) for side in SIDES]
    return "\n".join((*lines, ""))


@pytest.mark.parametrize("group", ["o", "g"])
def test_closed_groups_are_pieces(group: str) -> None:
    found = closed_groups(boxes(0, 5, group=group).encode())
    assert [(one.min(axis=0).tolist(), one.max(axis=0).tolist()) for one in found] == [
        ([0, 0, 0], [1, 1, 1]),
        ([5, 0, 0], [6, 1, 1]),
    ]


def test_corners_of_their_own_for_each_side_close_a_surface() -> None:
    lines = ["o one"]
    for number, side in enumerate(SIDES):
        lines += ["v {} {} {}".format(*BOX[corner - 1]) for corner in side]
        lines.append("f " + " ".join(f"{4 * number + corner}/1/1" for corner in (1, 2, 3, 4)))
    text = "\n".join((*lines, boxes(3).replace("f ", "f -8 -7 -6\nf ")))
    # The second group has a triangle too many.
    assert closed_groups(text.encode()) == ()
    shifted = boxes(0, 3).partition("o box1")[2].replace("box1", "two")
    moved = "\n".join(
        "f " + " ".join(str(int(word) + 16) for word in line.split()[1:]) if line.startswith("f ") else line
        for line in shifted.splitlines()
    )
    assert len(closed_groups("\n".join((*lines, f"o two{moved}")).encode())) == 2


@pytest.mark.parametrize(
    "text",
    [
        boxes(0),
        boxes(0, 5).replace("f 1 2 4 3\n", ""),
        boxes(0, 5, 9).replace("f 1 2 4 3\n", ""),
        "".join(f"g side{number}\nf {' '.join(map(str, side))}\n" for number, side in enumerate(SIDES)) + boxes(0)[6:],
        boxes(0) + "o flat\nv 2 0 0\nv 3 0 0\nv 2 1 0\nf 9 10 11\nf 9 11 10\n",
        "",
    ],
    ids=["one group", "an open side", "an open one of three", "sides", "a flat group", "nothing"],
)
def test_other_groups_are_parts_of_a_drawing(text: str) -> None:
    assert closed_groups(text.encode()) == ()


def test_polygons_become_triangles_and_negative_numbers_count_from_the_end() -> None:
    ((corners, faces),) = read_groups(["v 0 0 0", "v 1 0 0", "v 1 1 0", "v 0 1 0 1.0", "f -4 -3 -2 -1", "", "s off"])
    assert corners.shape == (4, 3)
    assert faces.tolist() == [[0, 1, 2], [0, 2, 3]]


@pytest.mark.parametrize("line", ["f 1 2 9", "f -9 1 2", "v 1 x 2", "f 1 2 a"])
def test_what_is_no_corner_is_an_error(line: str) -> None:
    with pytest.raises(ValueError, match=r".+"):
        read_groups(["v 0 0 0", "v 1 0 0", "v 1 1 0", line, "f 1 2 3"])


def write_urdf(folder: Path, text: str) -> Path:
    (folder / "parts.obj").write_text(text, encoding="utf-8")
    path = folder / "parts.urdf"
    shape = '<collision><geometry><mesh filename="parts.obj"/></geometry></collision>'
    path.write_text(f'<robot name="r"><link name="parts">{shape}</link></robot>', encoding="utf-8")
    return path


def test_a_model_collides_as_the_groups_of_its_mesh(tmp_path: Path) -> None:
    path = write_urdf(tmp_path, boxes(0, 5))
    model = read_model(path).compile()
    assert int((model.geom_contype > 0).sum()) == 2
    assert np.sort(model.geom_pos[model.geom_contype > 0, 0]).tolist() == pytest.approx([0.5, 5.5])
    assert hollow_files(path) == whole_meshes(path) == {}


def test_a_mesh_with_a_damaged_group_stays_whole(tmp_path: Path) -> None:
    path = write_urdf(tmp_path, boxes(0, 5) + "f 1 2 99\n")
    assert int((read_model(path).compile().geom_contype > 0).sum()) == 1
