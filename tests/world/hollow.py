"""A tote without a lid as one mesh: its convex hull is a solid box."""

from __future__ import annotations

from pathlib import Path

LENGTH, WIDTH, HEIGHT, WALL = 0.3, 0.2, 0.1, 0.01
VOLUME = LENGTH * WIDTH * HEIGHT - (LENGTH - 2 * WALL) * (WIDTH - 2 * WALL) * (HEIGHT - WALL)
HULL = LENGTH * WIDTH * HEIGHT / VOLUME
"""How many times the tote's volume its convex hull has."""


def _ring(half_length: float, half_width: float, height: float) -> list[tuple[float, float, float]]:
    return [(x * half_length, y * half_width, height) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]


def _between(lower: int, upper: int) -> list[tuple[int, int, int, int]]:
    """Return the four sides between two rings, which begin at these corners; they face outwards."""
    return [(lower + i, lower + (i + 1) % 4, upper + (i + 1) % 4, upper + i) for i in range(4)]


def write_tote(path: Path) -> Path:
    """Write the tote as an OBJ file; its floor is at z = 0."""
    inner = LENGTH / 2 - WALL, WIDTH / 2 - WALL
    corners = [
        *(*_ring(LENGTH / 2, WIDTH / 2, 0.0), *_ring(LENGTH / 2, WIDTH / 2, HEIGHT)),
        *(*_ring(*inner, HEIGHT), *_ring(*inner, WALL)),
    ]
    sides = [(3, 2, 1, 0), *_between(0, 4), *_between(4, 8), *_between(8, 12), (12, 13, 14, 15)]
    lines = [f"v {x} {y} {z}" for x, y, z in corners]
    lines += [f"f {a + 1} {b + 1} {c + 1}\nf {a + 1} {c + 1} {d + 1}" for a, b, c, d in sides]
    path.write_text("\n".join((*lines, "")), encoding="utf-8")
    return path


def write_model(folder: Path, more: str = "", attributes: str = "") -> Path:
    """Write an MJCF file with the tote of 0.5 kg as a loose object, and the mesh in a folder ``meshes``."""
    (folder / "meshes").mkdir(exist_ok=True)
    write_tote(folder / "meshes" / "tote.obj")
    path = folder / "tote.xml"
    path.write_text(
        f"""<mujoco><compiler meshdir="meshes"/><asset><mesh name="shell" file="tote.obj" {attributes}/></asset>
        <worldbody><body name="tote" pos="0 0 0.4"><freejoint/>
        <geom name="body" type="mesh" mesh="shell" mass="0.5" friction="0.7" euler="0 0 90"/></body></worldbody>{more}
        </mujoco>""",
        encoding="utf-8",
    )
    return path
