"""``robbdd export --ros2`` draws the scene: rosbags reads the markers and the frames of the arm's links."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rosbags.highlevel import AnyReader

from kit import EXAMPLES
from logs.drives import robbdd

pytestmark = pytest.mark.physics


@pytest.fixture(scope="module")
def bag(tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest) -> Path:
    """The exported first execution of an example."""
    request.getfixturevalue("forks")
    models = shutil.copytree(EXAMPLES / "pickplace", tmp_path_factory.mktemp("export") / "models")
    assert robbdd(models, "run", "pickplace.bdd", "--first", "1").returncode == 0
    assert robbdd(models, "export", "latest", "--ros2", "-o", "bag").returncode == 0
    return models / "bag"


def messages(bag: Path, *topics: str) -> Iterator[tuple[float, Any]]:
    with AnyReader([bag]) as reader:
        wanted = [one for one in reader.connections if one.topic in topics]
        for connection, time, raw in reader.messages(connections=wanted):
            yield time / 1e9, reader.deserialize(raw, connection.msgtype)


def test_objects_links_and_workspaces_are_drawn_in_frames_that_the_bag_has(bag: Path) -> None:
    moving = {one.child_frame_id for _, message in messages(bag, "/tf") for one in message.transforms}
    fixed = {one.child_frame_id for _, message in messages(bag, "/tf_static") for one in message.transforms}
    _, first = next(messages(bag, "/markers"))
    frames = {one.header.frame_id for one in first.markers}
    assert frames <= moving | fixed | {"world"}
    assert not moving & fixed
    assert {"cube0", "table", "bin_left", "panda.link0", "panda.link7", "panda.hand"} <= frames
    assert {"workspace left_ws", "workspace table_ws"} <= {one.ns for one in first.markers}
    assert len({(one.ns, one.id) for one in first.markers}) == len(first.markers)
    assert all(one.frame_locked and one.color.a > 0 for one in first.markers)


def test_a_cube_is_drawn_where_it_is_and_as_large_as_it_is(bag: Path) -> None:
    _, first = next(messages(bag, "/markers"))
    (cube,) = (one for one in first.markers if one.ns == "cube0")
    edges = (cube.scale.x, cube.scale.y, cube.scale.z)
    # The catalog's cube has edges of 31.5 mm, and its frame is in its centre.
    assert edges == pytest.approx((0.0315, 0.0315, 0.0315))
    assert (cube.pose.position.x, cube.pose.position.y, cube.pose.position.z) == pytest.approx((0, 0, 0), abs=1e-9)


def test_the_hand_moves_with_the_tool(bag: Path) -> None:
    """The tool centre point of the Panda is 103.4 mm along the z axis of its hand, by the manufacturer."""
    places: dict[str, dict[float, Any]] = {"panda": {}, "panda.hand": {}}
    for time, message in messages(bag, "/tf"):
        for one in message.transforms:
            if one.child_frame_id in places:
                at = one.transform.translation
                places[one.child_frame_id][time] = np.array([at.x, at.y, at.z])
    both = places["panda"].keys() & places["panda.hand"].keys()
    assert len(both) > 50
    distances = [float(np.linalg.norm(places["panda"][time] - places["panda.hand"][time])) for time in both]
    assert distances == pytest.approx([0.1034] * len(both), abs=2e-5)


def test_each_event_is_a_text_above_the_tool_at_its_time(bag: Path) -> None:
    shown = [(time, one.markers[0]) for time, one in messages(bag, "/markers")][1:]
    events = [(time, one.data.rpartition(":")[2]) for time, one in messages(bag, "/events")]
    assert [(time, one.text) for time, one in shown] == events
    assert {one.header.frame_id for _, one in shown} == {"panda"}


@pytest.mark.usefixtures("forks")
def test_the_pedestal_of_a_scene_without_tables_has_the_frame_of_its_model(bag: Path, tmp_path: Path) -> None:
    models = shutil.copytree(EXAMPLES / "pickplace", tmp_path / "models")
    scene = (models / "bench.scene").read_text(encoding="utf-8")
    for table in ("object table", "furniture.table"):
        assert scene.count(table) == 1
        scene = scene.replace(table, table.replace("table", "tray"))
    (models / "bench.scene").write_text(scene, encoding="utf-8")
    assert robbdd(models, "run", "pickplace.bdd", "--first", "1").returncode in (0, 1)
    assert robbdd(models, "export", "latest", "--ros2", "-o", "bag").returncode == 0

    def height(bag: Path, frame: str) -> float:
        static = (one for _, message in messages(bag, "/tf", "/tf_static") for one in message.transforms)
        return next(one.transform.translation.z for one in static if one.child_frame_id == frame)

    assert height(models / "bag", "pedestal") == pytest.approx(height(bag, "table"), abs=1e-3)
