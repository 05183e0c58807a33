"""Pictures for users' behaviours, rendered while a scenario is executed."""

from __future__ import annotations

from math import radians, tan
from pathlib import Path
from typing import TYPE_CHECKING, cast

import numpy as np
import pytest

from robbdd_tools.base.graphics import CHOICE, KEPT
from robbdd_tools.catalog.own_behaviour import BehaviourFailed
from robbdd_tools.world.errors import SimulationError
from robbdd_tools.world.simulation import Simulation
from robbdd_tools.world.user_behaviour import AgentWorld
from world.worlds import CUBE, PANDA, execution, pick_place

if TYPE_CHECKING:
    from collections.abc import Callable

    from robbdd_tools.catalog.api import FloatArray

pytestmark = pytest.mark.physics
SIDE = 240
PAGE = Path(__file__).resolve().parents[2] / "docs" / "simulation.md"


def settled() -> Simulation:
    return execution([pick_place()]).simulation


def above(place: FloatArray, ahead: float = 0.0, left: float = 0.0) -> FloatArray:
    """Return the place of a camera 0.4 m above a place."""
    return place + np.array([ahead, left, 0.4])


def look_down(simulation: Simulation, thing: str) -> tuple[float, float]:
    """Return the distance (m, m) of the red pixels' middle from a thing over which the camera is."""
    place, _ = simulation.pose(thing)
    try:
        pixels = simulation.cameras.take((above(place), place + np.array([0.0, 1e-6, 0.0])), (SIDE, SIDE)).astype(int)
    except SimulationError as error:
        pytest.skip(str(error))
    rows, columns = np.nonzero((pixels[..., 0] > 90) & (pixels[..., 1:].max(axis=2) < 0.7 * pixels[..., 0]))
    assert len(rows) > 20, f"nothing red over {thing}"
    scale = 2 * 0.4 * tan(radians(45) / 2) / SIDE
    return scale * (rows.mean() - SIDE / 2), scale * (columns.mean() - SIDE / 2)


def test_a_camera_sees_what_is_where_it_looks() -> None:
    assert np.hypot(*look_down(settled(), CUBE)) < 0.01


def test_the_same_state_gives_the_same_pixels_and_another_state_others() -> None:
    simulation = settled()
    look_down(simulation, CUBE)
    place, _ = simulation.pose(CUBE)
    aim = (above(place, 0.1), place)
    first, second = (simulation.cameras.take(aim, (60, 40)) for _ in range(2))
    assert first.shape == (40, 60, 3)
    assert (first == second).all()
    address = simulation.model.jnt_qposadr[simulation.model.body(CUBE).jntadr[0]]
    simulation.data.qpos[address] += 0.03
    assert (simulation.cameras.take(aim, (60, 40)) != first).any()


def test_pictures_do_not_change_the_execution() -> None:
    plain, filmed = (execution([pick_place()]) for _ in range(2))
    look_down(filmed.simulation, CUBE)
    for run in (plain, filmed):
        run.run_behaviour(0)
    assert plain.trace.positions.tobytes() == filmed.trace.positions.tobytes()


@pytest.mark.parametrize(
    ("camera", "size", "message"),
    [
        ("wrist", (320, 240), "there is no camera 'wrist' in the scene; it has none: its files define no camera"),
        (((0.0, 0.0, 1.0), (0.0, 0.0, 1.0)), (320, 240), "camera must be a name, or a position and another point"),
        (((0.0, 0.0, 1.0), (0.0, float("nan"), 0.0)), (320, 240), "camera must be a name, or a position"),
        (((0.0, 0.0, 1.0), (0.0, 0.0, 0.0)), (0, 240), "size must be width and height in pixels, at most 4096"),
        (((0.0, 0.0, 1.0), (0.0, 0.0, 0.0)), (320, 240, 3), "size must be width and height"),
    ],
)
def test_invalid_cameras_and_sizes_are_explained(camera: object, size: tuple[int, int], message: str) -> None:
    world = AgentWorld(settled(), PANDA, lambda _: None)
    with pytest.raises((KeyError, ValueError), match=message):
        world.picture(camera, size)  # pyright: ignore[reportArgumentType]


def test_a_machine_that_cannot_render_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(KEPT, raising=False)
    monkeypatch.setenv(CHOICE, "disable")
    with pytest.raises(SimulationError, match=r"nothing here can render without a display: install .*\(disable: "):
        settled().cameras.take((np.ones(3), np.zeros(3)), (32, 32))


def test_the_example_of_the_documentation_finds_the_red_part() -> None:
    text = PAGE.read_text(encoding="utf-8")
    code = text[text.index("def red_part(") :].partition("```")[0]
    found: dict[str, object] = {"np": np, "BehaviourFailed": BehaviourFailed}
    exec(code, found)
    red_part = cast("Callable[[object, FloatArray], tuple[float, float]]", found["red_part"])
    simulation = settled()
    look_down(simulation, CUBE)
    world = AgentWorld(simulation, PANDA, lambda _: None)
    place, _ = simulation.pose(CUBE)
    seen = red_part(world, above(place, 0.05, 0.03))
    assert np.hypot(*(np.array(seen) - place[:2])) < 0.01
    with pytest.raises(BehaviourFailed, match="no red part"):
        red_part(world, above(place, -0.5))
