"""``python -m tests.bench.friction_study [FILE.svg]``: what two fingers hold, over friction, mass and grip force.

A cube between the fingers of the Panda is loaded with a share of the bound 2 μ N / g, and slides or stays. The figures
and the plot are for ``docs/simulation.md``.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent))

from bench.chart import Series, scatter
from robbdd_tools.world.composition import build_world
from robbdd_tools.world.simulation import Simulation
from world.test_friction import GRAVITY, Held, bench
from world.worlds import CUBE, PANDA

FRICTIONS = (0.05, 0.1, 0.2, 0.4, 0.6, 0.9)
FORCES = (5.0, 10.0, 15.0)
SHARES = (0.5, 0.8, 0.9, 0.95, 0.97, 0.98, 0.99, 1.0, 1.01, 1.02, 1.03, 1.05, 1.1, 1.3)
SLIDES = 1e-3
"""Slip from which on a part does not stay, m in one second."""
FALLEN = 0.5
"""A part that is lost has slipped by at least this, m; it falls on for as long as is simulated."""


def slip(friction: float, force: float, share: float) -> float:
    """Return how far (m) a cube slides in one second between fingers that press with a force (N) each."""
    mass = share * 2 * friction * force / GRAVITY
    held = Held(Simulation(build_world(bench(PANDA, CUBE, friction=friction, mass=mass), 1)), CUBE, force)
    return min(FALLEN, max(1e-7, held.slip()))


def main(picture: Path | None) -> None:
    """Print the table of the study and draw its plot."""
    series: list[Series] = []
    print("| μ | force of each finger | bound 2 μ N | largest share that stays | smallest that slides | creep at 0.9 |")
    print("|---|---|---|---|---|---|")
    for friction in FRICTIONS:
        points: list[tuple[float, float]] = []
        for force in FORCES:
            found = {share: slip(friction, force, share) for share in SHARES}
            stays = max(share for share in SHARES if all(found[one] < SLIDES for one in SHARES if one <= share))
            slides = min(share for share in SHARES if found[share] >= SLIDES)
            print(
                f"| {friction:g} | {force:g} N | {2 * friction * force:.1f} N | {stays:g} | {slides:g} "
                f"| {1000 * found[0.9]:.2f} mm/s |"
            )
            points += [(share, 1000 * value) for share, value in found.items()]
        series.append(Series(f"μ = {friction:g}", points))
    if picture is not None:
        text = scatter(series, "weight / (2 μ N)", "slip in 1 s, mm", ((1.0, "bound"),), upright=True)
        picture.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else None)
